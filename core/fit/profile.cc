#include "core/fit/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

namespace ricochet::fit {
namespace {

// A search that has gone so many times the first distance has no end.
constexpr double kFarthest = 0x1p20;
// An end is exact to this part of its distance, or where the root of the rise is exact to it.
constexpr double kEndTolerance = 1e-5;
// A search goes on beyond so many ends that were none.
constexpr int kMostFurther = 8;
// A better fit by no more than this is the same fit.
constexpr double kSameFit = 1e-6;

class Ray {
 public:
  Ray(const Minimum& best, const Direction& direction, double rise, Model& model)
      : best_(best), is_free_(direction.is_free), step_(direction.step), rise_(rise), model_(model), last_(best.at) {
    const Problem& problem = model.problem();
    for (size_t k = 0; k < step_.size(); ++k) {
      if (is_free_[k] || step_[k] == 0.0) continue;
      const double bound = step_[k] > 0.0 ? problem.high[k] : problem.low[k];
      longest_ = std::min(longest_, (bound - best.at[k]) / step_[k]);
    }
    longest_ = std::max(longest_, 0.0);
  }

  RayEnd Find(int places) {
    RayEnd end = Search();
    last_ = best_.at;
    if (end.kind == FitEndKind::kUnbounded || end.distance == 0.0) places = 0;
    for (int i = 1; i <= places && !model_.is_stopped(); ++i) Next(end.distance * i / (places + 1.0));
    end.computed = std::move(end_.computed);
    end.better = std::move(end_.better);
    return end;
  }

 private:
  // The other unknowns follow from place to place. Where they end is no end if they can go on from elsewhere.
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
      const RayEnd end = Narrow(inside, outside);
      if (further == kMostFurther || !GoesOn(outside, inside)) return end;
    }
  }

  static RayEnd End(FitEndKind kind, double distance) { return {.kind = kind, .distance = distance}; }

  // The unknowns that are held at a distance, and the others as far as they stay in their bounds.
  std::vector<double> StartAt(double distance, const std::vector<double>& from, double factor) const {
    const auto [low, high] = std::tie(model_.problem().low, model_.problem().high);
    std::vector<double> start = best_.at;
    for (size_t k = 0; k < start.size(); ++k) {
      start[k] = std::clamp(is_free_[k] ? factor * from[k] : start[k] + distance * step_[k], low[k], high[k]);
    }
    return start;
  }

  RayPoint Adopt(double distance, const Minimum& least) {
    if (std::isfinite(least.objective)) last_ = least.at;
    if (least.objective < best_.objective - kSameFit && !end_.better.has_value()) end_.better = least;
    end_.computed.push_back({distance, least.objective - best_.objective});
    return end_.computed.back();
  }

  // The other unknowns start where they ended last.
  RayPoint Next(double distance) {
    return Adopt(distance, Minimize(StartAt(distance, last_, 1.0), is_free_, kCoarseSearch, model_));
  }

  // Sees whether a place outside is inside if the other unknowns start at the best fit, or move by the factor of the
  // one that is held, or by its inverse, as numbers do of which a product or a quotient alone is measured. If so, it is
  // the new place inside.
  bool GoesOn(const RayPoint& outside, RayPoint& inside) {
    double factor = 1.0;
    const std::vector<double> held = StartAt(outside.distance, best_.at, 1.0);
    for (size_t k = 0; k < held.size(); ++k) {
      if (!is_free_[k] && best_.at[k] != 0.0) factor = held[k] / best_.at[k];
    }
    for (const double by : {1.0, factor, 1.0 / factor}) {
      const Minimum found = Minimize(StartAt(outside.distance, best_.at, by), is_free_, kCoarseSearch, model_);
      if (found.objective - best_.objective < rise_) {
        inside = Adopt(outside.distance, found);
        return true;
      }
      if (!std::isfinite(found.objective)) break;  // Beyond a rule of the scene, and not a valley.
    }
    return false;
  }

  // Closes in on the end between a place inside and one outside. The root of the rise is nearly straight, so that the
  // next place is where a line through both meets that of the end; every third is the middle.
  RayEnd Narrow(RayPoint& inside, RayPoint& outside) {
    const double target = std::sqrt(rise_);
    const auto root = [](const RayPoint& point) { return std::sqrt(std::max(point.rise, 0.0)); };
    for (int i = 0; i < 80 && !model_.is_stopped(); ++i) {
      if (root(outside) - target < kEndTolerance * target) return End(FitEndKind::kFound, outside.distance);
      if (target - root(inside) < kEndTolerance * target) return End(FitEndKind::kFound, inside.distance);
      const double width = outside.distance - inside.distance;
      if (width <= kEndTolerance * outside.distance) break;
      const double part = (target - root(inside)) / (root(outside) - root(inside));
      const bool is_line = i % 3 != 2 && part > 0.0;
      const RayPoint next = Next(inside.distance + width * (is_line ? std::clamp(part, 1e-3, 0.999) : 0.5));
      (next.rise < rise_ ? inside : outside) = next;
    }
    return End(std::isfinite(outside.rise) ? FitEndKind::kFound : FitEndKind::kCutByBound, inside.distance);
  }

  const Minimum& best_;
  const std::vector<bool>& is_free_;
  const std::vector<double>& step_;
  const double rise_;
  Model& model_;
  std::vector<double> last_;                                  // The unknowns of the last place.
  double longest_ = std::numeric_limits<double>::infinity();  // The distance to the nearest bound.
  RayEnd end_;  // It holds what the places so far have shown, but for the kind.
};

}  // namespace

RayEnd EndOfRay(const Minimum& best, const Direction& direction, double rise, int places, Model& model) {
  return Ray(best, direction, rise, model).Find(places);
}

}  // namespace ricochet::fit
