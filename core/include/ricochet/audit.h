// Audit: what an observed impact implies, and which limits of an admissible impact it breaks.
//
// These structs mirror ricochet.v1.AuditReport and AuditSummary. docs/theory/audit.md says how each number is found
// and how exact it is. Units are N s, J and m/s; coefficients have none.

#ifndef RICOCHET_AUDIT_H_
#define RICOCHET_AUDIT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "ricochet/outcome.h"
#include "ricochet/sweep.h"

namespace ricochet {

// The observed state after the impact is either the velocity of the contact relative to the surface, or all velocities
// of the system in the order in which an outcome lists them: the rate of a pendulum, those of links or coordinates, or
// for each body its linear velocity, then its angular one. std::monostate means that the request stated neither, which
// is a violation.
struct ObservedRates {
  Components values = {};
  friend bool operator==(const ObservedRates&, const ObservedRates&) = default;
};
using Observed = std::variant<std::monostate, ContactVelocity, ObservedRates>;

// A call may have at most this many rows.
inline constexpr int64_t kMostAuditRows = 8192;

// A number of the scene that differs from row to row.
struct InputColumn {
  std::string path = {};            // Spelled as for an axis of a sweep.
  std::vector<double> values = {};  // One for each row, or one for all.
  friend bool operator==(const InputColumn&, const InputColumn&) = default;
};

// AuditColumns holds many impacts of one scene, one row for each impact. A column has one value for each row, or a
// single value that holds for all rows; the longest column determines the number of rows. Systems in space, and only
// they, have the columns of the second tangential direction. Velocities are those of the contact relative to the
// surface; the velocities of the system after the impact may be stated in place of that of the contact. Velocities
// before the impact and friction are refused beside inputs, which state numbers of the scene itself.
struct AuditColumns {
  std::vector<double> tangential_m_s = {};  // Velocity before the impact; an empty column leaves that of the scene.
  std::vector<double> tangential_2_m_s = {};
  std::vector<double> normal_m_s = {};
  std::vector<double> tangential_after_m_s = {};
  std::vector<double> tangential_2_after_m_s = {};
  std::vector<double> normal_after_m_s = {};
  std::vector<double> friction = {};  // Both coefficients of friction; empty means the scene's, at each approach speed.
  std::vector<double> velocity_uncertainty_m_s = {};  // Empty means 0.
  // One column for each velocity, in the order of ObservedRates; refused beside a velocity before the impact, which is
  // then the scene's.
  std::vector<std::vector<double>> rates_after = {};
  friend bool operator==(const AuditColumns&, const AuditColumns&) = default;
};

// The first two limits have the same numbers as in ricochet::LimitKind.
enum class AuditLimit {
  kUnspecified = 0,
  kSharp = 1,          // The energetic coefficient is at most 1.
  kEnergy = 2,         // No kinetic energy is gained.
  kNormalImpulse = 3,  // The normal impulse is not negative.
  kPenetration = 4,    // The bodies separate after the impact.
  kCone = 5,           // The impulse lies in the friction cone.
};
inline constexpr int kAuditLimitCount = 6;

enum class Verdict {
  kUnspecified = 0,
  kKept = 1,
  kWithinUncertainty = 2,  // The limit is exceeded by no more than its allowance.
  kBroken = 3,
};

struct LimitCheck {
  double value = 0.0;      // kSharp: energetic coefficient; kEnergy: E+ - E-; then p_n, v+_n and |p_t|.
  double limit = 0.0;      // kSharp: 1; kCone: mu_s p_n; all others: 0.
  double excess = 0.0;     // How far the value lies beyond the limit, without cancellation; negative if it keeps it.
  double allowance = 0.0;  // To first order the largest excess that the uncertainty can cause.
  Verdict verdict = Verdict::kUnspecified;
  friend bool operator==(const LimitCheck&, const LimitCheck&) = default;
};

// The path is the impact that Coulomb friction gives, followed as far as the observed normal impulse. In a plane only
// the first tangential direction is used; the second component is 0.
struct AuditReport {
  Regime regime = Regime::kUnspecified;  // The regime of the path up to the observed normal impulse.
  int w_rank = 0;
  bool admissible = false;  // The observation is explained and breaks no limit.
  // W is rank deficient or the contact separates, and the path misses the observed velocity; or no impulse at the
  // contact makes all observed velocities of the system.
  bool unexplained = false;
  double distance = 0.0;  // Distance of the observed velocity to the nearest point of the path, m/s; 0 if explained.
  bool compression_ended = false;  // If false, p_n < tau_c, Poisson's coefficient is negative and the energetic one 0.
  double newton = 0.0;
  double poisson = 0.0;
  double energetic = 0.0;
  double tangential = 0.0;                        // p_t/p_n, in space |p_t|/p_n; 0 if there is no normal impulse.
  double normal_impulse = 0.0;                    // p_n
  double normal_impulse_compression = 0.0;        // tau_c of the path
  std::array<double, 2> tangential_impulse = {};  // p_t
  std::array<double, 2> friction_mismatch = {};   // p_t minus the tangential impulse of the path, N s.
  double normal_impulse_uncertainty = 0.0;        // N s
  std::array<double, 2> tangential_impulse_uncertainty = {};
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;
  double residual = 0.0;
  std::array<double, 2> path_tangential_velocity = {};  // Velocity of the path at the observed normal impulse.
  double path_normal_velocity = 0.0;
  std::array<LimitCheck, kAuditLimitCount> limits = {};  // Indexed by the number of the limit; [0] is not used.

  const LimitCheck& operator[](AuditLimit limit) const { return limits[static_cast<size_t>(limit)]; }
  friend bool operator==(const AuditReport&, const AuditReport&) = default;
};

struct AuditSummary {
  int64_t rows = 0;
  int64_t admissible = 0;
  Tally invalid;  // Rows that break a rule or overflow; no other member counts them.
  Tally unexplained;
  std::array<Tally, kAuditLimitCount> broken = {};              // Indexed by the number of the limit.
  std::array<Tally, kAuditLimitCount> within_uncertainty = {};  // Limits exceeded by no more than the uncertainty.
  std::array<double, kAuditLimitCount> largest_excess = {};  // Largest excess of a broken limit; 0 if none is broken.
  friend bool operator==(const AuditSummary&, const AuditSummary&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_AUDIT_H_
