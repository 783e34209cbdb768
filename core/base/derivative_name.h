// The name of a column that is a derivative: "d(OF)/d(BY)", with the paths of a number of the outcome and of one of the
// scene.

#ifndef RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_
#define RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_

#include <cstddef>
#include <optional>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"

namespace ricochet {

struct DerivativeName {
  std::string of, by;

  std::string Text() const { return "d(" + of + ")/d(" + by + ")"; }
};

// Nothing if the column does not have the form of such a name.
inline std::optional<DerivativeName> ReadDerivativeName(absl::string_view column) {
  constexpr absl::string_view kBetween = ")/d(";
  const size_t between = column.find(kBetween);
  if (between == absl::string_view::npos || !absl::StartsWith(column, "d(") || !absl::EndsWith(column, ")")) return {};
  const size_t by = between + kBetween.size();
  return DerivativeName{.of = std::string(column.substr(2, between - 2)),
                        .by = std::string(column.substr(by, column.size() - by - 1))};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_
