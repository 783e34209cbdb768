#include "core/fit/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/fit/starts.h"

namespace ricochet::fit {
namespace {

// An end that lies beyond this many times the first distance counts as unbounded.
constexpr double kFarthest = 0x1p20;
// An end is exact to this part of its distance, or where the root of the rise is exact to it.
constexpr double kEndTolerance = 1e-5;
// A search continues at most this many times past an end beyond which other values of the free unknowns still fit.
constexpr int kMostFurther = 8;
// At an end this many places of the free unknowns are evaluated, and searches start from the best kTriedPlaces.
constexpr int kLookedAt = 128;
constexpr size_t kTriedPlaces = 6;
// A place on the way to an end is searched from this many starts, and the end itself from all.
constexpr size_t kStartsOnTheWay = 2;

// The unknowns at a distance.
struct Place {
  double distance = 0.0;
  std::vector<double> at;
};

class Ray {
 public:
  Ray(const Minimum& best, const Direction& direction, double rise, Model& model)
      : best_(best),
        is_free_(direction.is_free),
        step_(direction.step),
        rise_(rise),
        model_(model),
        last_inside_{0.0, best.at},
        inside_before_(last_inside_) {
    const Problem& problem = model.problem();
    for (size_t k = 0; k < step_.size(); ++k) {
      if (is_free_[k] || step_[k] == 0.0) continue;
      const double bound = step_[k] > 0.0 ? problem.high[k] : problem.low[k];
      const double distance = (bound - best.at[k]) / step_[k];
      if (!(distance < longest_)) continue;
      longest_ = distance;
      at_bound_ = kEndTolerance * std::min(distance, problem.scale[k] / std::fabs(step_[k]));
    }
    longest_ = std::max(longest_, 0.0);
  }

  RayEnd Find(int places) {
    RayEnd end = Search();
    beyond_ = last_inside_;
    last_inside_ = inside_before_ = {0.0, best_.at};
    if (end.kind == FitEndKind::kUnbounded || end.distance == 0.0) places = 0;
    for (int i = 1; i <= places && !model_.is_stopped(); ++i) {
      const RayPoint point = Next(end.distance * i / (places + 1.0));
      RayPoint inside;
      if (!(point.rise < rise_)) GoesOn(point, inside);
    }
    end.computed = std::move(end_.computed);
    end.better = std::move(end_.better);
    return end;
  }

 private:
  // Each place starts from the free unknowns of the last one inside. An end counts only if no other start gets past it.
  RayEnd Search() {
    RayPoint inside;
    for (int further = 0;; ++further) {
      RayPoint outside = inside;
      while (outside.rise < rise_) {
        inside = outside;
        if (inside.distance >= longest_) return End(FitEndKind::kCutByBound, inside.distance);
        if (inside.distance >= kFarthest) return End(FitEndKind::kUnbounded, inside.distance);
        outside = Next(std::min(inside.distance > 0.0 ? 2.0 * inside.distance : 1.0, longest_));
      }
      RayEnd end = Narrow(inside, outside);
      if (further == kMostFurther || !GoesOn(outside, inside)) return end;
      is_plain_ = false;
    }
  }

  static RayEnd End(FitEndKind kind, double distance) { return {.kind = kind, .distance = distance}; }

  // Returns the held unknowns at a distance and `factor` times the others, all clamped to their bounds.
  std::vector<double> StartAt(double distance, const std::vector<double>& from, double factor) const {
    const auto [low, high] = std::tie(model_.problem().low, model_.problem().high);
    std::vector<double> start = best_.at;
    for (size_t k = 0; k < start.size(); ++k) {
      start[k] = std::clamp(is_free_[k] ? factor * from[k] : start[k] + distance * step_[k], low[k], high[k]);
    }
    return start;
  }

