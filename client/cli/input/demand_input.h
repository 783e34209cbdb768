// The options of solve and sweep for the accuracy and the effects.

#ifndef RICOCHET_CLIENT_CLI_INPUT_DEMAND_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_DEMAND_INPUT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/plan/demand.h"

namespace CLI {
class App;
}

namespace ricochet::cli {

struct DemandOptions {
  std::string tolerance;
  std::vector<std::string> required, excluded;  // Names of effects, spelled as by EffectWord.

  bool any() const { return !tolerance.empty() || !required.empty() || !excluded.empty(); }
};

void AddDemandOptions(CLI::App& app, DemandOptions& options);

// Errors: INVALID_ARGUMENT for a text that is not a number or not an effect.
absl::StatusOr<DemandFields> ReadDemand(const DemandOptions& options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_DEMAND_INPUT_H_
