#include "client/cli/text/enum_names.h"

#include <array>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "proto/wire/fit.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

// Returns the names of all values of an enum that counts from 0, as the protos have them, without their prefix.
template <typename Enum, size_t kCount, typename ProtoName>
std::array<std::string, kCount> NamesOf(ProtoName proto_name, absl::string_view prefix) {
  std::array<std::string, kCount> names;
  for (size_t i = 0; i < kCount; ++i) {
    names[i] = std::string(absl::StripPrefix(proto_name(ToProto(static_cast<Enum>(i))), prefix));
  }
  return names;
}

std::string Words(const std::string& name, const char* prefix, const char* separator) {
  const std::string bare(absl::StripPrefix(name, prefix));
  return absl::StrReplaceAll(absl::AsciiStrToLower(bare), {{"_", separator}});
}

}  // namespace

const std::string& RegimeName(Regime regime) {
  static const auto names = NamesOf<Regime, kRegimeCount>(v1::Regime_Name<v1::Regime>, "REGIME_");
  return names.at(static_cast<size_t>(regime));
}

const std::string& StatusName(RowStatus status) {
  static const auto names = NamesOf<RowStatus, kRowStatusCount>(v1::RowStatus_Name<v1::RowStatus>, "ROW_STATUS_");
  return names.at(static_cast<size_t>(status));
}

std::string RegimeText(Regime regime) {
  return absl::StrReplaceAll(absl::AsciiStrToLower(RegimeName(regime)), {{"_", " "}});
}

std::string EffectWord(Effect effect) { return Words(v1::Effect_Name(ToProto(effect)), "EFFECT_", "-"); }

std::string ModelText(Model model) { return Words(v1::Model_Name(ToProto(model)), "MODEL_", " "); }

std::string ArithmeticText(Arithmetic arithmetic) {
  return Words(v1::Arithmetic_Name(ToProto(arithmetic)), "ARITHMETIC_", " ");
}

std::string KindName(DerivativeKind kind) {
  return std::string(absl::StripPrefix(v1::Derivative::Kind_Name(ToProto(kind)), "KIND_"));
}

std::string FitEndName(FitEndKind kind) {
  return std::string(absl::StripPrefix(v1::FitEnd::Kind_Name(ToProto(kind)), "KIND_"));
}

std::string ThresholdName(Threshold threshold) {
  return std::string(absl::StripPrefix(v1::Derivative::Threshold_Name(ToProto(threshold)), "THRESHOLD_"));
}

std::string ModelName(Model model) { return std::string(absl::StripPrefix(v1::Model_Name(ToProto(model)), "MODEL_")); }

}  // namespace ricochet::cli
