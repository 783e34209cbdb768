// One integration of core/models/finite_duration/finite_duration.h, mode by mode, with what it meets on its way. Natural units.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_

#include <cstdint>
#include <vector>

#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/motion.h"
#include "ricochet/outcome.h"

namespace ricochet::finite_duration {

struct Instant {
  EventKind kind = EventKind::kUnspecified;
  Motion y = {};
};

struct Works {
  double normal = 0.0, tangential = 0.0;
};

// Where slip stopped for the first time, or the particle stuck.
enum class Stop { kNever, kInCompression, kInRestitution };

struct Path {
  Motion end = {};
  Motion compression = {};  // At the last end of compression.
  Works compression_works;
  std::vector<Instant> events;
  Stop stop = Stop::kNever;
  bool first_stop_sticks = false;
  bool ever_sticks = false;
  bool held = false;    // Ended at rest, where friction and the spring keep it.
  bool parted = false;  // Or ended where compression does, because eta = 0 or it is held.
  double peak_normal = 0.0, peak_tangential = 0.0, indentation = 0.0;
  double largest_place = 0.0;
  double fastest = 0.0;       // Of restitution, along n.
  double spring_force = 0.0;  // Of the tangential spring at the end.
  Motion local_errors = {};
  int64_t steps = 0, right_hand_sides = 0;
};

// Forces at equal steps of time, in natural units.
struct History {
  int64_t intervals = 0;
  double duration = 0.0;
  std::vector<ForceSample> samples;
};

// Errors of each step within `tolerance`. `history` may be null.
Path Follow(const Contact& contact, Integrator& integrator, double tolerance, History* history);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_PATH_H_
