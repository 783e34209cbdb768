// The Open Dynamics Engine: hinge joint, ball against plane. A rigid contact bounces by Newton's law; a soft one is a
// spring and a damper that the engine states as ERP and CFM.

#include <ode/ode.h>

#include "absl/strings/str_format.h"
#include "tests/peers/peer.h"
#include "tests/peers/spring_contact.h"

namespace ricochet::peers {
namespace {

// The ball starts this deep in the surface, in m, because the engine makes no contact at a depth of 0.
constexpr double kDepth = 1e-12;
constexpr double kSoftening = 1e-11;

class OdePeer final : public Peer {
 public:
  enum class Stepper { kDirect, kQuick };
  // `steps_per_contact` is the number of steps that a soft contact lasts; 0 means that the contact is rigid.
  OdePeer(Setup setup, Stepper stepper, int steps_per_contact)
      : Peer(std::move(setup)), stepper_(stepper), steps_per_contact_(steps_per_contact) {
    static const int initialized = dInitODE2(0);
    static_cast<void>(initialized);
  }
  ~OdePeer() override { Clear(); }

  void Prepare(const PendulumCase& c) override {
    Clear();
    case_ = c;
    rod_ = std::make_unique<Rod>(c);
    world_ = dWorldCreate();
    // The engine softens rigid constraints by CFM/dt, in rad^2/(kg m^2); the hinge and the contact together need a
    // little.
    dWorldSetCFM(world_, kSoftening * setup().step_s);
    contacts_ = dJointGroupCreate(0);
    if (stepper_ == Stepper::kQuick) dWorldSetQuickStepNumIterations(world_, setup().iterations);
    // The body's origin is the centre of mass, as the engine demands.
    body_ = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, rod_->mass, 0, 0, 0, rod_->inertia_com, rod_->inertia_com, rod_->inertia_com, 0, 0, 0);
    dBodySetMass(body_, &mass);
    Reset();
    const dJointID hinge = dJointCreateHinge(world_, nullptr);
    dJointAttach(hinge, body_, nullptr);
    dJointSetHingeAnchor(hinge, 0, 0, 0);
    dJointSetHingeAxis(hinge, 0, 0, 1);
    ball_ = dCreateSphere(nullptr, kTipRadius);
    dGeomSetBody(ball_, body_);
    dGeomSetOffsetPosition(ball_, rod_->tip_x - rod_->com_x, rod_->tip_y - rod_->com_y, 0);
    plane_ = dCreatePlane(nullptr, 0, 1, 0, -c.b + kDepth);
    SetSurface();
  }

  void Reset() override {
    // The iterative solver takes the constraints in a random order.
    dRandSetSeed(1);
    dBodySetPosition(body_, rod_->com_x, rod_->com_y, 0);
    const dQuaternion upright = {1, 0, 0, 0};
    dBodySetQuaternion(body_, upright);
    dBodySetLinearVel(body_, rod_->velocity_x(), rod_->velocity_y(), 0);
    dBodySetAngularVel(body_, 0, 0, kOmegaBefore);
  }

  void Run() override {
    if (steps_per_contact_ == 0) {
      for (int i = 0; i < kMostSteps && omega() < -kStopped; ++i) Step();
    } else {
      // A contact that friction locks stays in touch for ever; four times its length is enough for it to come to rest.
      for (int i = 0; i < 4 * steps_per_contact_ && Step(); ++i) continue;
    }
  }

  AfterImpact After() const override {
    const dReal* v = dBodyGetLinearVel(body_);
    return {.omega = omega(), .energy_j = rod_->Energy(v[0], v[1], omega())};
  }

 private:
  double omega() const { return dBodyGetAngularVel(body_)[2]; }

  void SetSurface() {
    surface_ = {};
    // Friction is bounded by mu times the normal force only in the approximation that this flag names.
    surface_.mode = dContactApprox1;
    surface_.mu = case_.friction;
    if (steps_per_contact_ == 0) {
      surface_.mode |= dContactBounce;
      surface_.bounce = case_.restitution;
      surface_.bounce_vel = 0;
    } else {
      const SpringContact spring = SpringFor(case_, steps_per_contact_ * setup().step_s);
      surface_.mode |= dContactSoftERP | dContactSoftCFM;
      const double kh = spring.stiffness * setup().step_s;
      surface_.soft_erp = kh / (kh + spring.damping);
      surface_.soft_cfm = 1 / (kh + spring.damping);
    }
  }

  // Returns whether the ball touched the surface in this step.
  bool Step() {
    dContact contact = {};
    const bool touches = dCollide(ball_, plane_, 1, &contact.geom, sizeof contact) > 0;
    if (touches) {
      contact.surface = surface_;
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
    }
    if (stepper_ == Stepper::kDirect) {
      dWorldStep(world_, setup().step_s);
    } else {
      dWorldQuickStep(world_, setup().step_s);
    }
    dJointGroupEmpty(contacts_);
    return touches;
  }

  void Clear() {
    if (world_ == nullptr) return;
    dGeomDestroy(ball_);
    dGeomDestroy(plane_);
    dJointGroupDestroy(contacts_);
    dWorldDestroy(world_);
    world_ = nullptr;
  }

  const Stepper stepper_;
  const int steps_per_contact_;
  PendulumCase case_;
  std::unique_ptr<Rod> rod_;
  dWorldID world_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  dBodyID body_ = nullptr;
  dGeomID ball_ = nullptr;
  dGeomID plane_ = nullptr;
  dSurfaceParameters surface_ = {};
};

}  // namespace

Peers OdePeers() {
  Peers peers;
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    peers.push_back(std::make_unique<OdePeer>(
        Setup{"ODE", "Newton", "dWorldStep", step, 0, "", "dContactBounce, dContactApprox1", step == 1e-3},
        OdePeer::Stepper::kDirect, 0));
  }
  for (const int iterations : {5, 20, 100, 1000}) {
    peers.push_back(std::make_unique<OdePeer>(Setup{"ODE", "Newton", "dWorldQuickStep", 1e-3, iterations, "",
                                                    "dContactBounce, dContactApprox1", iterations == 20},
                                              OdePeer::Stepper::kQuick, 0));
  }
  for (const int steps : {30, 100, 300, 1000, 3000, 10000}) {
    peers.push_back(
        std::make_unique<OdePeer>(Setup{"ODE", "spring and damper", "dWorldStep, soft contact", kContactTime / steps, 0,
                                        absl::StrFormat("contact of %d steps", steps),
                                        "dContactSoftERP, dContactSoftCFM, dContactApprox1", steps == 3000},
                                  OdePeer::Stepper::kDirect, steps));
  }
  return peers;
}

}  // namespace ricochet::peers
