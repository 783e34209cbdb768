#include "core/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/fit/information.h"
#include "core/fit/judgement.h"
#include "core/fit/model.h"
#include "core/fit/problem.h"
#include "core/fit/profile.h"
#include "core/fit/search.h"
#include "core/fit/starts.h"
#include "core/numerics/elementary.h"
#include "ricochet/error.h"

namespace ricochet {
namespace fit {
namespace {

// A region is traced along this many rays.
constexpr int kRays = 48;
// A profile has this many points before each end of its interval.
constexpr int kPlaces = 4;
// The intervals are sought again at most this many times after a ray has found a better fit.
constexpr int kMostRestarts = 4;
// Where all rows stick, or none approaches, the search sees no way to a better fit. So it looks at many places, and
// goes on from the best of them, as long as that leads to a better fit; before it refuses a fit, from more.
constexpr int kMostLooks = 4;
constexpr int kLookedAtAlways = 128, kLookedAtIfRefused = 512;
constexpr size_t kStartsAlways = 6, kStartsIfRefused = 16;
// A further start that lowers the objective by less than this part of it has found the same fit.
constexpr double kLeastGain = 1e-6;

// Refuses a start at which a measured number has no prediction.
absl::Status CheckStart(const FitRequest& request, Model& model) {
  std::vector<double> residuals;
  if (model.Residuals(model.problem().start, residuals)) return absl::OkStatus();
  const std::optional<BadRow> found = model.Bad(model.problem().start);
  if (model.is_stopped()) return absl::OkStatus();
  if (!found.has_value()) return OutputOverflow("a residual at the start");
  const BadRow& bad = *found;
  const auto row = static_cast<size_t>(bad.row);
  for (size_t i = 0; i < request.inputs.size(); ++i) {
    if (request.inputs[i].path != bad.field) continue;
    return InvalidRequest({{absl::StrCat("inputs[", i, "].values[", row, "]"), bad.description}});
  }
  for (size_t k = 0; k < request.unknowns.size(); ++k) {
    if (request.unknowns[k].path != bad.field) continue;
    return InvalidRequest({{absl::StrCat("unknowns[", k, "].start"), absl::StrCat(bad.description, " in row ", row)}});
  }
  for (size_t j = 0; j < request.measured.size(); ++j) {
    if (request.measured[j].path != bad.field || !bad.description.empty()) continue;
    return InvalidRequest(
        {MakeViolation(absl::StrCat("measured[", j, "].values[", row, "]"), request.measured[j].values[row],
                       "be NaN: at the start the impact of this row has no such number")});
  }
  return InvalidRequest({{bad.field, absl::StrCat(bad.description, " in row ", row)}});
}

// Refuses a fit whose squared residuals overflow, because its other numbers would be wrong.
absl::Status CheckResiduals(const FitRequest& request, const FitResponse& response) {
  for (size_t row = 0; row < response.rows.size(); ++row) {
    const std::vector<double>& residuals = response.rows[row].residuals;
    for (size_t j = 0; j < residuals.size(); ++j) {
      if (std::isnan(residuals[j]) || std::isfinite(residuals[j] * residuals[j])) continue;
      return OutputOverflow(absl::StrCat("the square of rows[", row, "].residuals[", j, "], of ",
                                         request.measured[j].path, "; it is too large:"));
    }
  }
  return std::isfinite(response.chi2) ? absl::OkStatus() : OutputOverflow("chi2");
}

// Fits one request.
class Fitter {
 public:
  // `model` is that of the problem, whose scales change if the fit has others than the start.
  Fitter(Problem& problem, Model& model) : problem_(problem), model_(model), all_free_(problem.unknowns(), true) {}

  FitResponse Fit() {
    Search();
    if (!model_.is_stopped() && Rescale()) {
      const Minimum before = best_;
      response_.starts.clear();
      Search();
      SearchFurther(before.at);
    }
    if (model_.is_stopped()) return {};  // There may be no fit yet to look at.
    for (int restart = 0; FollowUnknowns(restart < kMostRestarts) && !model_.is_stopped(); ++restart) Look();
    FollowRegion();
    Judge(problem_, best_.at, information_, model_, response_);
    return std::move(response_);
  }

 private:
  void Search() {
    for (int number = 0; number < problem_.starts; ++number) SearchFrom(StartOf(problem_, number), number);
    if (model_.is_stopped()) return;
    Look();
    LookAround(problem_.start);
    for (int look = 0; look < kMostLooks && LookAround(best_.at); ++look) continue;
    if (IsRefused()) {
      for (const std::vector<double>& start : PlacesOf(problem_.start, kLookedAtIfRefused, kStartsIfRefused)) {
        if (IsRefused()) SearchFurther(start);
      }
    }
  }

