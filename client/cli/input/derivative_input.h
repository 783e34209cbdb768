// The options --derivatives and --by, and --thresholds where outcomes have derivatives.

#ifndef RICOCHET_CLIENT_CLI_INPUT_DERIVATIVE_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_DERIVATIVE_INPUT_H_

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

struct DerivativeOptions {
  std::vector<std::string> of, by;
  bool thresholds = false;

  bool any() const { return !of.empty() || !by.empty() || thresholds; }
};

// `numbers` says what --derivatives names: "numbers of the outcome".
void AddDerivativeOptions(CLI::App& sub, const std::string& numbers, DerivativeOptions& options);

// Returns the derivatives that the options ask for; nothing if they ask for none. --derivatives names some of `known`.
// Errors: INVALID_ARGUMENT for one option without the other, and those of FullName.
absl::StatusOr<std::optional<DerivativePaths>> ReadDerivatives(const DerivativeOptions& options, const Scene& scene,
                                                               const std::vector<std::string>& known);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_DERIVATIVE_INPUT_H_
