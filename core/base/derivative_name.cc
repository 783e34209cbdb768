#include "core/base/derivative_name.h"

#include <cstddef>

#include "absl/strings/match.h"

namespace ricochet {

std::optional<DerivativeName> ReadDerivativeName(absl::string_view column) {
  constexpr absl::string_view kBetween = ")/d(";
  const size_t between = column.find(kBetween);
  if (between == absl::string_view::npos || !absl::StartsWith(column, "d(") || !absl::EndsWith(column, ")")) return {};
  const size_t by = between + kBetween.size();
  return DerivativeName{.of = std::string(column.substr(2, between - 2)),
                        .by = std::string(column.substr(by, column.size() - by - 1))};
}

}  // namespace ricochet