  // Steps and tolerances scale with the unknowns, whose sizes a start far from the fit does not tell. Returns true if
  // the fit has shown an unknown to be much smaller, by more than its error.
  bool Rescale() {
    constexpr double kMuchSmaller = 1e-2;
    bool changes = false;
    for (size_t k = 0; k < problem_.unknowns(); ++k) {
      if (!information_.is_seen[k]) continue;
      const double sigma = std::sqrt(information_.covariance[k * problem_.unknowns() + k]);
      const double size = std::max(std::fabs(best_.at[k]), sigma);
      if (!(size > 0.0 && size < kMuchSmaller * problem_.scale[k])) continue;
      problem_.scale[k] = size;
      changes = true;
    }
    return changes;
  }

  // Returns true if the fit is the best so far.
  bool SearchFrom(const std::vector<double>& start, int number) {
    if (model_.is_stopped()) return false;
    Minimum found = Minimize(start, all_free_, kFineSearch, model_);
    Approach(start, model_, found);
    minima_.push_back(found);
    const bool is_best = number == 0 || found.objective < best_.objective - kAsGood;
    // The response lists a further start, which the request did not ask for, only if it led to a better fit.
    const bool has_gained = is_best && found.objective < (1.0 - kLeastGain) * best_.objective;
    if (number >= problem_.starts && !has_gained) return false;
    const bool has_start = std::isfinite(found.objective);
    response_.starts.push_back({start, found.at, found.objective, found.iterations, found.converged && has_start});
    if (is_best) best_ = found;
    return is_best;
  }

  std::vector<std::vector<double>> PlacesOf(const std::vector<double>& centre, int looked_at, size_t most) {
    return BestPlaces(centre, all_free_, looked_at, most, model_);
  }

  // Searches from places around `centre`. Returns true if that finds a better fit.
  bool LookAround(const std::vector<double>& centre) {
    const double before = best_.objective;
    for (const std::vector<double>& start : PlacesOf(centre, kLookedAtAlways, kStartsAlways)) SearchFurther(start);
    return best_.objective < before - kAsGood;
  }

  void SearchFurther(const std::vector<double>& start) {
    if (SearchFrom(start, problem_.starts)) Look();
  }

  // True if the residuals of the best fit are too large for their errors.
  bool IsRefused() const {
    const std::optional<double> p_value = PValueOf(information_);
    return p_value.has_value() ? *p_value < kFitRefusedBelow : information_.chi2 > kAsGood;
  }

  // Computes what the data tell about the unknowns at the best fit.
  void Look() {
    LinearResiduals residuals = {
        .values = {}, .slopes = {}, .sigmas = model_.Sigmas(best_.at), .held_inputs = model_.HeldInputs(best_.at)};
    if (!model_.Residuals(best_.at, residuals.values) || !model_.Slopes(best_.at, all_free_, residuals.slopes)) {
      residuals.slopes.assign(problem_.numbers.size() * problem_.unknowns(), 0.0);
    }
    residuals.values.resize(problem_.residuals(), 0.0);
    information_ = InformationOf(problem_, best_.at, residuals, [this] { return model_.Stops(); });
  }

  // Returns the distance at which the end of an interval or a region is expected.
  double SizeOf(size_t k) const {
    const size_t size = problem_.unknowns();
    if (information_.is_seen[k]) return 2.0 * std::sqrt(information_.covariance[k * size + k]);
    return 0.25 * std::max(std::fabs(best_.at[k]), 0.25 * problem_.scale[k]);
  }

  // Returns the direction that holds the given unknowns and moves them by these parts of the sizes of their intervals.
  Direction Towards(const std::vector<std::pair<size_t, double>>& parts) const {
    Direction direction = {.is_free = all_free_, .step = std::vector<double>(problem_.unknowns(), 0.0)};
    for (const auto& [k, part] : parts) {
      direction.is_free[k] = false;
      direction.step[k] = part * SizeOf(k);
    }
    return direction;
  }

  // Finds the interval of each unknown. If it may restart, it returns true as soon as it has found a better fit, from
  // which to start again.
  bool FollowUnknowns(bool may_restart) {
    response_.unknowns.clear();
    for (size_t k = 0; k < problem_.unknowns() && !model_.is_stopped(); ++k) {
      FitEstimate& estimate = response_.unknowns.emplace_back();
      estimate = {.path = problem_.batch.fields[k], .value = best_.at[k], .seen = information_.is_seen[k]};
      estimate.row_shares = information_.row_shares[k];
      if (estimate.seen) estimate.sigma = std::sqrt(information_.covariance[k * problem_.unknowns() + k]);
      estimate.profile.push_back({best_.at[k], 0.0});
      for (const double side : {-1.0, 1.0}) {
        const Direction direction = Towards({{k, side}});
        const double rise = kFitRiseOfInterval * information_.rise;
        RayEnd end = EndOfRay(best_, direction, rise, kPlaces, model_);
        if (end.better.has_value() && may_restart) return Adopt(*end.better);
        Extend(k, direction, rise, end);
        SetEnd(end, direction.step[k], side < 0.0 ? estimate.low : estimate.high, estimate);
      }
      estimate.seen =
          estimate.seen || (estimate.low.kind == FitEndKind::kFound && estimate.high.kind == FitEndKind::kFound);
      std::sort(estimate.profile.begin(), estimate.profile.end(),
                [](const FitProfilePoint& a, const FitProfilePoint& b) { return a.value < b.value; });
    }
    return false;
  }

