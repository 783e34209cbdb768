// Bullet in double precision: ball against plane, and a hinge between rigid bodies, or a revolute link in generalized
// coordinates (Featherstone). A contact bounces by Newton's law; sequential impulses, or a linear complementarity
// problem solved by pivoting (Dantzig).

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

// Drops the contacts of the impact before, which keep its impulses.
void ForgetContacts(btDispatcher& dispatcher) {
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) dispatcher.getManifoldByIndexInternal(i)->clearManifold();
}

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
    ForgetContacts(world_->dispatcher);
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

class BulletMultiBodyPeer final : public Peer {
 public:
  using Peer::Peer;

  void Prepare(const PendulumCase& c) override {
    world_ = std::make_unique<World>(c);
    btContactSolverInfo& info = world_->dynamics.getSolverInfo();
    info.m_numIterations = setup().iterations;
    info.m_restitutionVelocityThreshold = 0;
  }

  void Reset() override {
    btMultiBody& pendulum = world_->pendulum;
    pendulum.setJointPos(0, 0);
    pendulum.setJointVel(0, kOmegaBefore);
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    pendulum.forwardKinematics(turns, places);
    pendulum.updateCollisionObjectWorldTransforms(turns, places);
    ForgetContacts(world_->dispatcher);
  }

  void Run() override {
    for (int i = 0; i < kMostSteps && world_->pendulum.getJointVel(0) < -kStopped; ++i) {
      world_->dynamics.stepSimulation(setup().step_s, 0);
    }
  }

  AfterImpact After() const override { return AfterAt(world_->pendulum.getJointVel(0)); }

 private:
  struct World {
    explicit World(const PendulumCase& c)
        : ground_shape(btVector3(0, 1, 0), -c.b),
          ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_shape)) {
      const Rod rod(c);
      const btVector3 com(rod.com_x, rod.com_y, 0);
      pendulum.setupRevolute(0, rod.mass, btVector3(rod.inertia_com, rod.inertia_com, rod.inertia_com), -1,
                             btQuaternion::getIdentity(), btVector3(0, 0, 1), btVector3(0, 0, 0), com);
      pendulum.finalizeMultiDof();
      pendulum.setLinearDamping(0);
      pendulum.setAngularDamping(0);
      shape.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(rod.tip_x, rod.tip_y, 0) - com), &ball);
      tip.setCollisionShape(&shape);
      tip.setFriction(c.friction);
      tip.setRestitution(c.restitution);
      ground.setFriction(1);
      ground.setRestitution(1);
      pendulum.getLink(0).m_collider = &tip;
      dynamics.setGravity(btVector3(0, 0, 0));
      dynamics.addRigidBody(&ground);
      dynamics.addMultiBody(&pendulum);
      dynamics.addCollisionObject(&tip, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
    }
    ~World() {
      dynamics.removeCollisionObject(&tip);
      dynamics.removeMultiBody(&pendulum);
      dynamics.removeRigidBody(&ground);
    }

    btSphereShape ball = btSphereShape(kTipRadius);
    btCompoundShape shape;
    btStaticPlaneShape ground_shape;
    btRigidBody ground;
    // One link on a base that does not move; it may not fall asleep.
    btMultiBody pendulum = btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    btMultiBodyLinkCollider tip = btMultiBodyLinkCollider(&pendulum, 0);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher = btCollisionDispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btMultiBodyConstraintSolver solver;
    btMultiBodyDynamicsWorld dynamics = btMultiBodyDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration);
  };

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
  for (const int iterations : {1, 10, 100, 1000, 10000}) {
    peers.push_back(std::make_unique<BulletMultiBodyPeer>(
        Setup{"Bullet", "Newton", "multibody, sequential impulses", 1e-3, iterations, "",
              "restitution threshold 0, no damping", iterations == 10}));
  }
  return peers;
}

}  // namespace ricochet::peers
