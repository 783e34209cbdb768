#include "core/fit/problem.h"

#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "core/answer/derivative_paths.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/base/nearest.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "ricochet/error.h"

namespace ricochet::fit {
namespace {

// Weights are squares of sigma.
constexpr double kLeastSigma = 1e-150, kMostSigma = 1e150;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The range in which a number keeps its rule, with an infinite end where only the largest double bounds it.
std::pair<double, double> BoundsBy(NumberRule rule) {
  const auto [least, most, is_open, words] = RangeOf(rule);
  return {least == -kLargestNumber ? -kInfinity : least, most == kLargestNumber ? kInfinity : most};
}

class Door {
 public:
  explicit Door(const FitRequest& request) : request_(request) {}

  absl::StatusOr<Problem> Pass() {
    SetRows();
    SetBatch();
    const bool has_fields = violations_.empty();
    for (size_t k = 0; k < request_.unknowns.size() && has_fields; ++k) SetUnknown(k);
    for (size_t i = 0; i < request_.inputs.size(); ++i) SetInput(i);
    SetNumbers();
    SetSearch();
    SetRegion();
    if (!violations_.empty()) return InvalidRequest(violations_);
    SetFields();
    return std::move(problem_);
  }

 private:
  void Refuse(std::string field, const std::string& found, std::string rule) {
    if (!IsFull(violations_)) violations_.push_back(MakeViolation(std::move(field), found, std::move(rule)));
  }
  void RefuseNumber(std::string field, double value, std::string rule) {
    Refuse(std::move(field), absl::StrCat("= ", ShortestDecimal(value)), std::move(rule));
  }

  void SetRows() {
    if (request_.unknowns.empty()) Refuse("unknowns", "is empty", "name at least one number of the scene");
    if (request_.measured.empty()) Refuse("measured", "is empty", "name at least one number of the outcome");
    for (const FitMeasured& measured : request_.measured)
      problem_.rows = std::max(problem_.rows, measured.values.size());
  }

  // Checks scene and paths as for a batch, whose fields and columns have other names here.
  void SetBatch() {
    if (request_.unknowns.empty() || request_.measured.empty()) return;
    BatchSetup setup = {.scene = request_.scene};
    for (const FitUnknown& unknown : request_.unknowns) setup.fields.push_back(unknown.path);
    for (const FitInput& input : request_.inputs) setup.fields.push_back(input.path);
    for (const FitMeasured& measured : request_.measured) setup.columns.push_back(measured.path);
    std::vector<std::pair<std::string, std::string>> names;
    for (size_t i = 0; i < setup.fields.size(); ++i) {
      const size_t unknowns = request_.unknowns.size();
      names.emplace_back(absl::StrCat("fields[", i, "]"), i < unknowns
                                                              ? absl::StrCat("unknowns[", i, "].path")
                                                              : absl::StrCat("inputs[", i - unknowns, "].path"));
    }
    for (size_t j = 0; j < setup.columns.size(); ++j) {
      names.emplace_back(absl::StrCat("columns[", j, "]"), absl::StrCat("measured[", j, "].path"));
    }
    absl::StatusOr<CheckedBatch> batch = CheckBatch(setup);
    if (batch.ok()) {
      problem_.batch = *std::move(batch);
      return;
    }
    for (Violation violation : ViolationsOf(batch.status())) {
      absl::StrReplaceAll(names, &violation.field);
      absl::StrReplaceAll(names, &violation.description);
      violations_.push_back(std::move(violation));
    }
  }

  void SetUnknown(size_t k) {
    const FitUnknown& unknown = request_.unknowns[k];
    const std::string name = absl::StrCat("unknowns[", k, "]");
    Scene scene = request_.scene;
    const std::optional<double> own = NumberAt(scene, unknown.path);
    const NumberRule rule = ResolveField(unknown.path, scene)->rule();
    const auto [least, most] = BoundsBy(rule);
    const std::string range = absl::StrCat("be in [", ShortestDecimal(least), ", ", ShortestDecimal(most), "]");
    for (const auto& [bound, value] : {std::pair(".low", unknown.low), std::pair(".high", unknown.high)}) {
      if (value.has_value() && !(*value >= least && *value <= most)) RefuseNumber(name + bound, *value, range);
    }
    const double low = unknown.low.value_or(least);
    const double high = unknown.high.value_or(most);
    if (!(low < high)) {
      RefuseNumber(name + ".low", low, absl::StrCat("be below the upper bound ", ShortestDecimal(high)));
    }
    const std::optional<double> start = unknown.start.has_value() ? unknown.start : own;
    if (!start.has_value()) {
      Refuse(name + ".start", "is unset", absl::StrCat("be set: the scene states no ", unknown.path));
    } else if (!(*start >= low && *start <= high) || !std::isfinite(*start)) {
      RefuseNumber(name + ".start", *start,
                   absl::StrCat("be in [", ShortestDecimal(low), ", ", ShortestDecimal(high), "], the bounds"));
    }
    const double at = start.value_or(0.0);
    const double width = std::isfinite(high - low) ? high - low : 1.0;
    problem_.start.push_back(at);
    problem_.is_angle.push_back(rule == NumberRule::kAngle);
    problem_.low.push_back(low);
    problem_.high.push_back(high);
    problem_.scale.push_back(at != 0.0 ? std::fabs(at) : width);
  }

