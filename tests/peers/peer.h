// Peer: a physics engine that lets the paper's pendulum strike a fixed surface, by its own hinge and its own contact.
//
// The pendulum is a uniform thin rod from the pin O to its tip at (a, -b), in metres. Its moment of inertia about the
// pin is 1 kg m^2 and its angular velocity before the impact is -1 rad/s, so that numbers of different engines compare.
// The tip is a small ball whose lowest point touches the surface y = -b when an impact starts. There is no gravity, as
// weight gives no impulse.
//
// A peer is one engine with fixed settings: Prepare builds its world, Reset puts the pendulum back to where an impact
// starts, Run is the part that is timed. Two-dimensional engines work in the plane (x, y); the others turn about z.

#ifndef RICOCHET_TESTS_PEERS_PEER_H_
#define RICOCHET_TESTS_PEERS_PEER_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ricochet::peers {

inline constexpr double kInertiaAboutPin = 1.0;  // J0, kg m^2
inline constexpr double kOmegaBefore = -1.0;     // omega-, rad/s
inline constexpr double kTipRadius = 0.01;       // m

struct PendulumCase {
  int number = 0;
  double a = 0.0;  // m
  double b = 0.0;
  double friction = 0.0;
  double restitution =
      0.0;  // The one number that an engine is given; each takes it for the coefficient of its own law.
};

// The uniform rod of a case.
struct Rod {
  explicit Rod(const PendulumCase& c)
      : mass(3 * kInertiaAboutPin / (c.a * c.a + c.b * c.b)),
        inertia_com(kInertiaAboutPin / 4),
        com_x(c.a / 2),
        com_y(-c.b / 2),
        tip_x(c.a),
        tip_y(-c.b + kTipRadius) {}

  double mass = 0.0;         // kg
  double inertia_com = 0.0;  // kg m^2, about the centre of mass
  double com_x = 0.0;        // m, seen from the pin
  double com_y = 0.0;
  double tip_x = 0.0;  // Centre of the ball at the tip.
  double tip_y = 0.0;

  // Velocity of the centre of mass at the start of an impact, m/s.
  double velocity_x() const { return -kOmegaBefore * com_y; }
  double velocity_y() const { return kOmegaBefore * com_x; }
  // Kinetic energy in J of the rod in the plane, also if the hinge has let its centre of mass drift.
  double Energy(double vx, double vy, double omega) const {
    return 0.5 * (mass * (vx * vx + vy * vy) + inertia_com * omega * omega);
  }
};

struct Setup {
  std::string engine;
  std::string law;     // The law of impact that the engine states, such as "Newton".
  std::string method;  // Its solver; peers that differ only in what follows form one line of the diagram.
  double step_s = 0.0;
  int iterations = 0;     // 0: the solver does not iterate, or by a tolerance of its own.
  std::string varied;     // Other settings that differ between the points of a line, such as the length of a contact.
  std::string fixed;      // Other settings that are common to all points of a line.
  bool in_table = false;  // Whether these are the settings that the engine's documents recommend.
};

struct AfterImpact {
  double omega = 0.0;     // rad/s
  double energy_j = 0.0;  // Kinetic energy.
};

// The state of a rod whose hinge lets nothing drift.
inline AfterImpact AfterAt(double omega) { return {omega, 0.5 * kInertiaAboutPin * omega * omega}; }

class Peer {
 public:
  explicit Peer(Setup setup) : setup_(std::move(setup)) {}
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  const Setup& setup() const { return setup_; }

  virtual void Prepare(const PendulumCase& c) = 0;
  virtual void Reset() = 0;
  // Runs impacts_per_run() impacts from where Reset has put the pendulum.
  virtual void Run() = 0;
  virtual AfterImpact After() const = 0;
  virtual int impacts_per_run() const { return 1; }

 private:
  Setup setup_;
};

using Peers = std::vector<std::unique_ptr<Peer>>;

// Rigid engines take one step for an impact. If their solver has not converged, the contact may still approach after
// it; they then take more steps, at most this many.
inline constexpr int kMostSteps = 10;
// Slower rotation than this towards the surface, in rad/s, is none.
inline constexpr double kStopped = 1e-6;

// One function for each engine that this build has, with all settings that are measured.
Peers BulletPeers();
Peers Box2dPeers();
Peers ChipmunkPeers();
Peers DartPeers();
Peers MujocoPeers();
Peers OdePeers();
Peers RicochetPeers();
Peers SiconosPeers();
Peers SimbodyPeers();

}  // namespace ricochet::peers

#endif  // RICOCHET_TESTS_PEERS_PEER_H_
