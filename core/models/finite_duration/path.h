// FollowPath: one integration of an impact of finite duration, mode by mode, with its events, peaks and works.
//
// All numbers are in natural units (core/models/finite_duration/scaled_contact.h).

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_

#include <cstdint>
#include <vector>

#include "core/models/finite_duration/history.h"
#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/motion.h"
#include "core/models/finite_duration/stop_check.h"
#include "ricochet/outcome.h"

namespace ricochet::finite_duration {

struct Instant {
  EventKind kind = EventKind::kUnspecified;
  Motion y = {};
};

struct Works {
  double normal = 0.0, tangential = 0.0;
};

// The phase in which slip stops, or the particle sticks, for the first time.
enum class FirstStop { kNever, kInCompression, kInRestitution };

enum class PathEnd {
  kUnderway,
  kParted,  // N = 0, or eta = 0 and v = 0.
  kHeld,    // Friction and the spring hold the contact at rest where compression ends.
  kBudgetUsedUp,
  kNeverEnds,  // It goes on for ever, or it is lost in rounding or beyond the largest double.
  kStopped     // The caller stopped the computation.
};

// The largest values on the path.
struct Peaks {
  double normal = 0.0, tangential = 0.0;  // Sizes of the forces.
  double indentation = 0.0;
  double place = 0.0;  // kPlace
  double restitution_speed = 0.0;
  double slip = 0.0;  // |u|

  void Add(const ScaledContact& contact, const Mode& mode, const Motion& y);
};

struct Path {
  PathEnd how = PathEnd::kUnderway;
  Motion end = {};
  Motion compression = {};  // The state at the last end of compression.
  std::vector<Instant> events;
  FirstStop first_stop = FirstStop::kNever;
  bool first_stop_sticks = false;
  bool ever_sticks = false;
  Peaks peaks;
  double spring_force = 0.0;  // F of the tangential spring at the end.
  Motion local_errors = {};   // The sum of the sizes of the local errors, with what was cut off.
  Motion cut_off = {};        // The sum of the sizes of what was set to 0 at events.
  // The works on first loading and all others; of the last mode, the slopes of the velocities over the normal
  // impulse and the length in it. They follow from u, v and tau at the changes of mode, if these are linear in between.
  Works straight_loading, straight_other;
  double straight_length = 0.0;
  Acceleration straight_slopes;
  int64_t steps = 0, right_hand_sides = 0;

  bool HasEnd() const { return how == PathEnd::kParted || how == PathEnd::kHeld; }
};

// The local errors of each step are within `tolerance`, as a root mean square over the parts of the motion. `history`
// may be null.
Path FollowPath(const ScaledContact& contact, Integrator& integrator, double tolerance, StopCheck& stop,
                HistoryRecorder* history);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_
