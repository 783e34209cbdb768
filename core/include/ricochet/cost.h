// Cost: what accuracy costs in time, for one scene on the machine that answers.
//
// The same impact is computed by every method that applies: every model, also those that leave out an effect of the
// scene, in every arithmetic and at every tolerance that makes a difference. Each method is timed and its error is
// found against a reference that is certified, or far more exact than the method. These structs mirror
// ricochet.v1.CostRequest and CostResponse field by field; docs/accuracy.md says how each number is found.
//
// Several contacts at once have the methods of ricochet/multi_contact.h. Rigid bodies alone do not decide between their
// outcomes, so that there is no exact answer: a row states what its method claims.
//
// Errors are those of the contact velocity after the impact, divided by V = max(|u0|, |v0|), as in
// Accuracy::relative_error. Times are in seconds, of one thread with warm caches. Times differ from run to run, and
// what follows from them; everything else has the same bits in every run that its time limit does not cut short.

#ifndef RICOCHET_COST_H_
#define RICOCHET_COST_H_

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/engine_info.h"
#include "ricochet/multi_contact.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

// The range and the default of CostRequest::time_limit_s.
inline constexpr double kLeastCostTimeLimitS = 0.01;
inline constexpr double kMostCostTimeLimitS = 60.0;
inline constexpr double kDefaultCostTimeLimitS = 3.0;
// The range and the default of CostRequest::samples.
inline constexpr int32_t kMostCostSamples = 1001;
inline constexpr int32_t kDefaultCostSamples = 21;

// The impacts that a batch solves, one of them for each factor by which the velocity before the impact is varied.
inline constexpr int64_t kCostBatch = 1000;

struct CostRequest {
  Scene scene = {};
  // Time for the whole study, s, in [kLeastCostTimeLimitS, kMostCostTimeLimitS]; absent means kDefaultCostTimeLimitS.
  // Methods that it leaves no time for are answered as CostStatus::kOutOfTime.
  std::optional<double> time_limit_s = {};
  // Samples taken of each time, in [1, kMostCostSamples]; absent means kDefaultCostSamples. A slow method gets fewer,
  // so that every method has its share of the time.
  std::optional<int32_t> samples = {};
  // Several contacts at once, in place of `scene`, which then states nothing.
  std::optional<MultiContactScene> multi_contact = {};
  friend bool operator==(const CostRequest&, const CostRequest&) = default;
};

// One way to compute the impact. Several contacts have no model and no arithmetic.
struct CostMethod {
  Model model = Model::kUnspecified;  // Certified arithmetic computes the model that is exact for a rigid contact.
  Arithmetic arithmetic = Arithmetic::kUnspecified;
  std::optional<double> tolerance;  // Error that the model was asked for, over V; absent if the model takes none.
  int32_t digits = 0;               // Significant digits of certified arithmetic; 0 in the others.
  // Stiffness of the normal spring in the units of its law (N/m for a linear spring); 0 if the impact takes no time. A
  // scene without a normal spring is given a linear one.
  double stiffness = 0.0;
  MultiContactMethod multi_contact = MultiContactMethod::kUnspecified;  // Set for several contacts alone.
  friend bool operator==(const CostMethod&, const CostMethod&) = default;
};

// Says how the study of a method ended. The numbers are those of ricochet.v1.CostRow.Status.
enum class CostStatus {
  kUnspecified = 0,
  kMeasured = 1,     // Time and error are known.
  kFailed = 2,       // The method gave no answer for this scene: it refused, or used up its budget of steps.
  kOutOfTime = 3,    // The time limit was used up before the method had an answer.
  kUnavailable = 4,  // The component of the method is not in this build.
};

// The time of one impact, s.
struct CostTime {
  double median_s = 0.0;
  double lower_quartile_s = 0.0;
  double upper_quartile_s = 0.0;
  int32_t samples = 0;     // Samples taken.
  int64_t per_sample = 0;  // Impacts that were computed in each sample, whose time is divided by this number.
  friend bool operator==(const CostTime&, const CostTime&) = default;
};

// An error over V, as a whole and by its cause. `total` is at most the sum of the other two.
struct CostError {
  double total = 0.0;
  double numerical = 0.0;  // By rounding and by steps: the distance from the exact answer of the method's own model.
  // The effects that the model leaves out cause it: the distance between exact answers. At several contacts it is the
  // widest range of a contact velocity within which `possible` proves all outcomes; orders and springs prove none.
  double modelling = 0.0;
  friend bool operator==(const CostError&, const CostError&) = default;
};

