// Bullet in double precision: hinge, ball against plane. A contact bounces by Newton's law; sequential impulses, or a linear
// complementarity problem solved by pivoting (Dantzig).

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

class BulletPeer final : public Peer {
 public:
  enum class Solver { kSequentialImpulses, kDantzig };
  BulletPeer(Setup setup, Solver solver) : Peer(std::move(setup)), solver_(solver) {}

  void Prepare(const PendulumCase& c) override {
    world_ = std::make_unique<World>(solver_, c);
    btContactSolverInfo& info = world_->dynamics.getSolverInfo();
    if (solver_ == Solver::kSequentialImpulses) info.m_numIterations = setup().iterations;
    // Slower impacts than .2 m/s would not bounce by default.
    info.m_restitutionVelocityThreshold = 0;
  }

  void Reset() override {
    const Rod& rod = world_->rod;
    btRigidBody& body = world_->body;
    const btTransform start(btQuaternion::getIdentity(), btVector3(rod.com_x, rod.com_y, 0));
    body.setCenterOfMassTransform(start);
    body.setInterpolationWorldTransform(start);
    body.setLinearVelocity(btVector3(rod.velocity_x(), rod.velocity_y(), 0));
    body.setAngularVelocity(btVector3(0, 0, kOmegaBefore));
    // Contacts keep the impulses of the impact before.
    for (int i = 0; i < world_->dispatcher.getNumManifolds(); ++i) {
      world_->dispatcher.getManifoldByIndexInternal(i)->clearManifold();
    }
  }

  void Run() override {
    for (int i = 0; i < kMostSteps && world_->body.getAngularVelocity().z() < -kStopped; ++i) {
      world_->dynamics.stepSimulation(setup().step_s, 0);
    }
  }

  AfterImpact After() const override {
    const btVector3& v = world_->body.getLinearVelocity();
    const double omega = world_->body.getAngularVelocity().z();
    return {.omega = omega, .energy_j = world_->rod.Energy(v.x(), v.y(), omega)};
  }

 private:
  struct World {
    World(Solver solver, const PendulumCase& c)
        : rod(c),
          ground_shape(btVector3(0, 1, 0), -c.b),
          ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_shape)),
          body(BodyInfo(rod, shape)),
          hinge(body, btVector3(-rod.com_x, -rod.com_y, 0), btVector3(0, 0, 1)),
          dynamics(&dispatcher, &broadphase,
                   solver == Solver::kDantzig ? static_cast<btConstraintSolver*>(&direct) : &sequential,
                   &configuration) {
      shape.addChildShape(
          btTransform(btQuaternion::getIdentity(), btVector3(rod.tip_x - rod.com_x, rod.tip_y - rod.com_y, 0)), &ball);
      // The product of the two bodies' numbers is what acts.
      body.setFriction(c.friction);
      body.setRestitution(c.restitution);
      ground.setFriction(1);
      ground.setRestitution(1);
      body.setActivationState(DISABLE_DEACTIVATION);
      dynamics.setGravity(btVector3(0, 0, 0));
      dynamics.addRigidBody(&ground);
      dynamics.addRigidBody(&body);
      dynamics.addConstraint(&hinge);
    }
    ~World() {
      dynamics.removeConstraint(&hinge);
      dynamics.removeRigidBody(&body);
      dynamics.removeRigidBody(&ground);
    }

    // The hinge takes its place in the world from where the body is at first.
    static btRigidBody::btRigidBodyConstructionInfo BodyInfo(const Rod& rod, btCompoundShape& shape) {
      btRigidBody::btRigidBodyConstructionInfo info(rod.mass, nullptr, &shape,
                                                    btVector3(rod.inertia_com, rod.inertia_com, rod.inertia_com));
      info.m_startWorldTransform.setOrigin(btVector3(rod.com_x, rod.com_y, 0));
      return info;
    }

    Rod rod;
    btSphereShape ball = btSphereShape(kTipRadius);
    btCompoundShape shape;
    btStaticPlaneShape ground_shape;
    btRigidBody ground;
    btRigidBody body;
    btHingeConstraint hinge;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher = btCollisionDispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver sequential;
    btDantzigSolver dantzig;
    btMLCPSolver direct = btMLCPSolver(&dantzig);
    btDiscreteDynamicsWorld dynamics;
  };

  const Solver solver_;
  std::unique_ptr<World> world_;
};

}  // namespace

Peers BulletPeers() {
  Peers peers;
  const auto add = [&](BulletPeer::Solver solver, const char* method, double step, int iterations, bool in_table) {
    peers.push_back(std::make_unique<BulletPeer>(
        Setup{"Bullet", "Newton", method, step, iterations, "", "restitution threshold 0", in_table}, solver));
  };
  for (const double step : {1.0 / 60, 1e-3, 1e-4}) {
    add(BulletPeer::Solver::kDantzig, "MLCP, Dantzig", step, 0, step == 1e-3);
  }
  for (const int iterations : {1, 10, 100, 1000, 10000}) {
    add(BulletPeer::Solver::kSequentialImpulses, "sequential impulses", 1e-3, iterations, iterations == 10);
  }
  for (const double step : {1.0 / 60, 1e-4}) {
    add(BulletPeer::Solver::kSequentialImpulses, "sequential impulses", step, 10, false);
  }
  return peers;
}

}  // namespace ricochet::peers
