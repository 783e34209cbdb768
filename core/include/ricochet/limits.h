// Limits: how large a request may be, so that its cost is bounded before any work is done.
//
// A LocalSolver with limits looks at the sizes of a request before anything else. A request above a limit fails with
// RESOURCE_EXHAUSTED and ErrorReason::kLimitExceeded (ErrorReason::kSweepTooLarge for the points of a sweep), naming
// every field that is too large, its size and the limit. The defaults are those of ricochetd: with them no answer takes
// more than 4 MiB but that of a batch, which takes 20 MiB at most, and no call more than 64 MiB of memory.

#ifndef RICOCHET_LIMITS_H_
#define RICOCHET_LIMITS_H_

#include <cstdint>
#include <limits>

namespace ricochet {

struct Limits {
  // Links of a linkage, coordinates of a mechanism, rates after an impact that an audit states, and bodies that touch
  // at several contacts. Time grows with the cube of the links and coordinates.
  int64_t max_links = 64;
  // Numbers in one list of a scene, such as a table of coefficients by speed.
  int64_t max_list_numbers = 1024;
  // Uncertain fields of one request for bounds. A box is cut along each of them in turn.
  int64_t max_ranges = 32;
  // Boxes that one enclosure evaluates. An enclosure that has used them up still holds every value that is possible,
  // but is wider than its tolerance: Enclosure::excess says by how much.
  int64_t max_boxes = 200'000;
  // Axes of a sweep.
  int64_t max_axes = 32;
  // Values of an axis that lists them.
  int64_t max_axis_values = 65'536;
  // Columns of a sweep, fields or columns of a batch, outputs of a request about several contacts, and unknowns, inputs
  // or measured columns of a fit.
  int64_t max_columns = 256;
  // Points of a sweep.
  int64_t max_points_per_sweep = 10'000'000'000;
  // Significant digits of a certificate times the links of the system, which counts as one link if it has none.
  int64_t max_digits_times_links = 25'600;
  // States in the history of an impact times the numbers of one state, which has four and one for each link.
  int64_t max_history_numbers = 327'680;
  // Steps of the history of forces of an impact that takes time.
  int64_t max_force_intervals = 65'535;
  // Rows of a batch of audits.
  int64_t max_audit_rows = 8192;
  // Rows of a batch times its columns: those of the request or those of the answer, whichever are more.
  int64_t max_batch_numbers = 2'097'152;
  // Bytes of the message of a batch. Of the messages of other requests 1 MiB is the most. A LocalSolver has no
  // messages.
  int64_t max_request_bytes = int64_t{16} << 20;
  // States of a request about several contacts times the cube of the contacts. A range of stiffnesses counts as 16
  // times as many states.
  int64_t max_contact_states = 4096;
  // Numbers of the outcome times numbers of the scene in a request for derivatives.
  int64_t max_derivatives = 4096;

  // Measured numbers of a fit x (unknowns + 1) x starts x iterations, of which 16 count at least.
  int64_t max_fit_work = 10'000'000;

  // Limits that no request exceeds.
  static constexpr Limits None();

  friend bool operator==(const Limits&, const Limits&) = default;
};

// A limit by name, as an option of ricochetd (--max-links) and the proto (max_links) spell it.
struct NamedLimit {
  const char* name;
  int64_t Limits::*value;
  int64_t most;      // The limit may be from 1 to this number. No request can make use of more.
  const char* help;  // One line that says what is limited.
};

// Every limit, in the order of the struct.
inline constexpr NamedLimit kLimits[] = {
    {"max_links", &Limits::max_links, 1'000'000, "Links of a linkage, or coordinates of a mechanism"},
    {"max_list_numbers", &Limits::max_list_numbers, 1'000'000, "Numbers in one list of a scene"},
    {"max_ranges", &Limits::max_ranges, 1'000'000, "Uncertain fields of one request for bounds"},
    {"max_boxes", &Limits::max_boxes, 200'000, "Boxes that one enclosure evaluates; fewer leave it wider"},
    {"max_axes", &Limits::max_axes, 1'000'000, "Axes of a sweep"},
    {"max_axis_values", &Limits::max_axis_values, 1'000'000, "Values of an axis that lists them"},
    {"max_columns", &Limits::max_columns, 1'000'000, "Columns of a sweep or a batch"},
    {"max_points_per_sweep", &Limits::max_points_per_sweep, int64_t{1} << 53, "Points of a sweep"},
    {"max_digits_times_links", &Limits::max_digits_times_links, 1'000'000'000,
     "Certified digits times links of the system"},
    {"max_history_numbers", &Limits::max_history_numbers, 1'000'000'000,
     "States of a history times numbers of a state (4 + links)"},
    {"max_force_intervals", &Limits::max_force_intervals, 65'535, "Steps of a history of forces"},
    {"max_audit_rows", &Limits::max_audit_rows, 8192, "Rows of a batch of audits"},
    {"max_batch_numbers", &Limits::max_batch_numbers, 100'000'000, "Rows of a batch times its columns, in or out"},
    {"max_request_bytes", &Limits::max_request_bytes, int64_t{256} << 20, "Bytes of the message of a batch"},
    {"max_contact_states", &Limits::max_contact_states, 1'000'000'000,
     "States of several contacts times the cube of the contacts"},
    {"max_derivatives", &Limits::max_derivatives, 1'000'000, "Derivatives of one impact"},
    {"max_fit_work", &Limits::max_fit_work, 1'000'000'000'000,
     "Measured numbers of a fit times unknowns and one, starts and iterations"},
};

constexpr Limits Limits::None() {
  Limits limits;
  for (const NamedLimit& limit : kLimits) limits.*limit.value = std::numeric_limits<int64_t>::max();
  return limits;
}

}  // namespace ricochet

#endif  // RICOCHET_LIMITS_H_
