// M, J and the velocities of the double pendulum of rods.h, by Simbody.

#ifndef RICOCHET_TESTS_ROBOTS_SIMBODY_RECIPE_H_
#define RICOCHET_TESTS_ROBOTS_SIMBODY_RECIPE_H_

#include <vector>

namespace ricochet::robots {

// Row by row.
struct SimbodyMatrices {
  std::vector<double> mass, jacobian, rates;
};

SimbodyMatrices DoublePendulumInSimbody(const double angle[2], const double rate[2]);

}  // namespace ricochet::robots

#endif  // RICOCHET_TESTS_ROBOTS_SIMBODY_RECIPE_H_
