// Columns: the fields of an Outcome that a sweep can ask for, by path.

#ifndef RICOCHET_CORE_SWEEP_COLUMN_H_
#define RICOCHET_CORE_SWEEP_COLUMN_H_

#include <optional>
#include <string>
#include <vector>

#include "core/models/pendulum.h"

namespace ricochet {

// Every column of a pendulum sweep, as ricochet.v1.Outcome spells it: "coefficients.newton", "rates_after_rad_s[0]".
const std::vector<std::string>& PendulumColumns();

// The output behind a column; nothing for an unknown name.
std::optional<pendulum::Output> PendulumColumn(const std::string& name);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_COLUMN_H_
