// Box2D: revolute joint, circle against edge, single precision. A contact bounces by Newton's law; sequential impulses.

#include <box2d/box2d.h>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

class Box2dPeer final : public Peer {
 public:
  using Peer::Peer;

  void Prepare(const PendulumCase& c) override {
    rod_ = std::make_unique<Rod>(c);
    world_ = std::make_unique<b2World>(b2Vec2(0, 0));
    // Impulses of an earlier impact must not start the next one.
    world_->SetWarmStarting(false);
    world_->SetAllowSleeping(false);
    AddSurface(c);
    AddPendulum(c);
    // The first step makes the contact, which later steps only update.
    Reset();
    Run();
  }

  void Reset() override {
    body_->SetTransform(b2Vec2(0, 0), 0);
    body_->SetLinearVelocity(b2Vec2(static_cast<float>(rod_->velocity_x()), static_cast<float>(rod_->velocity_y())));
    body_->SetAngularVelocity(static_cast<float>(kOmegaBefore));
  }

  void Run() override {
    for (int i = 0; i < kMostSteps && body_->GetAngularVelocity() < -kStopped; ++i) {
      world_->Step(static_cast<float>(setup().step_s), setup().iterations, kPositionIterations);
    }
  }

  AfterImpact After() const override {
    const b2Vec2 v = body_->GetLinearVelocity();
    const double omega = body_->GetAngularVelocity();
    return {.omega = omega, .energy_j = rod_->Energy(v.x, v.y, omega)};
  }

 private:
  static constexpr int kPositionIterations = 3;

  static b2FixtureDef Fixture(const b2Shape& shape, const PendulumCase& c) {
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.friction = static_cast<float>(c.friction);
    fixture.restitution = static_cast<float>(c.restitution);
    // The engine ignores restitution below 1 m/s unless it is told otherwise.
    fixture.restitutionThreshold = 0;
    return fixture;
  }

  void AddSurface(const PendulumCase& c) {
    const b2BodyDef fixed;
    b2EdgeShape edge;
    // Edges have a skin, on which the ball rests.
    const float y = static_cast<float>(-c.b) - b2_polygonRadius;
    edge.SetTwoSided(b2Vec2(static_cast<float>(c.a) - 5, y), b2Vec2(static_cast<float>(c.a) + 5, y));
    const b2FixtureDef fixture = Fixture(edge, c);
    world_->CreateBody(&fixed)->CreateFixture(&fixture);
  }

  void AddPendulum(const PendulumCase& c) {
    b2BodyDef moving;
    moving.type = b2_dynamicBody;
    body_ = world_->CreateBody(&moving);
    b2CircleShape ball;
    ball.m_radius = static_cast<float>(kTipRadius);
    ball.m_p.Set(static_cast<float>(rod_->tip_x), static_cast<float>(rod_->tip_y));
    const b2FixtureDef fixture = Fixture(ball, c);
    body_->CreateFixture(&fixture);
    b2MassData mass;
    mass.mass = static_cast<float>(rod_->mass);
    mass.center.Set(static_cast<float>(rod_->com_x), static_cast<float>(rod_->com_y));
    mass.I = static_cast<float>(kInertiaAboutPin);
    body_->SetMassData(&mass);
    // The pin is a body of its own, because bodies that a joint connects do not collide by default.
    const b2BodyDef fixed;
    b2RevoluteJointDef joint;
    joint.Initialize(world_->CreateBody(&fixed), body_, b2Vec2(0, 0));
    world_->CreateJoint(&joint);
  }

  std::unique_ptr<Rod> rod_;
  std::unique_ptr<b2World> world_;
  b2Body* body_ = nullptr;
};

}  // namespace

Peers Box2dPeers() {
  Peers peers;
  const auto add = [&](double step, int iterations) {
    peers.push_back(std::make_unique<Box2dPeer>(Setup{"Box2D", "Newton", "sequential impulses", step, iterations, "",
                                                      "restitution threshold 0, no warm start, 3 position iterations",
                                                      step == 1e-3 && iterations == 8}));
  };
  for (const int iterations : {1, 8, 50, 500, 5000}) add(1e-3, iterations);
  for (const double step : {1.0 / 60, 1e-4}) add(step, 8);
  return peers;
}

}  // namespace ricochet::peers
