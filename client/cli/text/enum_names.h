// The values of enums as the command line writes them: by their names in the protos, or in words.

#ifndef RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_
#define RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/generated_enum_reflection.h>

#include <string>

#include "proto/wire/enums.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Returns the name of a value without the prefix of its enum: "REBOUND" for REGIME_REBOUND.
std::string BareName(const google::protobuf::EnumValueDescriptor& value);

// Return names in the protos without their prefix: "COMPLIANT", "REBOUND", "INADMISSIBLE".
template <typename Enum>
std::string EnumName(Enum value) {
  const auto& type = *google::protobuf::GetEnumDescriptor<typename EnumPair<Enum>::Other>();
  return BareName(*type.FindValueByNumber(ToProto(value)));
}
const std::string& RegimeName(Regime regime);
const std::string& StatusName(RowStatus status);

// Return words: "stick in compression", "finite duration", "compensated".
std::string RegimeText(Regime regime);
std::string ModelText(Model model);
std::string ArithmeticText(Arithmetic arithmetic);

// Returns the name of an effect as the options spell it: "tangential-compliance".
std::string EffectWord(Effect effect);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_ENUM_NAMES_H_
