// Simbody: pin joint in generalized coordinates. Its rigid contacts take Poisson's law (recommended) or Newton's; its
// compliant ones Hunt and Crossley's spring with friction that is smooth at zero slip.

#include <Simbody.h>
#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>

#include "absl/strings/str_format.h"
#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

using SimTK::Real;
using SimTK::Vec3;

// The standard output goes to /dev/null while it lives, because the engine describes its steps there.
class Silence {
 public:
  Silence() : output_(dup(STDOUT_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
  ~Silence() {
    std::cout.flush();
    std::fflush(stdout);
    dup2(output_, STDOUT_FILENO);
    close(output_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  const int output_;
};

SimTK::Body::Rigid RodBody(const PendulumCase& c) {
  const Rod rod(c);
  const SimTK::Inertia about_com(rod.inertia_com);
  const Vec3 com(rod.com_x, rod.com_y, 0);
  return SimTK::Body::Rigid(SimTK::MassProperties(rod.mass, com, about_com.shiftFromMassCenter(com, rod.mass)));
}

class RigidSimbodyPeer final : public Peer {
 public:
  using Stepper = SimTK::SemiExplicitEulerTimeStepper;
  RigidSimbodyPeer(Setup setup, Stepper::RestitutionModel law, Stepper::ImpulseSolverType solver)
      : Peer(std::move(setup)), law_(law), solver_(solver) {}

  void Prepare(const PendulumCase& c) override { world_ = std::make_unique<World>(*this, c); }

  void Reset() override {
    SimTK::State& state = world_->stepper.updAdvancedState();
    state.setTime(0);
    state.updQ()[0] = 0;
    state.updU()[0] = kOmegaBefore;
  }

  void Run() override {
    // Debian's build describes every impact on the standard output.
    const Silence silence;
    for (int i = 1; i <= kMostSteps && omega() < -kStopped; ++i) world_->stepper.stepTo(i * setup().step_s);
  }

  AfterImpact After() const override { return AfterAt(omega()); }

 private:
  struct World {
    World(const RigidSimbodyPeer& peer, const PendulumCase& c)
        : pendulum(matter.Ground(), SimTK::Transform(), RodBody(c), SimTK::Transform()), stepper(system) {
      matter.adoptUnilateralContact(new SimTK::PointPlaneContact(matter.updGround(), SimTK::UnitVec3(SimTK::YAxis),
                                                                 -c.b, pendulum, Vec3(c.a, -c.b, 0), c.restitution,
                                                                 c.friction, c.friction, 0));
      stepper.setRestitutionModel(peer.law_);
      stepper.setImpulseSolverType(peer.solver_);
      stepper.setConstraintTolerance(1e-9);
      // The contact bounces however slow it is.
      stepper.setDefaultImpactCaptureVelocity(0);
      stepper.setDefaultImpactMinCORVelocity(0);
      stepper.setDefaultFrictionTransitionVelocity(0);
      const Silence silence;
      stepper.initialize(system.realizeTopology());
    }

    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter = SimTK::SimbodyMatterSubsystem(system);
    SimTK::MobilizedBody::Pin pendulum;
    Stepper stepper;
  };

  Real omega() const { return world_->stepper.getAdvancedState().getU()[0]; }

  const Stepper::RestitutionModel law_;
  const Stepper::ImpulseSolverType solver_;
  std::unique_ptr<World> world_;
};

// Returns c of N = k x^(3/2) (1 + 3/2 c x') for which a frictionless impact at the speed v has the coefficient e. With
// y = 3/2 c v it solves ln((1 + y)/(1 - y e)) = y (1 + e).
double HuntCrossleyDamping(double e, double v) {
  if (e >= 1) return 0;
  double low = 0;
  double high = 1 / e;
  for (int i = 0; i < 100; ++i) {
    const double y = 0.5 * (low + high);
    (std::log((1 + y) / (1 - y * e)) < y * (1 + e) ? low : high) = y;
  }
  return low / (1.5 * v);
}

// Plane-strain modulus in Pa with which a Hertz contact of a mass m at the speed v, on a ball of the tip's radius,
// lasts `time` without damping: the greatest depth is time v/2.9432, and k = 5/4 m v^2/depth^(5/2) = 4/3 sqrt(R) E.
double HertzModulus(double m, double v, double time) {
  const double depth = time * v / 2.9432;
  return 1.25 * m * v * v / std::pow(depth, 2.5) / (4.0 / 3.0 * std::sqrt(kTipRadius));
}

class CompliantSimbodyPeer final : public Peer {
 public:
  CompliantSimbodyPeer(Setup setup, double accuracy) : Peer(std::move(setup)), accuracy_(accuracy) {}

  void Prepare(const PendulumCase& c) override { world_ = std::make_unique<World>(c, accuracy_); }

  void Reset() override {
    SimTK::State state = world_->system.getDefaultState();
    state.updU()[0] = kOmegaBefore;
    world_->integrator.initialize(state);
  }

  void Run() override {
    // The contact has ended, or friction has locked it, after three times the length it has without damping.
    while (world_->integrator.getTime() < 3 * kTime) world_->integrator.stepTo(3 * kTime);
  }

  AfterImpact After() const override { return AfterAt(world_->integrator.getState().getU()[0]); }

 private:
  // Length of a contact, in s, and the slip below which friction fades, in m/s.
  static constexpr double kTime = 1e-4;
  static constexpr double kTransition = 1e-3;

  struct World {
    World(const PendulumCase& c, double accuracy)
        : pendulum(matter.Ground(), SimTK::Transform(), RodBody(c), SimTK::Transform()),
          contact(forces, contacts, contacts.createContactSet()),
          integrator(system) {
      const SimTK::ContactSetIndex set(0);
      // A half-space is empty where its x is negative.
      contacts.addBody(set, matter.updGround(), SimTK::ContactGeometry::HalfSpace(),
                       SimTK::Transform(SimTK::Rotation(-SimTK::Pi / 2, SimTK::ZAxis), Vec3(0, -c.b, 0)));
      const Rod rod(c);
      contacts.addBody(set, pendulum, SimTK::ContactGeometry::Sphere(kTipRadius),
                       SimTK::Transform(Vec3(rod.tip_x, rod.tip_y, 0)));
      const double speed = -kOmegaBefore * c.a;
      // Two equal materials are as stiff together as each of them divided by 2^(3/2).
      const double modulus = std::pow(2, 1.5) * HertzModulus(kInertiaAboutPin / (c.a * c.a), speed, kTime);
      const double damping = HuntCrossleyDamping(c.restitution, speed);
      for (const int surface : {0, 1}) {
        contact.setBodyParameters(SimTK::ContactSurfaceIndex(surface), modulus, damping, c.friction, c.friction, 0);
      }
      contact.setTransitionVelocity(kTransition);
      integrator.setAccuracy(accuracy);
      system.realizeTopology();
    }

    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter = SimTK::SimbodyMatterSubsystem(system);
    SimTK::GeneralForceSubsystem forces = SimTK::GeneralForceSubsystem(system);
    SimTK::GeneralContactSubsystem contacts = SimTK::GeneralContactSubsystem(system);
    SimTK::MobilizedBody::Pin pendulum;
    SimTK::HuntCrossleyForce contact;
    SimTK::RungeKuttaMersonIntegrator integrator;
  };

  const double accuracy_;
  std::unique_ptr<World> world_;
};

}  // namespace

Peers SimbodyPeers() {
  using Stepper = RigidSimbodyPeer::Stepper;
  Peers peers;
  const auto rigid = [&](const char* law, Stepper::RestitutionModel model, const char* method,
                         Stepper::ImpulseSolverType solver, double step, bool in_table) {
    peers.push_back(std::make_unique<RigidSimbodyPeer>(
        Setup{"Simbody", law, method, step, 0, "", "velocity thresholds 0", in_table}, model, solver));
  };
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    rigid("Poisson", Stepper::Poisson, "rigid, PLUS", Stepper::PLUS, step, step == 1e-3);
  }
  rigid("Poisson", Stepper::Poisson, "rigid, PGS", Stepper::PGS, 1e-3, false);
  rigid("Newton", Stepper::Newton, "rigid, PLUS", Stepper::PLUS, 1e-3, true);
  for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    peers.push_back(std::make_unique<CompliantSimbodyPeer>(
        Setup{"Simbody", "Hunt and Crossley", "compliant, Runge-Kutta-Merson", 0, 0,
              absl::StrFormat("accuracy %g", accuracy), "contact of 1e-4 s, transition velocity 1e-3 m/s",
              accuracy == 1e-6},
        accuracy));
  }
  return peers;
}

}  // namespace ricochet::peers