  // True if a list has an entry for each row; `may_be_one` allows it one for all.
  bool HasRows(const std::string& field, size_t size, bool may_be_one) {
    if (size == problem_.rows || (may_be_one && size == 1)) return true;
    Refuse(field, absl::StrCat("has ", Counted(size, "number")),
           absl::StrCat("have ", problem_.rows, ", one for each row", may_be_one ? ", or one for all" : ""));
    return false;
  }

  void SetInput(size_t i) {
    SetInputSigmas(i);
    const std::vector<double>& values = request_.inputs[i].values;
    const std::string field = absl::StrCat("inputs[", i, "].values");
    if (!HasRows(field, values.size(), true)) return;
    std::vector<double>& column = problem_.inputs.emplace_back(problem_.rows);
    for (size_t row = 0; row < problem_.rows; ++row) {
      column[row] = values.size() == 1 ? values[0] : values[row];
      if (!std::isfinite(column[row])) RefuseNumber(absl::StrCat(field, "[", row, "]"), column[row], "be finite");
    }
  }

  void SetInputSigmas(size_t i) {
    std::vector<double>& column = problem_.input_sigmas.emplace_back();
    const std::vector<double>& sigmas = request_.inputs[i].sigma;
    const std::string field = absl::StrCat("inputs[", i, "].sigma");
    if (sigmas.empty() || !HasRows(field, sigmas.size(), true)) return;
    for (size_t row = 0; row < sigmas.size(); ++row) {
      const bool is_right = sigmas[row] == 0.0 || (sigmas[row] >= kLeastSigma && sigmas[row] <= kMostSigma);
      if (is_right) continue;
      RefuseNumber(absl::StrCat(field, "[", row, "]"), sigmas[row],
                   absl::StrCat("be 0, or in [", kLeastSigma, ", ", kMostSigma, "]"));
    }
    if (std::all_of(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma == 0.0; })) return;
    column = sigmas.size() == 1 ? std::vector<double>(problem_.rows, sigmas[0]) : sigmas;
  }

  void SetNumbers() {
    bool has_rows = true;
    for (size_t column = 0; column < request_.measured.size(); ++column) {
      const FitMeasured& measured = request_.measured[column];
      const std::string name = absl::StrCat("measured[", column, "]");
      has_rows = HasRows(name + ".values", measured.values.size(), false) && has_rows;
      has_rows = HasRows(name + ".sigma", measured.sigma.size(), true) && has_rows;
    }
    if (!has_rows) return;
    for (size_t row = 0; row < problem_.rows; ++row) {
      problem_.first_number.push_back(problem_.numbers.size());
      for (size_t column = 0; column < request_.measured.size(); ++column) SetNumber(row, column);
    }
    problem_.first_number.push_back(problem_.numbers.size());
    if (problem_.numbers.size() >= request_.unknowns.size() || request_.measured.empty()) return;
    Refuse("measured", absl::StrCat("has ", problem_.numbers.size(), " numbers in ", problem_.rows, " rows"),
           absl::StrCat("have at least ", request_.unknowns.size(), ", one for each unknown"));
  }

