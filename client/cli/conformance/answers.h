// The answers of a simulator to conformance cases, as a file states them (conformance/answers.schema.json).

#ifndef RICOCHET_CLIENT_CLI_CONFORMANCE_ANSWERS_H_
#define RICOCHET_CLIENT_CLI_CONFORMANCE_ANSWERS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/conformance/cases.h"

namespace ricochet::cli {

// The laws of one contact, as files and options spell them.
inline const std::vector<std::string> kConformanceLaws = {"newton", "poisson", "energetic"};

struct SimulatorAnswer {
  const ConformanceCase* asked = nullptr;
  std::string law;                 // The law that the simulator says it obeys; empty if it says none.
  Eigen::VectorXd velocity_after;  // One number for each coordinate of the case.
};

struct SimulatorAnswers {
  std::string simulator;  // Its name; empty if the file has none.
  std::vector<SimulatorAnswer> answers;
};

// Reads JSON, which starts with a brace, or CSV with the header case,law,velocity_after, whose rows go on with one cell
// for each coordinate. `name` names the text in errors.
// Errors: INVALID_ARGUMENT if the text is empty or cut off, or has an unknown case, one twice, an unknown law, a number
// that is not finite or another count of numbers than the case has coordinates.
absl::StatusOr<SimulatorAnswers> ReadSimulatorAnswers(const std::string& text, const std::string& name);

// Returns the error of a law that is none of kConformanceLaws.
absl::Status CheckConformanceLaw(const std::string& law, const std::string& what);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CONFORMANCE_ANSWERS_H_
