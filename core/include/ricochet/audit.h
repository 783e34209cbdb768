// Audit: what an observed impact implies, and which limits of an admissible impact it breaks.
//
// Mirrors ricochet.v1.AuditReport and AuditSummary. core/study/audit.h says how each number is found and how exact it
// is. N s, J and m/s; coefficients are pure numbers.

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

// What was seen after the impact: the velocity of the contact relative to the surface, or the rates of a pendulum (one)
// or a linkage (one a link). std::monostate: the request left the choice open, which is a violation.
struct ObservedRates {
  std::vector<double> rates_rad_s;
  friend bool operator==(const ObservedRates&, const ObservedRates&) = default;
};
using Observed = std::variant<std::monostate, ContactVelocity, ObservedRates>;

// At most this many rows a call.
inline constexpr int64_t kMostAuditRows = 8192;

// Many impacts of one scene, by columns: a value a row, or one for all rows; the longest has the number of rows.
// Columns of the second tangential direction are for systems in space and only for them. Velocities are those of the
// contact relative to the surface; a pendulum or a linkage may have its rates after the impact in place of them.
struct AuditColumns {
  std::vector<double> tangential_m_s;  // Before. Empty: the scene's own, all three.
  std::vector<double> tangential_2_m_s;
  std::vector<double> normal_m_s;
  std::vector<double> tangential_after_m_s;
  std::vector<double> tangential_2_after_m_s;
  std::vector<double> normal_after_m_s;
  std::vector<double> friction;  // Kinetic and static. Empty: the scene's, at each row's approach speed.
  std::vector<double> velocity_uncertainty_m_s;        // Empty: 0.
  std::vector<std::vector<double>> rates_after_rad_s;  // A column a link; of a pendulum, one.
  friend bool operator==(const AuditColumns&, const AuditColumns&) = default;
};

// The first two have the numbers of ricochet::LimitKind.
enum class AuditLimit { kUnspecified = 0, kSharp = 1, kEnergy = 2, kNormalImpulse = 3, kPenetration = 4, kCone = 5 };
inline constexpr int kAuditLimitCount = 6;

enum class Verdict {
  kUnspecified = 0,
  kKept = 1,
  kWithinUncertainty = 2,  // Exceeded, but something within the uncertainty keeps it.
  kBroken = 3,
};

struct LimitCheck {
  double value = 0.0;      // p_n, v+_n, |p_t|, E+ - E-, energetic coefficient
  double limit = 0.0;      // 0, 0, mu p_n, 0, 1
  double excess = 0.0;     // By how much the value is on the wrong side; negative where kept. Free of cancellation.
  double allowance = 0.0;  // What the uncertainty can make of it.
  Verdict verdict = Verdict::kUnspecified;
  friend bool operator==(const LimitCheck&, const LimitCheck&) = default;
};

// A plane uses the first tangential direction only; the other is 0.
struct AuditReport {
  Regime regime = Regime::kUnspecified;  // What the path has done up to the normal impulse.
  int w_rank = 0;
  bool admissible = false;  // Explained, and no limit broken.
  bool unexplained = false;
  double distance = 0.0;           // From v+ to the nearest point of the path; 0 where explained.
  bool compression_ended = false;  // False: p_n < tau_c. Then Poisson's coefficient is negative, the energetic one 0.
  double newton = 0.0;
  double poisson = 0.0;
  double energetic = 0.0;
  double tangential = 0.0;  // p_t/p_n; in space |p_t|/p_n. 0 without a normal impulse.
  double normal_impulse = 0.0;
  double normal_impulse_compression = 0.0;  // tau_c of the path
  std::array<double, 2> tangential_impulse = {};
  std::array<double, 2> friction_mismatch = {};  // N s
  double normal_impulse_uncertainty = 0.0;       // N s, as are the next
  std::array<double, 2> tangential_impulse_uncertainty = {};
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;
  double residual = 0.0;
  std::array<double, 2> path_tangential_velocity = {};  // Where the path is at that normal impulse.
  double path_normal_velocity = 0.0;
  std::array<LimitCheck, kAuditLimitCount> limits = {};  // By the number of the limit; [0] is not used.

  const LimitCheck& operator[](AuditLimit limit) const { return limits[static_cast<size_t>(limit)]; }
  friend bool operator==(const AuditReport&, const AuditReport&) = default;
};

struct AuditSummary {
  int64_t rows = 0;
  int64_t admissible = 0;
  Tally invalid;  // Rows that break a rule or overflow; all else is not counted for them.
  Tally unexplained;
  std::array<Tally, kAuditLimitCount> broken = {};              // By the number of the limit.
  std::array<Tally, kAuditLimitCount> within_uncertainty = {};  // Exceeded, but not broken.
  std::array<double, kAuditLimitCount> largest_excess = {};     // Of the broken ones; 0 where none is.
  friend bool operator==(const AuditSummary&, const AuditSummary&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_AUDIT_H_
