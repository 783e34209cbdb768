// Siconos: the pendulum as a Lagrangian system of one degree of freedom, stepped by Moreau and Jean's scheme. A contact
// bounces by Newton's law (NewtonImpactFrictionNSL); three solvers of the frictional contact problem in a plane.

#include <SolverOptions.h>

#include <SiconosKernel.hpp>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

class SiconosPeer final : public Peer {
 public:
  SiconosPeer(Setup setup, int solver) : Peer(std::move(setup)), solver_(solver) {}

  void Prepare(const PendulumCase& c) override {
    const auto angle = std::make_shared<SiconosVector>(1);
    const auto rate = std::make_shared<SiconosVector>(1);
    (*rate)(0) = kOmegaBefore;
    const auto inertia = std::make_shared<SimpleMatrix>(1, 1);
    (*inertia)(0, 0) = kInertiaAboutPin;
    pendulum_ = std::make_shared<LagrangianLinearTIDS>(angle, rate, inertia);
    // Gap and slip of the contact are a and b times the angle.
    const auto jacobian = std::make_shared<SimpleMatrix>(2, 1);
    (*jacobian)(0, 0) = c.a;
    (*jacobian)(1, 0) = c.b;
    contact_ = std::make_shared<Interaction>(std::make_shared<NewtonImpactFrictionNSL>(c.restitution, 0, c.friction, 2),
                                             std::make_shared<LagrangianLinearTIR>(jacobian));
    system_ = std::make_shared<NonSmoothDynamicalSystem>(0, 1e12);
    system_->insertDynamicalSystem(pendulum_);
    system_->link(contact_, pendulum_);
    problem_ = std::make_shared<FrictionContact>(2, solver_);
    if (setup().iterations > 0) problem_->numericsSolverOptions()->iparam[SICONOS_IPARAM_MAX_ITER] = setup().iterations;
    problem_->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = 1e-12;
    simulation_ = std::make_shared<TimeStepping>(system_, std::make_shared<TimeDiscretisation>(0, setup().step_s),
                                                 std::make_shared<MoreauJeanOSI>(0.5), problem_);
    simulation_->setWarnOnNonConvergence(false);
    // The answer is taken whatever the solver says of it.
    simulation_->setCheckSolverFunction([](int, Simulation*) {});
    simulation_->computeOneStep();
  }

  void Reset() override {
    (*pendulum_->q())(0) = 0;
    (*pendulum_->velocity())(0) = kOmegaBefore;
    const double time = simulation_->nextTime();
    contact_->resetAllLambda();
    system_->updateOutput(time, 0);
    system_->updateOutput(time, 1);
    simulation_->nextStep();
  }

  void Run() override { simulation_->computeOneStep(); }

  AfterImpact After() const override { return AfterAt((*pendulum_->velocity())(0)); }

 private:
  const int solver_;
  std::shared_ptr<LagrangianLinearTIDS> pendulum_;
  std::shared_ptr<Interaction> contact_;
  std::shared_ptr<NonSmoothDynamicalSystem> system_;
  std::shared_ptr<FrictionContact> problem_;
  std::shared_ptr<TimeStepping> simulation_;
};

}  // namespace

Peers SiconosPeers() {
  Peers peers;
  const auto add = [&](const char* method, int solver, double step, int iterations, bool in_table) {
    peers.push_back(std::make_unique<SiconosPeer>(
        Setup{"Siconos", "Newton", method, step, iterations, "", "Moreau-Jean, theta 1/2, tolerance 1e-12", in_table},
        solver));
  };
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    add("one degree of freedom, Lemke", SICONOS_FRICTION_2D_LEMKE, step, 0, step == 1e-3);
  }
  for (const int iterations : {10, 1000, 10000}) {
    add("one degree of freedom, NSGS", SICONOS_FRICTION_2D_NSGS, 1e-3, iterations, iterations == 1000);
  }
  add("one degree of freedom, enumeration", SICONOS_FRICTION_2D_ENUM, 1e-3, 0, true);
  return peers;
}

}  // namespace ricochet::peers
