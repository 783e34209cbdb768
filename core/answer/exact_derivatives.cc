#include "core/answer/exact_derivatives.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/answer/derivative_paths.h"
#include "core/answer/scene_line.h"
#include "core/models/planar/columns.h"
#include "core/models/planar_outputs.h"
#include "core/plan/scene_problem.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"

namespace ricochet {
namespace {

// The sides of a number that is 0 lie at plus and minus this value, whose square is still a normal double.
constexpr double kBeside = 0x1p-300;
constexpr size_t kOutputs = kPlanarOutputPaths.size();
// Two rates count as equal if they differ by less than kRounding of themselves, or by less than kNegligible of the
// largest rate of any number of the outcome, each over its size: terms of that size may have cancelled. Beside a number
// that is 0 the derivative itself may change by kSlight between the sides. If both sides take the same course, and a
// doubling of the number changes the outcome by less than kUnseen of its size, that change is rounding.
constexpr double kRounding = 0x1p-40;
constexpr double kNegligible = 0x1p-60;
constexpr double kSlight = 0x1p-200;
constexpr double kUnseen = 0x1p-80;

constexpr size_t PlaceOf(PlanarOutput output) { return static_cast<size_t>(output); }

planar::Problem ProblemOf(const Scene& scene, const SceneContact& contact) {
  return planar::MakeProblem(std::get<PlanarReduction>(contact.reduction), scene.restitution, contact.coefficients);
}

// A number of the impact, or one of the system that is linear in its impulse.
double ValueAt(size_t place, const PlanarReduction& reduction,
               const std::array<double, kPlanarOutputCount>& of_impact) {
  if (place < kOutputs) return of_impact[place];
  const auto [before, x] = LinearNumberAt<2>(place - kOutputs, reduction);
  return before + x[0] * of_impact[PlaceOf(PlanarOutput::kTangentialImpulse)] +
         x[1] * of_impact[PlaceOf(PlanarOutput::kNormalImpulse)];
}

Field FieldIn(Scene& scene, const std::string& path) { return *ResolveField(path, scene); }

}  // namespace

ExactDerivatives::Number::Number(const Scene& form, std::string its_path)
    : path(std::move(its_path)),
      is_stated(path == kPhi || NumberAt(form, path).has_value()),
      scene(Stating(path, form)),
      field(FieldIn(scene, path)),
      direction(scene),
      along(FieldIn(direction, path)) {
  VisitNumbers(direction, [](const NumberPath& /*at*/, double& value, NumberRule /*rule*/) { value = 0.0; });
}

ExactDerivatives::ExactDerivatives(const Scene& form, const DerivativePaths& paths) {
  const std::vector<std::string> known = AllDerivativePaths(form).of;
  for (const std::string& of : paths.of) {
    places_.push_back(static_cast<size_t>(std::find(known.begin(), known.end(), of) - known.begin()));
  }
  for (const std::string& by : paths.by) numbers_.emplace_back(form, by);
}

const SceneContact& ExactDerivatives::ContactOf(const Side& side) const {
  return side.own_contact.has_value() ? *side.own_contact : *here_;
}

const PlanarReduction& ExactDerivatives::ReductionOf(const Side& side) const {
  return std::get<PlanarReduction>(ContactOf(side).reduction);
}

void ExactDerivatives::AddImpact(const Number& number, const ContactTangents& tangents_here, Side& side) {
  const Side& below = number.below;  // It is set before the side above.
  if (side.own_contact.has_value()) {
    side.contact_tangent = ContactTangents(number.scene, *side.own_contact).Along(number.direction);
  } else if (&side != &below && below.exists && below.contact_tangent.is_linear) {
    side.contact_tangent = -below.contact_tangent;
  } else {
    side.contact_tangent = tangents_here.Along(number.direction);
  }
  const ContactTangent& d = side.contact_tangent;
  side.impact = impacts_.size();
  impacts_.push_back({.problem = ProblemOf(number.scene, ContactOf(side)),
                      .direction = {.w = d.w,
                                    .u0 = d.u0,
                                    .v0 = d.v0,
                                    .mu = d.kinetic_friction,
                                    .mu_static = d.static_friction,
                                    .coefficient = d.restitution}});
  side.exists = StaysInDomain(side);
}

void ExactDerivatives::Compute(const Scene& scene) {
  impacts_.clear();
  here_.emplace(scene);
  const planar::Problem problem = ProblemOf(scene, *here_);
  speed_here_ = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const planar::Impact impact = planar::Solve(problem);
  has_end_ = HasEnd(impact.regime);
  values_here_ = planar::NumbersOf(impact, 0.0);
  const ContactTangents tangents_here(scene, *here_);
  for (Number& number : numbers_) {
    if (number.is_stated) {
      number.scene = scene;  // Its numbers stay in their places, to which `field` points.
    } else {
      number.scene = Stating(number.path, scene);
      number.field = FieldIn(number.scene, number.path);
    }
    SetSide(number, tangents_here, -1.0, number.below);
    SetSide(number, tangents_here, 1.0, number.above);
  }
  planar::SetTangents(absl::MakeSpan(impacts_));
}

// True unless a coefficient of 0 becomes negative on this side, which rounding may hide beside a number that is 0.
bool ExactDerivatives::StaysInDomain(const Side& side) const {
  const auto& [kinetic, at_rest, restitution] = ContactOf(side).coefficients;
  const ContactTangent& d = side.contact_tangent;
  const auto stays = [](double coefficient, double rate) { return coefficient != 0.0 || rate >= 0.0; };
  return stays(kinetic, d.kinetic_friction) && stays(at_rest, d.static_friction) &&
         stays(restitution.value_or(0.0), d.restitution);
}

void ExactDerivatives::SetSide(Number& number, const ContactTangents& tangents_here, double sign, Side& side) {
  side.exists = true;
  side.step = sign;
  side.own_contact.reset();
  if (number.path == kPhi) {
    // Here a = R sin phi and b = R cos phi. If one of them is 0, its sides lie at the distance kBeside.
    auto& pendulum = std::get<Pendulum>(number.scene.system);
    const Pendulum here = pendulum;
    const bool is_upright = here.a_m == 0.0 || here.b_m == 0.0;
    if (is_upright) side.step *= kBeside;
    auto& change = std::get<Pendulum>(number.direction.system);
    change.a_m = side.step * here.b_m;
    change.b_m = -side.step * here.a_m;
    if (is_upright) {
      pendulum.a_m += change.a_m;
      pendulum.b_m += change.b_m;
      side.exists = Validate(number.scene).empty();
      if (side.exists) side.own_contact.emplace(number.scene);
    }
    if (side.exists) AddImpact(number, tangents_here, side);
    pendulum = here;
    return;
  }
  const double value = number.field.value();
  const double size = value == 0.0 ? kBeside : std::fabs(value);
  side.step *= size;
  side.exists =
      number.field.Set(value == 0.0 ? side.step : value + sign * 0x1p-50 * size) && Validate(number.scene).empty();
  if (value != 0.0) number.field.Set(value);
  if (side.exists) {
    if (value == 0.0 || !number.is_stated) side.own_contact.emplace(number.scene);
    number.along.Set(side.step);
    AddImpact(number, tangents_here, side);
  }
  number.field.Set(value);
}

bool ExactDerivatives::LosesRank(const Side& side) const {
  if (!side.exists) return false;
  const planar::Tangent& tangent = impacts_[side.impact].tangent;
  const ContactTangent& d = side.contact_tangent;
  const bool moves_w = d.w.tt != 0.0 || d.w.tn != 0.0 || d.w.nn != 0.0;
  return tangent.branch.approaches && (tangent.leaves_range || (tangent.w_rank == 1 && moves_w && !d.keeps_rank_one));
}

// The derivative of ValueAt by the number.
double ExactDerivatives::RateOf(const Side& side, size_t place) const {
  const planar::Tangent& tangent = impacts_[side.impact].tangent;
  if (place < kOutputs) return tangent.rate[place] / side.step;
  const double* const x = LinearNumberAt<2>(place - kOutputs, ReductionOf(side)).of_impulse;
  const auto [d_before, d_x] = LinearNumberAt<2>(place - kOutputs, side.contact_tangent);
  const size_t f = PlaceOf(PlanarOutput::kTangentialImpulse);
  const size_t tau = PlaceOf(PlanarOutput::kNormalImpulse);
  const double rate = d_before + d_x[0] * tangent.value[f] + d_x[1] * tangent.value[tau] + x[0] * tangent.rate[f] +
                      x[1] * tangent.rate[tau];
  return rate / side.step;
}

double ExactDerivatives::SizeOf(size_t place) const {
  const double impulse = values_here_[PlaceOf(PlanarOutput::kNormalImpulse)];
  if (place < kOutputs) return ScaleOf(kPlanarOutputPaths[place], speed_here_, impulse);
  return LinearScaleOf(std::get<PlanarReduction>(here_->reduction), place - kOutputs, impulse);
}

// True if the side lies beside a number that is 0.
bool ExactDerivatives::IsMoved(const Side& side) { return std::fabs(side.step) == kBeside; }

OneSided ExactDerivatives::LimitOf(const Side& side, size_t place) const {
  constexpr OneSided kNoEnd = {.why_none = "no end of the impact is known"};
  if (!has_end_) return kNoEnd;
  if (!side.exists) return {.why_none = "the scene would break a rule"};
  if (!HasEnd(impacts_[side.impact].tangent.branch.regime)) return kNoEnd;
  if (LosesRank(side)) {
    return {.why_none = "the rank of W, or whether the velocity lies in its range, changes at once"};
  }
  const double value = ValueAt(place, ReductionOf(side), impacts_[side.impact].tangent.value);
  const double rate = RateOf(side, place);
  if (!std::isfinite(value) || !std::isfinite(rate)) {
    return {.why_none = "the number jumps or changes infinitely fast"};
  }
  if (Jumps(side, place, value, rate)) return {.why_none = "the number jumps"};
  if (place >= kOutputs && HidesInItsImpulse(side, place, value))
    return {.why_none = "the impulse grows without bound"};
  return {.rate = rate + 0.0};
}

// If very large impulses cancel, only rounding is left of them.
bool ExactDerivatives::HidesInItsImpulse(const Side& side, size_t place, double value) const {
  constexpr double kMost = 0x1p10;
  const double* const x = LinearNumberAt<2>(place - kOutputs, ReductionOf(side)).of_impulse;
  const auto& of_impact = impacts_[side.impact].tangent.value;
  const double most = kMost * std::max(std::fabs(value), SizeOf(place));
  return std::fabs(x[0] * of_impact[PlaceOf(PlanarOutput::kTangentialImpulse)]) > most ||
         std::fabs(x[1] * of_impact[PlaceOf(PlanarOutput::kNormalImpulse)]) > most;
}

bool ExactDerivatives::Jumps(const Side& side, size_t place, double value, double rate) const {
  const double here = ValueAt(place, std::get<PlanarReduction>(here_->reduction), values_here_);
  const double size = std::max({std::fabs(here), std::fabs(value), SizeOf(place)});
  // A number that depends on one which is moved beside 0 moves with it, linearly or with a power of it; one that grows
  // without bound as that falls to 0 moves against its own slope.
  const double moved = IsMoved(side) ? rate * side.step : 0.0;
  return !(std::fabs(value - here - moved) <= std::max(0x1p-30 * size, std::fabs(moved)));
}

Threshold ExactDerivatives::ThresholdOf(const Number& number) const {
  const Side& below = number.below;
  const Side& above = number.above;
  if (LosesRank(below) || LosesRank(above)) return Threshold::kRank;
  if (!below.exists || !above.exists) return Threshold::kDomain;
  const planar::Branch& x = impacts_[below.impact].tangent.branch;
  const planar::Branch& y = impacts_[above.impact].tangent.branch;
  if (x.approaches != y.approaches) return Threshold::kApproach;
  if (x.slip_before != y.slip_before) return Threshold::kSlipStart;
  if (x.held != y.held) return Threshold::kJamming;
  if (x.stops && y.stops && x.sticks != y.sticks) return Threshold::kFrictionLimit;
  if (x.stops_in_compression != y.stops_in_compression) return Threshold::kCompressionEnd;
  if (x.stops_in_restitution != y.stops_in_restitution) return Threshold::kImpactEnd;
  return below.contact_tangent.is_at_speed_of_table ? Threshold::kSpeedTable : Threshold::kUnspecified;
}

double ExactDerivatives::LargestRate(const Number& number) const {
  double largest = 0.0;
  const auto& reduction = std::get<PlanarReduction>(here_->reduction);
  const size_t linear = reduction.before.size() + reduction.momentum.size() / 2;
  for (size_t place = 0; place < kOutputs + linear; ++place) {
    const double rate = LargestRate(number, place) / SizeOf(place);
    if (std::isfinite(rate)) largest = std::max(largest, rate);
  }
  return largest;
}

double ExactDerivatives::LargestRate(const Number& number, size_t place) const {
  double largest = 0.0;
  for (const Side* const side : {&number.below, &number.above}) {
    if (!side->exists) continue;
    const double value = ValueAt(place, ReductionOf(*side), impacts_[side->impact].tangent.value);
    const double rate = RateOf(*side, place);
    // The slope of a number that jumps beside 0 is only rounding divided by the distance from 0.
    if (!Jumps(*side, place, value, rate)) largest = std::max(largest, std::fabs(rate));
  }
  return largest;
}

Derivative ExactDerivatives::At(size_t of, size_t by) const {
  const Number& number = numbers_[by];
  OneSided below = LimitOf(number.below, places_[of]);
  OneSided above = LimitOf(number.above, places_[of]);
  const bool both = below.rate.has_value() && above.rate.has_value();
  bool agree =
      both && std::fabs(*below.rate - *above.rate) <= kRounding * (std::fabs(*below.rate) + std::fabs(*above.rate));
  Threshold threshold = agree || !has_end_ ? Threshold::kUnspecified : ThresholdOf(number);
  if (both && !agree) {
    const bool has_one_course = threshold == Threshold::kUnspecified || threshold == Threshold::kSpeedTable;
    double slight = IsMoved(number.above) ? kSlight : 0.0;
    if (!IsMoved(number.above) && has_one_course) slight = kUnseen / std::fabs(number.above.step);
    const double least = SizeOf(places_[of]) * std::max(slight, kNegligible * LargestRate(number));
    agree = std::fabs(*below.rate - *above.rate) <= least;
    if (agree) {
      below.rate = above.rate = 0.5 * (*below.rate + *above.rate);
      threshold = Threshold::kUnspecified;
    }
  }
  return Join(below, above, agree, threshold);
}

std::optional<double> ExactDerivatives::ErrorOf(size_t of, size_t by) const {
  constexpr double kOfRounding = 1e-14;
  constexpr double kLeast = 1e-10;
  const auto& [tt, tn, nn] = std::get<PlanarReduction>(here_->reduction).w;
  const PlanarDelassus w = {tt, tn, nn};
  const double amplification =
      (1.0 + here_->coefficients.kinetic_friction * std::fabs(tn) / nn) / w.RelativeDeterminant();
  const double lost = kOfRounding * amplification * amplification;
  if (w.Rank() == 1 || !(lost > kLeast)) return std::nullopt;
  const Number& number = numbers_[by];
  return lost * std::max(LargestRate(number, places_[of]), SizeOf(places_[of]) * LargestRate(number));
}

std::vector<Derivative> ExactDerivativesOf(const Scene& scene, const DerivativePaths& paths) {
  ExactDerivatives exact(scene, paths);
  exact.Compute(scene);
  std::vector<Derivative> derivatives;
  for (size_t of = 0; of < paths.of.size(); ++of) {
    for (size_t by = 0; by < paths.by.size(); ++by) {
      derivatives.push_back(exact.At(of, by));
      if (derivatives.back().kind != DerivativeKind::kNone) derivatives.back().error = exact.ErrorOf(of, by);
      derivatives.back().of = paths.of[of];
      derivatives.back().by = paths.by[by];
    }
  }
  return derivatives;
}

}  // namespace ricochet
