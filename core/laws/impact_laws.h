// Every comparison law.

#ifndef RICOCHET_CORE_LAWS_IMPACT_LAWS_H_
#define RICOCHET_CORE_LAWS_IMPACT_LAWS_H_

#include "core/laws/brach.h"
#include "core/laws/chatterjee_ruina.h"
#include "core/laws/impact_law.h"
#include "core/laws/kane_levinson.h"
#include "core/laws/whittaker.h"

#endif  // RICOCHET_CORE_LAWS_IMPACT_LAWS_H_