// A method and what it costs.
struct CostRow {
  std::string name;  // At most 32 characters, such as "space 1e-06"; no two rows have the same.
  CostMethod method;
  CostStatus status = CostStatus::kUnspecified;
  // Sentences: why a method has no answer, no error or no time of a batch, or what is special about it. Empty if there
  // is nothing to say.
  std::string note;
  // One call of the model for the scene's contact; planning is not included. A method that failed has the time until it
  // gave up.
  std::optional<CostTime> solve;
  // One impact among kCostBatch whose velocity before varies by 0.1 %: a pendulum's closed form computes them in SIMD
  // lanes, every other method one after another. Absent if they would take more than 2 % of the time limit.
  std::optional<CostTime> batch;
  bool batch_in_lanes = false;                    // True if the batch was computed in SIMD lanes.
  CostError claimed;                              // Bounds or estimates; infinite where no bound is known.
  std::optional<CostError> achieved;              // Absent if there is no answer, or nothing to compare it with.
  double reference_error = 0.0;                   // Errors achieved are known to within this number.
  std::optional<ContactVelocity> velocity_after;  // The method's answer; absent without one, and at several contacts.
  int64_t steps = 0;                              // 0 for a closed form.
  int64_t right_hand_sides = 0;                   // 0 for a closed form.
  friend bool operator==(const CostRow&, const CostRow&) = default;

  // The error by which rows are compared: the one achieved, which must be present, or what the reference leaves open if
  // that is more.
  double ComparedError() const { return std::max(achieved->total, reference_error); }

  // The error achieved is larger than the one claimed, by more than the reference leaves open.
  bool ClaimIsBroken() const { return achieved.has_value() && achieved->total - reference_error > claimed.total; }
};

// The tolerances from which CostPick takes the ends of its ranges.
inline constexpr double kCostTolerances[] = {0.0,  1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9,
                                             1e-8, 1e-7,  1e-6,  1e-5,  1e-4,  1e-3,  1e-2,  1e-1};

// A range of tolerances for which the plan picks one method. Ranges are in order and together hold all of
// kCostTolerances. Several contacts have none, because no tolerance is asked for.
struct CostPick {
  int64_t row = -1;  // Index of the method's row; -1 if no row has the method.
  double least_tolerance = 0.0;
  double most_tolerance = 0.0;
  Model model = Model::kUnspecified;
  friend bool operator==(const CostPick&, const CostPick&) = default;
};

// The machine and the build that were timed.
struct CostMachine {
  std::string cpu;          // Name that the processor gives itself; "unknown" if it gives none.
  std::string compiler;     // Name and version of the compiler.
  std::string simd_target;  // SIMD instructions that the kernels use here: "AVX3_ZEN4".
  bool optimized = false;   // False if the build does not optimize, so that its times say little.
  friend bool operator==(const CostMachine&, const CostMachine&) = default;
};

// The parts of a study that need all rows.
struct CostSummary {
  // The exact answer for the scene with all its effects, rounded, and one sentence that says where it comes from.
  // Absent if none is known.
  std::optional<ContactVelocity> reference;
  std::string reference_source;
  std::optional<double> reference_error;  // Over V.
  // Indices of the rows on the Pareto front, from fast to exact: no other method is as fast and as exact, by median
  // time of one solve and total error achieved.
  std::vector<int64_t> front;
  std::vector<CostPick> picks;
  int64_t deceived = 0;  // Rows whose error achieved exceeds the one claimed.
  int64_t out_of_time = 0;
  int64_t failed = 0;
  CostMachine machine;
  double elapsed_s = 0.0;  // Time that the study took.
  friend bool operator==(const CostSummary&, const CostSummary&) = default;
};

// A part of a study: the rows measured since the part before. The first part comes before any row.
struct CostChunk {
  int64_t first_row = 0;  // Index of the first of these rows among all.
  std::vector<CostRow> rows;
  int64_t rows_done = 0;               // Rows so far, including these.
  int64_t rows_total = 0;              // Rows of the whole study.
  std::optional<CostSummary> summary;  // Present in the last part only.
  EngineInfo engine;
  friend bool operator==(const CostChunk&, const CostChunk&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_COST_H_
