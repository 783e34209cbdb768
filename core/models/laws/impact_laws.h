// This header includes every impact law.

#ifndef RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_
#define RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_

#include "core/models/laws/brach.h"
#include "core/models/laws/chatterjee_ruina.h"
#include "core/models/laws/impact_law.h"
#include "core/models/laws/kane_levinson.h"
#include "core/models/laws/whittaker.h"

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAWS_H_
