// The five cases, and what the pendulum does in each by the three laws of restitution. Lubarda (2009), Eqs. (11), (14),
// (23).

#ifndef RICOCHET_TESTS_PEERS_EXACT_H_
#define RICOCHET_TESTS_PEERS_EXACT_H_

#include <string>
#include <vector>

#include "ricochet/scene.h"
#include "tests/peers/peer.h"

namespace ricochet::peers {

// Reads the cases pendulum-1 to pendulum-5 of conformance/impacts.json; ends the program if they are not there.
std::vector<PendulumCase> ReadPendulumCases(const std::string& impacts_file);

// omega+ in rad/s, to the precision of a long double, if the coefficient of the case is that of the law named.
struct Exact {
  long double newton = 0.0L;
  long double poisson = 0.0L;
  long double energetic = 0.0L;
};

// Asks LocalSolver for certified digits and ends the program if it refuses.
Exact ExactAnswers(const PendulumCase& c);

// The case as a scene; the coefficient is the energetic one.
Scene SceneOf(const PendulumCase& c);

}  // namespace ricochet::peers

#endif  // RICOCHET_TESTS_PEERS_EXACT_H_
