// The differences of outcomes: what a model gives at scenes of one form.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/answer/derivative_sides.h"
#include "core/answer/differences.h"
#include "core/answer/scene_outcome.h"
#include "core/contact/scene_contact.h"
#include "core/plan/number_demand.h"
#include "core/scene/validate.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The name at the end of a path.
absl::string_view NameOf(absl::string_view path) { return path.substr(path.rfind('.') + 1); }

// Returns the numbers, each with an error of its own, whose sum is the number with this name.
std::vector<absl::string_view> PartsOf(absl::string_view name) {
  if (name == "normal_total_j") return {"normal_compression_j", "normal_restitution_j"};
  if (name == "tangential_total_j" || name == "friction_dissipation_j") {
    return {"tangential_compression_j", "tangential_restitution_j"};
  }
  return {name};
}

ptrdiff_t SpeedsBelow(double speed, const std::optional<SpeedDependence>& dependence) {
  const auto* const table = dependence.has_value() ? std::get_if<SpeedTable>(&*dependence) : nullptr;
  if (table == nullptr) return 0;
  return std::count_if(table->speed_m_s.begin(), table->speed_m_s.end(), [speed](double one) { return one < speed; });
}

int SignOf(double x) { return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0); }

Course CourseOf(const Scene& scene, const Outcome& outcome) {
  Course course = {.regime = outcome.regime, .alternatives = outcome.alternatives.size()};
  for (const Event& event : outcome.timeline) course.events.push_back(event.kind);
  if (!outcome.timeline.empty()) {
    const Components& slip = outcome.timeline.front().state.contact_velocity.tangential_m_s;
    if (slip.size() == 1) {
      course.slip_before = SignOf(slip[0]);
      const bool is_rigid = outcome.plan.model == Model::kPlanar || outcome.plan.model == Model::kSliding;
      const double after = outcome.contact_velocity_after.tangential_m_s[0];
      const bool has_friction = outcome.regime != Regime::kFrictionless;
      if (course.slip_before == 0 && is_rigid && has_friction) course.slip_started = SignOf(after);
    } else {
      course.slip_before = std::any_of(slip.begin(), slip.end(), [](double u) { return u != 0.0; }) ? 1 : 0;
    }
    const double speed = -outcome.timeline.front().state.contact_velocity.normal_m_s;
    course.speeds_passed = SpeedsBelow(speed, scene.friction.by_speed) + SpeedsBelow(speed, scene.restitution_by_speed);
  }
  return course;
}

class OutcomeSource final : public SampleSource {
 public:
  OutcomeSource(const Demand& demand, absl::FunctionRef<bool()> stopped) : demand_(demand), stopped_(stopped) {
    demand_.relative_tolerance = 0.0;
  }

  // Solves the scene itself, which tells the places of the numbers and their scales.
  absl::Status Begin(const Scene& scene, const std::vector<std::string>& of) {
    std::optional<SceneContact> contact;
    Outcome outcome;
    absl::Status solved = SolveScene(scene, contact, demand_, {}, stopped_, outcome);
    if (!solved.ok()) return solved;
    FindPlaces(outcome, of);
    if (!contact.has_value()) contact.emplace(scene);
    const std::vector<double> numbers = NumbersOf(outcome);
    const std::vector<std::string> linear = LinearNumberPaths(scene.system);
    for (size_t i = 0; i < of.size(); ++i) {
      const double value = At(places_[i], numbers);
      const auto place = static_cast<size_t>(std::find(linear.begin(), linear.end(), of[i]) - linear.begin());
      const double scale = std::visit(
          [&](const auto& reduction) {
            const double impulse = outcome.impulse.normal_total_n_s;
            return place < linear.size() ? LinearScaleOf(reduction, place, impulse)
                                         : ScaleOf(of[i], SpeedOf(reduction), impulse);
          },
          contact->reduction);
      scales_.push_back(
          std::max({std::isnan(value) ? 0.0 : std::fabs(value), scale, std::numeric_limits<double>::min()}));
    }
    here_ = SampleOf(scene, outcome);
    return absl::OkStatus();
  }

