// How exact, and with which effects: options of solve and sweep.

#ifndef RICOCHET_CLIENT_CLI_DEMAND_INPUT_H_
#define RICOCHET_CLIENT_CLI_DEMAND_INPUT_H_

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/plan/demand_fields.h"

namespace ricochet::cli {

struct DemandOptions {
  std::string tolerance;
  std::vector<std::string> required, excluded;  // As EffectWord spells them.

  bool any() const { return !tolerance.empty() || !required.empty() || !excluded.empty(); }
};

void AddDemandOptions(CLI::App& app, DemandOptions& options);

// Errors: INVALID_ARGUMENT for what is no number or no effect.
absl::StatusOr<DemandFields> ReadDemand(const DemandOptions& options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_DEMAND_INPUT_H_
