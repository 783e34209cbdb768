// Chipmunk: pivot joint, circle against segment. A contact bounces by Newton's law; sequential impulses.

#include <chipmunk/chipmunk.h>

#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

// The ball starts this deep in the surface, in m, because the engine makes no contact at a depth of 0.
constexpr double kDepth = 1e-12;
// Before an impact the pendulum is turned by this angle, in rad, away from the surface, so that the engine forgets the
// impact before.
constexpr double kAway = 0.5;

class ChipmunkPeer final : public Peer {
 public:
  using Peer::Peer;
  ~ChipmunkPeer() override { Clear(); }

  void Prepare(const PendulumCase& c) override {
    Clear();
    rod_ = std::make_unique<Rod>(c);
    space_ = cpSpaceNew();
    cpSpaceSetIterations(space_, setup().iterations);
    cpSpaceSetCollisionPersistence(space_, 1);
    body_ = cpSpaceAddBody(space_, cpBodyNew(rod_->mass, rod_->inertia_com));
    cpBodySetPosition(body_, cpv(rod_->com_x, rod_->com_y));
    cpBody* fixed = cpSpaceGetStaticBody(space_);
    cpSpaceAddConstraint(space_, cpPivotJointNew(body_, fixed, cpvzero));
    const double y = -c.b + kDepth;
    Add(cpSegmentShapeNew(fixed, cpv(c.a - 5, y), cpv(c.a + 5, y), 0), 1, 1);
    // The product of the two bodies' numbers is what acts.
    Add(cpCircleShapeNew(body_, kTipRadius, cpv(rod_->tip_x - rod_->com_x, rod_->tip_y - rod_->com_y)), c.friction,
        c.restitution);
  }

  void Reset() override {
    const cpVect turn = cpvforangle(kAway);
    Place(cpvrotate(cpv(rod_->com_x, rod_->com_y), turn), kAway, cpvzero, 0);
    cpSpaceStep(space_, setup().step_s);
    // A step moves bodies before it looks for contacts; the pendulum therefore starts one step ahead of touch.
    const double step = setup().step_s;
    const cpVect velocity = cpv(rod_->velocity_x(), rod_->velocity_y());
    Place(cpvsub(cpv(rod_->com_x, rod_->com_y), cpvmult(velocity, step)), -kOmegaBefore * step, velocity, kOmegaBefore);
  }

  void Run() override {
    for (int i = 0; i < kMostSteps && cpBodyGetAngularVelocity(body_) < -kStopped; ++i) {
      cpSpaceStep(space_, setup().step_s);
    }
  }

  AfterImpact After() const override {
    const cpVect v = cpBodyGetVelocity(body_);
    const double omega = cpBodyGetAngularVelocity(body_);
    return {.omega = omega, .energy_j = rod_->Energy(v.x, v.y, omega)};
  }

 private:
  void Add(cpShape* shape, double friction, double restitution) {
    cpShapeSetFriction(shape, friction);
    cpShapeSetElasticity(shape, restitution);
    cpSpaceAddShape(space_, shape);
  }

  void Place(cpVect position, double angle, cpVect velocity, double omega) {
    cpBodySetPosition(body_, position);
    cpBodySetAngle(body_, angle);
    cpBodySetVelocity(body_, velocity);
    cpBodySetAngularVelocity(body_, omega);
  }

  void Clear() {
    if (space_ == nullptr) return;
    cpSpaceEachShape(
        space_,
        [](cpShape* shape, void* space) {
          cpSpaceAddPostStepCallback(
              static_cast<cpSpace*>(space),
              [](cpSpace* owner, void* key, void*) {
                cpSpaceRemoveShape(owner, static_cast<cpShape*>(key));
                cpShapeFree(static_cast<cpShape*>(key));
              },
              shape, nullptr);
        },
        space_);
    cpSpaceFree(space_);
    space_ = nullptr;
  }

  std::unique_ptr<Rod> rod_;
  cpSpace* space_ = nullptr;
  cpBody* body_ = nullptr;
};

}  // namespace

Peers ChipmunkPeers() {
  Peers peers;
  const auto add = [&](double step, int iterations) {
    peers.push_back(std::make_unique<ChipmunkPeer>(Setup{"Chipmunk", "Newton", "sequential impulses", step, iterations,
                                                         "", "contacts are forgotten between impacts",
                                                         step == 1e-3 && iterations == 10}));
  };
  for (const int iterations : {1, 10, 100, 1000, 10000}) add(1e-3, iterations);
  for (const double step : {1.0 / 60, 1e-4}) add(step, 10);
  return peers;
}

}  // namespace ricochet::peers
