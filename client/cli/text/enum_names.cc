#include "client/cli/text/enum_names.h"

#include <array>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/str_replace.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

// Returns the names of all values of an enum that counts from 0.
template <typename Enum, size_t kCount>
std::array<std::string, kCount> NamesOf() {
  std::array<std::string, kCount> names;
  for (size_t i = 0; i < kCount; ++i) names[i] = EnumName(static_cast<Enum>(i));
  return names;
}

std::string Words(const std::string& name, const char* separator) {
  return absl::StrReplaceAll(absl::AsciiStrToLower(name), {{"_", separator}});
}

}  // namespace

std::string BareName(const google::protobuf::EnumValueDescriptor& value) {
  return value.name().substr(EnumPrefix(*value.type()).size());
}

const std::string& RegimeName(Regime regime) {
  static const auto names = NamesOf<Regime, kRegimeCount>();
  return names.at(static_cast<size_t>(regime));
}

const std::string& StatusName(RowStatus status) {
  static const auto names = NamesOf<RowStatus, kRowStatusCount>();
  return names.at(static_cast<size_t>(status));
}

std::string RegimeText(Regime regime) { return Words(RegimeName(regime), " "); }

std::string EffectWord(Effect effect) { return Words(EnumName(effect), "-"); }

std::string ModelText(Model model) { return Words(EnumName(model), " "); }

std::string ArithmeticText(Arithmetic arithmetic) { return Words(EnumName(arithmetic), " "); }

}  // namespace ricochet::cli
