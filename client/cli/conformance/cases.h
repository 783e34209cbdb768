// The conformance cases: impacts with their right answers by each law, as conformance/impacts.json states them.

#ifndef RICOCHET_CLIENT_CLI_CONFORMANCE_CASES_H_
#define RICOCHET_CLIENT_CLI_CONFORMANCE_CASES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace ricochet::cli {

struct RightAnswer {
  // newton, poisson or energetic at one contact; at several "springs" or an order of impacts, "order 1-2".
  std::string law;
  std::vector<std::string> also;   // Other orders, or springs, that end with the same velocities.
  Eigen::VectorXd velocity_after;  // One number for each coordinate.
};

// An impact as M, J and q' before; `frame` moves with the surface, and is 0 where that is at rest.
struct ConformanceCase {
  std::string name, family, shows, source;
  std::string json;                       // The case as conformance/impacts.json states it.
  std::string summary;                    // The four texts above as JSON, in one line.
  int dimension = 0;                      // Numbers of each contact: 2 in a plane, 3 in space.
  Eigen::VectorXd friction, coefficient;  // One of both for each contact.
  std::vector<std::string> coordinates;
  Eigen::MatrixXd mass, jacobian;
  Eigen::VectorXd before, frame;
  std::vector<std::vector<int>> symmetries;  // Each maps coordinates to coordinates: -3 is minus the third.
  std::vector<RightAnswer> answers;

  bool HasOneContact() const { return friction.size() == 1; }
};

struct ConformanceCases {
  int version = 0;
  std::string fingerprint;
  std::vector<ConformanceCase> cases;
};

const ConformanceCases& AllConformanceCases();

// Returns the case of this name. Errors: INVALID_ARGUMENT with the nearest name; `what` names the input.
absl::StatusOr<const ConformanceCase*> FindConformanceCase(const std::string& name, const std::string& what);

// Returns conformance/impacts.json, byte for byte.
std::string ConformanceCasesJson();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CONFORMANCE_CASES_H_
