// The five cases, and what the pendulum does in each by the three laws of restitution. Lubarda (2009), Eqs. (11), (14),
// (23).

#ifndef RICOCHET_TESTS_PEERS_EXACT_H_
#define RICOCHET_TESTS_PEERS_EXACT_H_

#include <array>

#include "ricochet/scene.h"
#include "tests/peers/peer.h"

namespace ricochet::peers {

// Case 1 has no friction, so that all laws agree. Cases 2 and 3 are the examples of the paper's sections 8.1 and 9; in
// case 4 friction locks the pendulum; in case 5 friction all but locks it, and the three laws lie furthest apart.
inline constexpr std::array<PendulumCase, 5> kCases = {
    {{.number = 1, .a = 0.3, .b = 1, .friction = 0, .restitution = 0.8},
     {.number = 2, .a = 0.3, .b = 1, .friction = 0.1, .restitution = 1},
     {.number = 3, .a = 4, .b = 1, .friction = 0.4, .restitution = 0.8},
     {.number = 4, .a = 0.3, .b = 1, .friction = 0.5, .restitution = 0.8},
     {.number = 5, .a = 0.3, .b = 1, .friction = 0.29, .restitution = 1}}};

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