  bool At(const Scene& scene, std::optional<Sample>& sample) const override {
    sample.reset();
    if (stopped_()) return false;
    std::optional<SceneContact> contact;
    if (!Validate(scene, RestitutionIs::kRequired, contact).empty()) return true;
    Outcome outcome;
    const absl::Status solved = SolveScene(scene, contact, demand_, {}, stopped_, outcome);
    if (solved.ok()) sample = SampleOf(scene, outcome);
    return !absl::IsCancelled(solved);
  }

 private:
  template <typename Reduction>
  static double SpeedOf(const Reduction& reduction) {
    double speed = std::fabs(reduction.v0);
    for (const double u : reduction.u0) speed = std::max(speed, std::fabs(u));
    return speed;
  }

  static double At(size_t place, const std::vector<double>& numbers) {
    return place < numbers.size() ? numbers[place] : kNone;
  }

  // All outcomes of scenes of one form have the same places in the same order. Components may share an error.
  void FindPlaces(const Outcome& outcome, const std::vector<std::string>& of) {
    std::vector<std::string> paths;
    VisitOutcomeFields(outcome,
                       [&](const NumberPath& path, const double* /*number*/) { paths.push_back(path.Text()); });
    const auto place_of = [&paths](const std::string& path) {
      return static_cast<size_t>(std::find(paths.begin(), paths.end(), path) - paths.begin());
    };
    for (const std::string& path : of) {
      const absl::string_view name = NameOf(path);
      places_.push_back(place_of(path));
      std::vector<size_t>& errors = error_places_.emplace_back();
      for (const absl::string_view part : PartsOf(name)) errors.push_back(place_of(absl::StrCat("errors.", part)));
      const bool has_own = errors.front() < paths.size();
      if (!has_own) errors.front() = place_of(absl::StrCat("errors.", HeadOf(name)));
    }
  }

  static std::vector<double> NumbersOf(const Outcome& outcome) {
    std::vector<double> numbers;
    VisitOutcomeFields(outcome, [&](const NumberPath& /*path*/, const double* number) {
      numbers.push_back(number == nullptr ? kNone : *number);
    });
    return numbers;
  }

  // A number without an error of its own, or without a finite one, has that of the outcome, on its scale.
  Sample SampleOf(const Scene& scene, const Outcome& outcome) const {
    const std::vector<double> numbers = NumbersOf(outcome);
    const double relative = std::max(outcome.accuracy.relative_error, 0x1p-51);
    Sample sample = {.course = CourseOf(scene, outcome)};
    for (size_t i = 0; i < places_.size(); ++i) {
      // A state that was reached without an end is no function of the scene, so it has no value here.
      const double value = HasEnd(outcome.regime) ? At(places_[i], numbers) : kNone;
      double error = 0.0;
      for (const size_t place : error_places_[i]) error += At(place, numbers);
      sample.value.push_back(value);
      sample.error.push_back(std::isfinite(error) ? std::max(error, 0x1p-52 * std::fabs(value))
                                                  : relative * scales_[i]);
    }
    return sample;
  }

  Demand demand_;
  absl::FunctionRef<bool()> stopped_;
  // The places of each number and of the errors of its parts among the numbers of an outcome; behind the last one if
  // there is none.
  std::vector<size_t> places_;
  std::vector<std::vector<size_t>> error_places_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<SampleSource>> OutcomeSamples(const Scene& scene, const Demand& demand,
                                                             const std::vector<std::string>& of,
                                                             absl::FunctionRef<bool()> stopped) {
  auto source = std::make_unique<OutcomeSource>(WithNumbers(demand, of), stopped);
  if (absl::Status begun = source->Begin(scene, of); !begun.ok()) return begun;
  return source;
}

}  // namespace ricochet
