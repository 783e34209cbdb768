// DART: revolute joint in generalized coordinates, ball against box. A contact bounces by Newton's law; the boxed
// linear complementarity problem is solved by pivoting (Dantzig) or by projected Gauss-Seidel sweeps.

// The umbrella header includes files that Debian's package lacks.
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::CollisionAspect;
using dart::dynamics::DynamicsAspect;
using dart::dynamics::Skeleton;

// The ball starts this deep in the surface, in m, because the engine makes no contact at a depth of 0.
constexpr double kDepth = 1e-12;

class DartPeer final : public Peer {
 public:
  enum class Solver { kDantzig, kGaussSeidel };
  DartPeer(Setup setup, Solver solver) : Peer(std::move(setup)), solver_(solver) {}

  void Prepare(const PendulumCase& c) override {
    world_ = dart::simulation::World::create();
    world_->setGravity(Eigen::Vector3d::Zero());
    world_->setTimeStep(setup().step_s);
    SetSolver();
    world_->addSkeleton(Surface(c));
    pendulum_ = Pendulum(c);
    world_->addSkeleton(pendulum_);
  }

  void Reset() override {
    pendulum_->setPosition(0, 0);
    pendulum_->setVelocity(0, kOmegaBefore);
  }

  void Run() override {
    for (int i = 0; i < kMostSteps && pendulum_->getVelocity(0) < -kStopped; ++i) world_->step();
  }

  AfterImpact After() const override { return AfterAt(pendulum_->getVelocity(0)); }

 private:
  void SetSolver() {
    using dart::constraint::BoxedLcpConstraintSolver;
    if (solver_ == Solver::kDantzig) {
      world_->setConstraintSolver(
          std::make_unique<BoxedLcpConstraintSolver>(std::make_shared<dart::constraint::DantzigBoxedLcpSolver>()));
    } else {
      auto sweeps = std::make_shared<dart::constraint::PgsBoxedLcpSolver>();
      dart::constraint::PgsBoxedLcpSolver::Option option;
      option.mMaxIteration = setup().iterations;
      sweeps->setOption(option);
      world_->setConstraintSolver(std::make_unique<BoxedLcpConstraintSolver>(sweeps, nullptr));
    }
    // This detector finds the exact contact of a ball and a box.
    world_->getConstraintSolver()->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
  }

  static void AddShape(BodyNode& body, const dart::dynamics::ShapePtr& shape, const Eigen::Vector3d& at,
                       double friction, double restitution) {
    auto* node = body.createShapeNodeWith<CollisionAspect, DynamicsAspect>(shape);
    node->setRelativeTranslation(at);
    node->getDynamicsAspect()->setFrictionCoeff(friction);
    node->getDynamicsAspect()->setRestitutionCoeff(restitution);
  }

  static dart::dynamics::SkeletonPtr Surface(const PendulumCase& c) {
    auto surface = Skeleton::create("surface");
    BodyNode* body = surface->createJointAndBodyNodePair<dart::dynamics::WeldJoint>().second;
    // The less of the two bodies' friction acts, and the product of their restitution.
    AddShape(*body, std::make_shared<dart::dynamics::BoxShape>(Eigen::Vector3d(20, 1, 20)),
             Eigen::Vector3d(0, -c.b - 0.5 + kDepth, 0), c.friction, 1);
    return surface;
  }

  static dart::dynamics::SkeletonPtr Pendulum(const PendulumCase& c) {
    const Rod rod(c);
    auto pendulum = Skeleton::create("pendulum");
    dart::dynamics::RevoluteJoint::Properties pin;
    pin.mAxis = Eigen::Vector3d::UnitZ();
    BodyNode* body = pendulum->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(nullptr, pin).second;
    body->setInertia(dart::dynamics::Inertia(rod.mass, Eigen::Vector3d(rod.com_x, rod.com_y, 0),
                                             rod.inertia_com * Eigen::Matrix3d::Identity()));
    AddShape(*body, std::make_shared<dart::dynamics::SphereShape>(kTipRadius), Eigen::Vector3d(rod.tip_x, rod.tip_y, 0),
             c.friction, c.restitution);
    return pendulum;
  }

  const Solver solver_;
  dart::simulation::WorldPtr world_;
  dart::dynamics::SkeletonPtr pendulum_;
};

}  // namespace

Peers DartPeers() {
  Peers peers;
  const auto add = [&](DartPeer::Solver solver, const char* method, double step, int iterations, bool in_table) {
    peers.push_back(std::make_unique<DartPeer>(
        Setup{"DART", "Newton", method, step, iterations, "", "DARTCollisionDetector", in_table}, solver));
  };
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    add(DartPeer::Solver::kDantzig, "boxed LCP, Dantzig", step, 0, step == 1e-3);
  }
  for (const int iterations : {1, 30, 1000}) {
    add(DartPeer::Solver::kGaussSeidel, "boxed LCP, Gauss-Seidel", 1e-3, iterations, iterations == 30);
  }
  return peers;
}

}  // namespace ricochet::peers