  void SetNumber(size_t row, size_t column) {
    const FitMeasured& measured = request_.measured[column];
    const bool is_one = measured.sigma.size() == 1;
    const double value = measured.values[row];
    const double sigma = measured.sigma[is_one ? 0 : row];
    if (std::isnan(value)) return;
    const std::string name = absl::StrCat("measured[", column, "]");
    if (std::isinf(value)) {
      RefuseNumber(absl::StrCat(name, ".values[", row, "]"), value, "be finite where something was measured");
    }
    // One sigma of all rows is refused once.
    const bool is_right = sigma > 0.0;
    const bool has_squares = sigma >= kLeastSigma && sigma <= kMostSigma;
    if (!has_squares && (!is_one || refused_sigmas_.insert(column).second)) {
      RefuseNumber(absl::StrCat(name, ".sigma[", is_one ? 0 : row, "]"), sigma,
                   is_right ? absl::StrCat("be in [", kLeastSigma, ", ", kMostSigma, "]")
                            : "be > 0, the standard deviation of the error");
    }
    problem_.numbers.push_back({row, column, value, sigma});
  }

  template <typename Value>
  void SetCount(const char* field, std::optional<Value> given, Value most, Value& to) {
    to = given.value_or(to);
    if (to < 1 || to > most) Refuse(field, absl::StrCat("= ", to), absl::StrCat("be in [1, ", most, "]"));
  }

  void SetSearch() {
    SetCount("starts", request_.starts, kMostFitStarts, problem_.starts);
    SetCount("max_iterations", request_.max_iterations, kMostFitIterations, problem_.max_iterations);
    const auto loss = static_cast<int>(request_.loss);
    if (loss < 0 || loss >= kFitLossCount) Refuse("loss", absl::StrCat("= ", loss), "be a loss that is named");
    const bool is_robust = request_.loss == FitLoss::kHuber || request_.loss == FitLoss::kCauchy;
    problem_.loss = is_robust ? request_.loss : FitLoss::kSquares;
    problem_.loss_scale = request_.loss_scale.value_or(request_.loss == FitLoss::kHuber ? kHuberScale : kCauchyScale);
    if (!is_robust && request_.loss_scale.has_value()) {
      RefuseNumber("loss_scale", *request_.loss_scale, "be unset without a robust loss");
    } else if (!(problem_.loss_scale >= kLeastFitLossScale && problem_.loss_scale <= kMostFitLossScale)) {
      RefuseNumber("loss_scale", problem_.loss_scale,
                   absl::StrCat("be in [", kLeastFitLossScale, ", ", kMostFitLossScale, "], in sigmas"));
    }
  }

  void SetRegion() {
    std::vector<std::string> known;
    for (const FitUnknown& unknown : request_.unknowns) known.push_back(unknown.path);
    for (size_t i = 0; i < request_.region.size(); ++i) {
      const auto found = std::find(known.begin(), known.end(), request_.region[i]);
      if (found == known.end()) {
        Refuse(absl::StrCat("region[", i, "]"), Found(request_.region[i]),
               absl::StrCat("be the path of an unknown", DidYouMean(request_.region[i], known)));
      }
      problem_.region.push_back(static_cast<size_t>(found - known.begin()));
    }
    const size_t size = problem_.region.size();
    if (size != 0 && (size != 2 || problem_.region[0] == problem_.region[1])) {
      Refuse("region", absl::StrCat("has ", size, size == 1 ? " entry" : " entries"),
             "have two different unknowns, or none");
    }
  }

  // All rows have the same parts, so that one scene, with all fields, tells for all of them whether there are
  // derivatives, and in which ranges the inputs lie.
  void SetFields() {
    Scene scene = problem_.batch.scene;
    for (size_t i = 0; i < problem_.batch.fields.size(); ++i) {
      const NumberRule rule = ResolveField(problem_.batch.fields[i], scene)->rule();
      if (i >= problem_.unknowns()) problem_.input_ranges.push_back(BoundsBy(rule));
    }
    const char* const part = WhyNotExact(scene);
    problem_.is_slow = TangentialDirections(scene.system) > 1 || TakesTime(scene) ||
                       (part != nullptr && problem_.has_uncertain_inputs());
    if (part != nullptr) {
      problem_.why_differences = part;
    } else if (!CheckDerivatives(scene, {}, {.of = problem_.batch.columns, .by = problem_.unknown_paths()}).empty()) {
      problem_.why_differences = "a measured number or an unknown that has no derivatives";
    }
  }

  const FitRequest& request_;
  Problem problem_;
  std::vector<Violation> violations_;
  std::set<size_t> refused_sigmas_;  // Columns with one sigma for all rows.
};

}  // namespace

absl::StatusOr<Problem> CheckFit(const FitRequest& request) { return Door(request).Pass(); }

}  // namespace ricochet::fit
