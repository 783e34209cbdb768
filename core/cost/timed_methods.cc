// The model of finite duration at four tolerances, and at three stiffnesses where the stiffness changes the impulses.

#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/cost/methods_by_model.h"
#include "core/models/finite_duration/finite_duration.h"

namespace ricochet {
namespace {

using finite_duration::Problem;

constexpr double kTolerances[] = {1e-3, 1e-6, 1e-9, 1e-12};
constexpr double kLeastTolerance = 1e-12;

struct Stiffened {
  double factor;
  NormalSpring operator()(std::monostate none) const { return none; }
  NormalSpring operator()(LinearSpring spring) const { return LinearSpring{factor * spring.stiffness_n_m}; }
  NormalSpring operator()(HertzSpring spring) const { return HertzSpring{factor * spring.stiffness_n_m1_5}; }
  NormalSpring operator()(HuntCrossleySpring spring) const {
    spring.stiffness_n_m_p *= factor;
    return spring;
  }
};

// A linear spring with which an elastic impact without friction lasts one to three times as long: k is the power of ten
// below (pi/T)^2/Wnn, and infinite where that exceeds the largest double.
NormalSpring SpringOfDuration(double seconds, double wnn) {
  const double rate = std::numbers::pi / seconds;
  const double most = rate * rate / wnn;
  if (std::isinf(most)) return LinearSpring{most};
  double stiffness = 1.0;
  while (stiffness * 10.0 <= most) stiffness *= 10.0;
  while (stiffness > most) stiffness *= 0.1;
  return LinearSpring{stiffness};
}

// The springs to be tried, the scene's own among them: those whose stiffness is a double. One is enough if the
// stiffness changes nothing but the scale of time.
std::vector<NormalSpring> SpringsFor(const NormalSpring& own, double wnn, bool one_is_enough) {
  const bool stated = !std::holds_alternative<std::monostate>(own);
  std::vector<NormalSpring> springs = {stated ? own : SpringOfDuration(1e-3, wnn)};
  if (!one_is_enough) {
    springs.insert(springs.begin(), stated ? std::visit(Stiffened{0.01}, own) : SpringOfDuration(1e-2, wnn));
    springs.push_back(stated ? std::visit(Stiffened{100.0}, own) : SpringOfDuration(1e-4, wnn));
  }
  std::erase_if(springs, [](const NormalSpring& spring) {
    const double stiffness = StiffnessOf(spring);
    return stiffness == 0.0 || std::isinf(stiffness);
  });
  return springs;
}

std::string WhyNone(const finite_duration::Impact& impact) {
  return impact.termination == Termination::kBudgetUsedUp ? "The impact did not end within its budget of steps."
                                                          : "The impact in time was given up before its end.";
}

Kernel TimedKernel(const Problem& problem) {
  const auto solve = [](const Problem& of, Stopped stopped) { return finite_duration::Solve(of, stopped); };
  const auto read = [](const Problem&, const finite_duration::Impact& impact) {
    if (impact.stopped) return KernelAnswer{.stopped = true};
    if (!impact.Converged()) return KernelAnswer{.failure = WhyNone(impact)};
    return KernelAnswer{.velocity = {impact.u1, 0.0, impact.v1},
                        .claimed = impact.error_estimate,
                        .steps = impact.steps,
                        .right_hand_sides = impact.right_hand_sides};
  };
  return MakeKernel(problem, solve, read);
}

ReferenceVelocity AtLeastTolerance(Problem problem, Stopped stopped) {
  problem.tolerance = kLeastTolerance;
  const finite_duration::Impact impact = finite_duration::Solve(problem, stopped);
  const bool known = !impact.stopped && impact.Converged();
  return ReferenceAt({impact.u1, 0.0, impact.v1}, known ? impact.error_estimate : kNotKnown,
                     "the model of finite duration at a tolerance of 1e-12, with the error that it estimates");
}

// The size of what the spring and the time that it gives to finite forces change.
double SizeOfTime(const planar::Problem& contact, ContactPhysics physics, const NormalSpring& spring) {
  physics.spring = spring;
  if (!(contact.v0 < 0.0)) return 0.0;
  const Sizes sizes = PlanarSizes(contact, physics);
  return sizes[Effect::kFiniteForces].value + sizes[Effect::kFiniteDuration].value;
}

}  // namespace

double StiffnessOf(const NormalSpring& spring) {
  struct Stiffness {
    double operator()(std::monostate) const { return 0.0; }
    double operator()(const LinearSpring& linear) const { return linear.stiffness_n_m; }
    double operator()(const HertzSpring& hertz) const { return hertz.stiffness_n_m1_5; }
    double operator()(const HuntCrossleySpring& hunt_crossley) const { return hunt_crossley.stiffness_n_m_p; }
  };
  return std::visit(Stiffness(), spring);
}

ReferencePointer AddFiniteDuration(const planar::Problem& contact, const ContactPhysics& physics,
                                   const ReferencePointer& impulses, Methods& methods) {
  const bool stated = !std::holds_alternative<std::monostate>(physics.spring);
  const double own_size = stated ? SizeOfTime(contact, physics, physics.spring) : 0.0;
  const std::vector<NormalSpring> springs = SpringsFor(physics.spring, contact.w.nn, impulses != nullptr);
  ReferencePointer own_exact;
  for (const NormalSpring& spring : springs) {
    const bool own = stated && spring == physics.spring;
    Problem problem = {.contact = contact,
                       .tangential_acceleration = physics.tangential_acceleration,
                       .normal_acceleration = physics.normal_acceleration,
                       .spring = spring};
    if (physics.ratio_squared > 0.0) problem.ratio_squared = physics.ratio_squared;
    ReferencePointer exact = impulses;
    if (exact == nullptr) {
      exact = MakeReference([problem](Stopped stopped) { return AtLeastTolerance(problem, stopped); });
    }
    if (own) own_exact = exact;
    const double stiffness = StiffnessOf(spring);
    for (const double tolerance : kTolerances) {
      problem.tolerance = tolerance;
      methods.push_back({.name = absl::StrCat("duration k=", stiffness, " ", tolerance),
                         .method = {.model = Model::kFiniteDuration,
                                    .arithmetic = Arithmetic::kPlain,
                                    .tolerance = tolerance,
                                    .stiffness = stiffness},
                         .kernel = TimedKernel(problem),
                         .claimed_modelling = own ? 0.0 : SizeOfTime(contact, physics, spring) + own_size,
                         .exact = exact});
    }
  }
  return own_exact;
}

}  // namespace ricochet