  // Moves the end of an interval to that of another minimum beyond it, if that one fits nearly as well.
  void Extend(size_t k, const Direction& direction, double rise, RayEnd& end) {
    const auto distance_of = [&](const Minimum& other) { return (other.at[k] - best_.at[k]) / direction.step[k]; };
    const auto is_beyond = [&](const Minimum& other) {
      return other.objective - best_.objective < rise && distance_of(other) > end.distance;
    };
    while (!model_.is_stopped()) {
      const auto other = std::find_if(minima_.begin(), minima_.end(), is_beyond);
      if (other == minima_.end()) return;
      const double gap = other->objective - best_.objective, distance = distance_of(*other);
      const RayEnd further = EndOfRay(*other, direction, rise - gap, 0, model_);
      end.kind = further.kind;
      end.distance = distance + further.distance;
      for (const RayPoint& point : further.computed) {
        end.computed.push_back({distance + point.distance, gap + point.rise});
      }
    }
  }

  bool Adopt(const Minimum& better) {
    Minimum found = Minimize(better.at, all_free_, kFineSearch, model_);
    Approach(better.at, model_, found);
    best_ = found.objective < better.objective ? found : better;
    return true;
  }

  // Returns the best fit's number plus a step. A sum that rounds beside a bound is replaced by the bound.
  double PlaceOf(size_t k, double step) const {
    const double place = std::clamp(best_.at[k] + step, problem_.low[k], problem_.high[k]);
    for (const double bound : {problem_.low[k], problem_.high[k]}) {
      if (std::isfinite(bound) && std::fabs(place - bound) <= 0x1p-40 * std::fabs(best_.at[k] - bound)) return bound;
    }
    return place;
  }

  void SetEnd(const RayEnd& ray, double step, FitEnd& end, FitEstimate& estimate) const {
    const size_t k = response_.unknowns.size() - 1;
    const double value = PlaceOf(k, ray.distance * step);
    end.kind = ray.kind;
    if (ray.kind == FitEndKind::kFound || ray.kind == FitEndKind::kCutByBound) end.value = value;
    // The data do not determine this number, so a bound that it reaches is not an end that the data gave.
    if (!estimate.seen && ray.kind != FitEndKind::kFound) end = {.kind = FitEndKind::kNotSeen, .value = {}};
    for (const RayPoint& point : ray.computed) {
      if (!std::isfinite(point.rise)) continue;
      estimate.profile.push_back({estimate.value + point.distance * step, std::max(point.rise, 0.0)});
    }
  }

  void FollowRegion() {
    if (problem_.region.empty()) return;
    const size_t x = problem_.region[0];
    const size_t y = problem_.region[1];
    for (int ray = 0; ray < kRays && !model_.is_stopped(); ++ray) {
      // A quarter of a turn leaves one of the two as it is, so that it does not leave a bound by rounding.
      const double angle = 2.0 * std::numbers::pi * ray / kRays;
      const double cosine = ray % (kRays / 2) == kRays / 4 ? 0.0 : Cos(angle);
      const double sine = ray % (kRays / 2) == 0 ? 0.0 : Sin(angle);
      const Direction direction = Towards({{x, cosine}, {y, sine}});
      const RayEnd end = EndOfRay(best_, direction, kRiseOfRegion * information_.rise, 0, model_);
      if (end.kind != FitEndKind::kFound && end.kind != FitEndKind::kCutByBound) continue;
      response_.region.push_back(
          {PlaceOf(x, end.distance * direction.step[x]), PlaceOf(y, end.distance * direction.step[y]), end.kind});
    }
  }

  Problem& problem_;
  Model& model_;
  const std::vector<bool> all_free_;
  Minimum best_;
  std::vector<Minimum> minima_;  // All that searches have found.
  Information information_;
  FitResponse response_;
};

}  // namespace

}  // namespace fit

absl::StatusOr<FitResponse> FitScene(const FitRequest& request, fit::OpenRows open_rows,
                                     absl::FunctionRef<bool()> stopped) {
  absl::StatusOr<fit::Problem> problem = fit::CheckFit(request);
  if (!problem.ok()) return problem.status();
  fit::Model model(*problem, open_rows(problem->batch), stopped);
  if (absl::Status bad = fit::CheckStart(request, model); !bad.ok()) return bad;
  FitResponse response = fit::Fitter(*problem, model).Fit();
  if (model.is_stopped()) return absl::CancelledError("the fit was stopped by its caller");
  if (absl::Status overflow = fit::CheckResiduals(request, response); !overflow.ok()) return overflow;
  return response;
}

}  // namespace ricochet
