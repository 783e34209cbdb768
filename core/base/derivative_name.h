// The name of a column that is a derivative: "d(OF)/d(BY)", with the paths of a number of the outcome and of one of the
// scene.

#ifndef RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_
#define RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_

#include <optional>
#include <string>

#include "absl/strings/string_view.h"

namespace ricochet {

struct DerivativeName {
  std::string of, by;

  std::string Text() const { return "d(" + of + ")/d(" + by + ")"; }
};

// Nothing if the column does not have the form of such a name.
std::optional<DerivativeName> ReadDerivativeName(absl::string_view column);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_DERIVATIVE_NAME_H_
