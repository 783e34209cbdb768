// Fit: the numbers of a scene that measured impacts tell, how well they tell them, and whether the physics can be true.
//
// Each row of the data is one impact of the scene. Inputs are numbers of the scene that differ by row; measured numbers
// are numbers of its outcome, each with the standard deviation sigma of its error. A fit minimizes the sum of the
// squared residuals (measured - predicted)/sigma, or of a robust loss of them, over the unknowns within their bounds.
// If inputs have errors, too, it also minimizes over what these inputs truly were (docs/fit.md).
// The structs mirror ricochet.v1.FitRequest and FitResponse; docs/fit.md explains the answer. Units are those of the
// numbers; residuals, chi2 and shares have none.

#ifndef RICOCHET_FIT_H_
#define RICOCHET_FIT_H_

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/audit.h"
#include "ricochet/engine_info.h"
#include "ricochet/regime.h"
#include "ricochet/scene.h"

namespace ricochet {

// An interval covers 95 %: with squares, it ends where the objective rises by this, the quantile of chi-squared for one
// degree of freedom.
inline constexpr double kFitRiseOfInterval = 3.841458820694124;
// The data refuse the physics if a true model would give so large a chi2 with less than this probability.
inline constexpr double kFitRefusedBelow = 1e-3;

// A number of the scene that the fit finds.
struct FitUnknown {
  std::string path = {};             // Spelled as for an axis of a sweep: "friction.kinetic_coefficient".
  std::optional<double> start = {};  // Where the search starts, in [low, high]; absent: the scene's own number.
  std::optional<double> low = {};    // Bounds; absent: those that the number has by its rule, such as 0 for friction.
  std::optional<double> high = {};
  friend bool operator==(const FitUnknown&, const FitUnknown&) = default;
};

// A number of the scene that differs by row.
struct FitInput {
  std::string path = {};            // Spelled as for an axis of a sweep; not that of an unknown.
  std::vector<double> values = {};  // Finite; one for each row, or one for all.
  std::vector<double> sigma = {};   // >= 0; one for each row, or one for all. Empty: the values are exact.
  friend bool operator==(const FitInput&, const FitInput&) = default;
};

// A number of the outcome that was measured.
struct FitMeasured {
  std::string path = {};            // Spelled as a column of a sweep: "contact_velocity_after.normal_m_s".
  std::vector<double> values = {};  // One for each row; NaN where it was not measured.
  std::vector<double> sigma = {};   // > 0; one for each row, or one for all.
  friend bool operator==(const FitMeasured&, const FitMeasured&) = default;
};

// A FitLoss says what a residual r costs, with the scale c in sigmas. The numbers are those of ricochet.v1.FitLoss.
enum class FitLoss {
  kUnspecified = 0,  // It means kSquares.
  kSquares = 1,      // r^2
  kHuber = 2,        // r^2 up to c, 2 c |r| - c^2 beyond.
  kCauchy = 3,       // c^2 ln(1 + r^2/c^2)
};
inline constexpr int kFitLossCount = 4;

// Defaults and ranges of a request.
inline constexpr int32_t kFitStarts = 1, kMostFitStarts = 1000;
inline constexpr int32_t kFitIterations = 100, kMostFitIterations = 10'000;
// The scales at which a robust loss has 95 % of the efficiency of squares if all errors are normal.
inline constexpr double kHuberScale = 1.345, kCauchyScale = 2.385;
inline constexpr double kLeastFitLossScale = 1e-6, kMostFitLossScale = 1e9;

struct FitRequest {
  Scene scene = {};                       // Gives every number that is neither unknown nor an input.
  std::vector<FitUnknown> unknowns = {};  // At least one.
  std::vector<FitInput> inputs = {};
  std::vector<FitMeasured> measured = {};  // At least one, with as many measured numbers as there are unknowns or more.
  FitLoss loss = FitLoss::kUnspecified;
  std::optional<double> loss_scale = {};  // Only a robust loss has it; absent: kHuberScale or kCauchyScale.
  std::optional<int32_t> starts = {};     // In [1, kMostFitStarts]; absent: 1. Further ones spread over the bounds.
  std::optional<int32_t> max_iterations = {};  // Most of a search, in [1, kMostFitIterations]; absent: kFitIterations.
  std::vector<std::string> region = {};        // Empty, or the paths of the two unknowns whose 95 % region is wanted.
  friend bool operator==(const FitRequest&, const FitRequest&) = default;
};

// The solves of each row in an iteration of a search: one for the row and for each unknown, and about four for each
// input that has errors.
inline int64_t FitSolvesOfARow(const FitRequest& request) {
  const auto has_errors = [](const FitInput& input) { return !input.sigma.empty(); };
  return 1 + static_cast<int64_t>(request.unknowns.size()) +
         4 * std::count_if(request.inputs.begin(), request.inputs.end(), has_errors);
}

// Says how an interval ends. The numbers are those of ricochet.v1.FitEnd.Kind.
enum class FitEndKind {
  kUnspecified = 0,
  kFound = 1,       // The data end it here.
  kCutByBound = 2,  // The bound, or a rule of the scene, ends it before the data do.
  kUnbounded = 3,   // The data do not end it, however far the search went.
  kNotSeen = 4,     // The data do not end it, and do not tell the unknown by itself.
};

struct FitEnd {
  FitEndKind kind = FitEndKind::kUnspecified;
  std::optional<double> value;  // Set for kFound and kCutByBound.
  friend bool operator==(const FitEnd&, const FitEnd&) = default;
};

// The least objective with the unknown held at a value, less that of the best fit.
struct FitProfilePoint {
  double value = 0.0;
  double rise = 0.0;
  friend bool operator==(const FitProfilePoint&, const FitProfilePoint&) = default;
};

struct FitEstimate {
  std::string path;
  double value = 0.0;                    // The best fit has it; where the unknown is not seen, many others fit as well.
  bool seen = false;                     // The data tell it by itself: by its derivatives, or by both ends.
  std::optional<double> sigma;           // Standard deviation by the derivatives at the best fit, if they tell it.
  FitEnd low, high;                      // The 95 % interval by profile likelihood.
  std::vector<FitProfilePoint> profile;  // The profile as far as the search computed it, by rising value.
  std::vector<double> row_shares;  // The share of each row in what the data tell about it; empty if they tell nothing.
  friend bool operator==(const FitEstimate&, const FitEstimate&) = default;
};

struct FitRow {
  Regime regime = Regime::kUnspecified;  // At the best fit.
  std::vector<double> predicted;         // One for each measured column, for the inputs as they are stated.
  // (measured - predicted)/sigma, where sigma contains what the errors of inputs do; NaN where nothing was measured.
  std::vector<double> residuals;
  std::vector<AuditLimit> broken_limits;  // The measured velocity breaks these by more than its errors explain.
  friend bool operator==(const FitRow&, const FitRow&) = default;
};

// A residual that normal errors would give to any of the measured numbers with a probability of less than 5 %.
struct FitOutlier {
  int64_t row = 0;
  std::string path;  // The measured column.
  double residual = 0.0;
  friend bool operator==(const FitOutlier&, const FitOutlier&) = default;
};

// A search.
struct FitStart {
  std::vector<double> from, to;  // The unknowns where it started and ended.
  double objective = 0.0;        // The sum of losses at its end; chi2 for squares. Infinite if it had no outcome.
  int32_t iterations = 0;
  bool converged = false;
  friend bool operator==(const FitStart&, const FitStart&) = default;
};

// A number whose derivatives by an unknown differ below and above the best fit.
struct FitThreshold {
  int64_t row = 0;
  std::string of, by;
  double from_below = 0.0, from_above = 0.0;
  friend bool operator==(const FitThreshold&, const FitThreshold&) = default;
};

// An end of the region of two unknowns, on a ray from the best fit.
struct FitRegionPoint {
  double x = 0.0, y = 0.0;
  FitEndKind kind = FitEndKind::kUnspecified;  // kFound or kCutByBound; other rays are left out.
  friend bool operator==(const FitRegionPoint&, const FitRegionPoint&) = default;
};

struct FitResponse {
  std::vector<FitEstimate> unknowns;  // In the order of the request.
  // Row by row, a row and a column for each unknown; NaN for one that is not seen.
  std::vector<double> covariance, correlation;
  std::vector<FitRow> rows;
  std::vector<FitOutlier> outliers;  // The largest residual first.
  double objective = 0.0;            // The best fit has it; FitStart explains it.
  // The rise of the objective at which the intervals end: kFitRiseOfInterval, times E[psi^2]/E[psi'] for a robust loss
  // with half the derivative psi.
  double interval_rise = kFitRiseOfInterval;
  // Sum of the squared residuals, whatever the loss. Those of a row whose inputs have errors count by their covariance.
  double chi2 = 0.0;
  // Measured numbers less combinations of unknowns that are seen; one that would fit better beyond its bound counts as
  // given.
  int64_t degrees_of_freedom = 0;
  std::optional<double> p_value;         // The probability of so large a chi2; set if there is a degree of freedom.
  bool refused = false;                  // p_value < kFitRefusedBelow, or a row breaks a limit.
  std::vector<FitStart> starts;          // Those asked for, the given one first; then those that found a better fit.
  bool starts_differ = false;            // Two of them ended in different places.
  std::vector<FitThreshold> thresholds;  // The best fit lies on these.
  std::vector<FitRegionPoint> region;    // Around the best fit; empty unless it was asked for.
  // True if the search used exact derivatives; else it used central differences, for this reason.
  bool exact_derivatives = false;
  std::string why_differences;
  std::vector<std::string> notes;  // Sentences that a reader must know.
  EngineInfo engine;
  friend bool operator==(const FitResponse&, const FitResponse&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_FIT_H_
