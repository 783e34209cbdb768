// The values of enums as the command line writes them: by their names in the protos, or in words.

#ifndef RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_
#define RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_

#include <string>

#include "ricochet/fit.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Return names in the protos without their prefix: "REBOUND", "INADMISSIBLE", "COMPLIANT".
const std::string& RegimeName(Regime regime);
const std::string& StatusName(RowStatus status);
std::string ModelName(Model model);
std::string KindName(DerivativeKind kind);
std::string ThresholdName(Threshold threshold);
std::string FitEndName(FitEndKind kind);

// Return words: "stick in compression", "finite duration", "compensated".
std::string RegimeText(Regime regime);
std::string ModelText(Model model);
std::string ArithmeticText(Arithmetic arithmetic);

// Returns the name of an effect as the options spell it: "tangential-compliance".
std::string EffectWord(Effect effect);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_
