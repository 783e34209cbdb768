#include "tests/robots/simbody_recipe.h"

#include <Simbody.h>

namespace ricochet::robots {

// Rows of J are x, y and z of the ground.
SimbodyMatrices AtStation(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& state,
                          const SimTK::MobilizedBody& body, const SimTK::Vec3& station) {
  SimTK::Matrix mass, jacobian;
  matter.calcM(state, mass);
  matter.calcStationJacobian(state, body, station, jacobian);
  SimbodyMatrices all;
  for (int i = 0; i < mass.nrow(); ++i) all.rates.push_back(state.getU()[i]);
  for (int i = 0; i < mass.nrow(); ++i)
    for (int j = 0; j < mass.ncol(); ++j) all.mass.push_back(mass(i < j ? i : j, i < j ? j : i));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < jacobian.ncol(); ++j) all.jacobian.push_back(jacobian(i, j));
  return all;
}

// Rods in the plane x y, hinged about z.
SimbodyMatrices DoublePendulumInSimbody(const double angle[2], const double rate[2]) {
  using SimTK::Vec3;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  const auto rod = [](double mass, double com, double inertia) {
    const Vec3 centre(0.0, -com, 0.0);
    const SimTK::Inertia about_com(inertia, 0.01, inertia);
    return SimTK::Body::Rigid(SimTK::MassProperties(mass, centre, about_com.shiftFromMassCenter(centre, mass)));
  };
  SimTK::MobilizedBody::Pin upper(matter.Ground(), Vec3(0.0), rod(2.0, 0.4, 0.11), Vec3(0.0));
  SimTK::MobilizedBody::Pin lower(upper, Vec3(0.0, -0.8, 0.0), rod(1.5, 0.25, 0.05), Vec3(0.0));
  SimTK::State state = system.realizeTopology();
  upper.setOneQ(state, 0, angle[0]);
  lower.setOneQ(state, 0, angle[1]);
  upper.setOneU(state, 0, rate[0]);
  lower.setOneU(state, 0, rate[1]);
  system.realize(state, SimTK::Stage::Velocity);
  return AtStation(matter, state, lower, Vec3(0.0, -0.6, 0.0));
}

}  // namespace ricochet::robots
