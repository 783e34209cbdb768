// ThisMachine: the processor and the build, for tables that state times.

#ifndef RICOCHET_CORE_COST_MACHINE_H_
#define RICOCHET_CORE_COST_MACHINE_H_

#include "ricochet/cost.h"

namespace ricochet {

// The processor is asked by its own instruction (CPUID on x86), so that no file is read. Each string is at most 64
// characters.
CostMachine ThisMachine();

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_MACHINE_H_