  // Returns the unknowns at a distance, the free ones on the line through the last place inside and the next one beyond
  // or, if there is none, the one before.
  std::vector<double> OnLine(double distance) const {
    const Place& other = beyond_.distance > last_inside_.distance ? beyond_ : inside_before_;
    std::vector<double> at = last_inside_.at;
    if (other.distance == last_inside_.distance) return StartAt(distance, at, 1.0);
    const double part = (distance - last_inside_.distance) / (other.distance - last_inside_.distance);
    for (size_t k = 0; k < at.size(); ++k) at[k] += part * (other.at[k] - last_inside_.at[k]);
    return StartAt(distance, at, 1.0);
  }

  // Searches from a start, from each only once.
  const Minimum& MinimumFrom(const std::vector<double>& start) {
    const auto [search, is_new] = searches_.try_emplace(start);
    Minimum& found = search->second;
    if (!is_new) return found;
    // An iteration that lowers the objective by less changes the end by less than a tenth of its tolerance.
    const double tolerance = 0.1 * kEndTolerance * rise_ / (best_.objective + rise_);
    found = Minimize(start, is_free_, tolerance, model_);
    is_plain_ &= std::isfinite(found.objective);
    return found;
  }

  // Returns the distance or, if that is less, the smallest held number over its step.
  double SizeAt(double distance) const {
    double size = distance;
    for (size_t k = 0; k < step_.size(); ++k) {
      const double held = std::fabs(best_.at[k] + distance * step_[k]);
      if (!is_free_[k] && step_[k] != 0.0 && held > 0.0) size = std::min(size, held / std::fabs(step_[k]));
    }
    return size;
  }

  RayPoint Adopt(double distance, const Minimum& least) {
    const double rise = least.objective - best_.objective;
    if (IsInside(least)) {
      if (distance != last_inside_.distance) inside_before_ = std::move(last_inside_);
      last_inside_ = {distance, least.at};
      // A place outside that lies nearer than this one had missed the least objective, so it is dropped.
      std::erase_if(end_.computed,
                    [&](const RayPoint& point) { return point.distance <= distance && point.rise >= rise_; });
    }
    if (!IsInside(least)) beyond_ = {distance, least.at};
    if (least.objective < best_.objective - kAsGood && !end_.better.has_value()) end_.better = least;
    return end_.computed.emplace_back(RayPoint{distance, rise});
  }

  // Searches from starts until one ends inside. A place outside is tried from elsewhere, as the other unknowns may have
  // ended where they change nothing, or at the edge of what has a prediction; on the way to an end of a plain ray only
  // from kStartsOnTheWay.
  RayPoint Next(double distance, bool is_on_the_way = false) {
    const std::vector<std::vector<double>> starts = StartsAt(distance);
    Minimum least = MinimumFrom(starts[0]);
    for (size_t i = 1; i < starts.size() && !IsInside(least); ++i) {
      if (i == kStartsOnTheWay && is_on_the_way && is_plain_) break;
      const Minimum& found = MinimumFrom(starts[i]);
      if (found.objective < least.objective) least = found;
    }
    return Adopt(distance, least);
  }

  // Tries whether a place outside is inside if the other unknowns start elsewhere: near where they last ended inside,
  // which is closer now than when the place was first tried, or at the best of many places. If so, it becomes the new
  // place inside.
  bool GoesOn(const RayPoint& outside, RayPoint& inside) {
    if (!HasFree()) return false;
    const auto is_inside_from = [&](const std::vector<double>& start) {
      const Minimum& found = MinimumFrom(start);
      if (IsInside(found)) inside = Adopt(outside.distance, found);
      return IsInside(found);
    };
    const std::vector<std::vector<double>> starts = StartsAt(outside.distance);
    if (std::any_of(starts.begin(), starts.end(), is_inside_from)) return true;
    const std::vector<std::vector<double>> places =
        BestPlaces(StartAt(outside.distance, best_.at, 1.0), is_free_, kLookedAt, kTriedPlaces, model_);
    return std::any_of(places.begin(), places.end(), is_inside_from);
  }

  bool IsInside(const Minimum& found) const { return found.objective - best_.objective < rise_; }

  bool HasFree() const {
    return std::any_of(is_free_.begin(), is_free_.end(), [](bool is_free) { return is_free; });
  }

  // The other unknowns on a line through two places, at the last place inside and at the best fit; and moved from these
  // by the factor of the one that is held, or by its inverse, as numbers do of which a product or a quotient alone is
  // measured; and where the caller's first start has them. Each start comes once, the most likely ones first.
  std::vector<std::vector<double>> StartsAt(double distance) const {
    std::vector<std::vector<double>> starts;
    const auto add = [&starts](std::vector<double> start) {
      if (std::find(starts.begin(), starts.end(), start) == starts.end()) starts.push_back(std::move(start));
    };
    add(OnLine(distance));
    for (const std::vector<double>* const from : {&last_inside_.at, &best_.at}) {
      const std::vector<double> held = StartAt(distance, *from, 1.0);
      double factor = 1.0;
      for (size_t k = 0; k < held.size(); ++k) {
        if (!is_free_[k] && (*from)[k] != 0.0) factor = held[k] / (*from)[k];
      }
      add(held);
      add(StartAt(distance, *from, 1.0 / factor));
      add(StartAt(distance, *from, factor));
    }
    add(StartAt(distance, model_.problem().start, 1.0));
    return starts;
  }

  // Closes in on the end between a place inside and one outside. The root of the rise is nearly straight, so that the
  // next place is where a line through both meets that of the end; every third is the middle.
  RayEnd Narrow(RayPoint& inside, RayPoint& outside) {
    const double target = std::sqrt(rise_);
    const auto root = [](const RayPoint& point) { return std::sqrt(std::max(point.rise, 0.0)); };
    // A third of these halves the held number from 1e20 times the end.
    constexpr int kPlaces = 240;
    for (int i = 0; i < kPlaces && !model_.is_stopped(); ++i) {
      if (root(outside) - target < kEndTolerance * target) return End(FitEndKind::kFound, outside.distance);
      if (target - root(inside) < kEndTolerance * target) return End(FitEndKind::kFound, inside.distance);
      if (inside.distance >= longest_ - at_bound_) return End(FitEndKind::kCutByBound, longest_);
      const double width = outside.distance - inside.distance;
      if (width <= kEndTolerance * SizeAt(inside.distance)) break;
      const double part = (target - root(inside)) / (root(outside) - root(inside));
      const bool is_line = i % 3 != 2 && part > 0.0;
      const double share = is_line ? std::clamp(part, 1e-3, 0.999) : 0.5;
      const RayPoint next = Next(inside.distance + width * share, /*is_on_the_way=*/true);
      (next.rise < rise_ ? inside : outside) = next;
    }
    // Where doubles do not resolve the numbers any more, the data have not ended the interval.
    if (!model_.Resolves(StartAt(outside.distance, last_inside_.at, 1.0))) {
      return End(FitEndKind::kUnbounded, inside.distance);
    }
    return End(std::isfinite(outside.rise) ? FitEndKind::kFound : FitEndKind::kCutByBound, inside.distance);
  }

  const Minimum& best_;
  const std::vector<bool>& is_free_;
  const std::vector<double>& step_;
  const double rise_;
  Model& model_;
  Place last_inside_, inside_before_;  // The last two places inside, or the best fit.
  Place beyond_;                       // The last place outside, or the end.
  bool is_plain_ = true;  // All searches had a prediction, and no place outside has turned out to be inside.
  std::map<std::vector<double>, Minimum> searches_;           // Each has its start.
  double longest_ = std::numeric_limits<double>::infinity();  // The distance to the nearest bound.
  double at_bound_ = 0.0;                                     // An end that is no further from the bound lies there.
  RayEnd end_;  // It holds what the places so far have shown, but for the kind.
};

}  // namespace

RayEnd EndOfRay(const Minimum& best, const Direction& direction, double rise, int places, Model& model) {
  return Ray(best, direction, rise, model).Find(places);
}

}  // namespace ricochet::fit
