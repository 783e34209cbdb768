// The methods of a rigid pendulum: frictionless, first order, and the closed form in plain and compensated arithmetic.

#include <array>
#include <memory>
#include <vector>

#include "core/cost/cost_kernel.h"
#include "core/cost/methods_by_model.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/first_order.h"

namespace ricochet {
namespace {

using pendulum::Output;
using pendulum::Problem;

// "Each output is within 1 ulp of its exact value" (core/models/pendulum/pendulum.h).
constexpr double kUlp = 0x1p-52;
// The rounding of the first-order forms, over the coefficient (core/models/pendulum/first_order.h).
constexpr double kFirstOrderRounding = 0x1p-50;
// Any bound is within this tolerance, so that lanes give up plain arithmetic only where it proves nothing.
constexpr double kLoosest = 0.5;

Velocity3 VelocityOf(const pendulum::Impact& impact) {
  return {impact[Output::kTangentialVelocityAfter], 0.0, impact[Output::kNormalVelocityAfter]};
}

// The kernel of the problem without the effects that the choice leaves out, answered by the forms of first order.
Kernel FormsKernel(const Problem& problem, double claimed) {
  const auto solve = [](const Problem& of, Stopped) { return first_order::Solve(of); };
  const auto read = [claimed](const Problem&, const pendulum::Impact& impact) {
    return KernelAnswer{.velocity = VelocityOf(impact), .claimed = claimed};
  };
  return MakeKernel(problem, solve, read);
}

// All outputs of kCostBatch problems, solved in SIMD lanes.
class Lanes {
 public:
  Lanes(const Problem& problem, double tolerance) : tolerance_(tolerance), problems_(problem.law, kCostBatch) {
    for (size_t i = 0; i < problems_.size(); ++i) {
      problems_.Set(i, Scaled(problem, BatchFactor(static_cast<int64_t>(i))));
    }
    for (size_t c = 0; c < outputs_.size(); ++c) {
      outputs_[c] = static_cast<Output>(c);
      values_[c].resize(problems_.size());
    }
  }

  void Solve(size_t first, size_t count) {
    std::array<double*, pendulum::kOutputCount> columns = {};
    for (size_t c = 0; c < columns.size(); ++c) columns[c] = values_[c].data();
    pendulum::SolveColumns(problems_, first, count, tolerance_,
                           {.outputs = outputs_,
                            .columns = columns,
                            .regimes = absl::MakeSpan(regimes_).first(count),
                            .inadmissible = absl::MakeSpan(inadmissible_).first(count)});
    DoNotOptimize(values_);
  }

 private:
  double tolerance_;
  pendulum::ProblemColumns problems_;
  std::array<Output, pendulum::kOutputCount> outputs_ = {};
  std::array<std::vector<double>, pendulum::kOutputCount> values_;
  std::array<Regime, kCostBatch> regimes_ = {};
  std::array<bool, kCostBatch> inadmissible_ = {};
};

void SolveInLanes(const Problem& problem, double tolerance, Kernel& kernel) {
  kernel.in_lanes = true;
  kernel.make_batch = [problem, tolerance] {
    auto lanes = std::make_shared<Lanes>(problem, tolerance);
    return [lanes](int64_t first, int64_t count, Stopped) {
      lanes->Solve(static_cast<size_t>(first), static_cast<size_t>(count));
    };
  };
}

Kernel PlainKernel(const Problem& problem) {
  const auto solve = [](const Problem& of, Stopped) { return pendulum::SolvePlain(of); };
  const auto read = [](const Problem&, const pendulum::PlainImpact& plain) {
    if (!plain.proved) return KernelAnswer{.failure = kNotProved};
    return KernelAnswer{.velocity = VelocityOf(plain.impact), .claimed = plain.relative_error};
  };
  Kernel kernel = MakeKernel(problem, solve, read);
  SolveInLanes(problem, kLoosest, kernel);
  return kernel;
}

Kernel CompensatedKernel(const Problem& problem) {
  const auto solve = [](const Problem& of, Stopped) { return pendulum::Solve(of); };
  const auto read = [](const Problem&, const pendulum::Impact& impact) {
    const bool separates = impact.regime == Regime::kSeparating;
    return KernelAnswer{.velocity = VelocityOf(impact), .claimed = separates ? 0.0 : kUlp * impact[Output::kNewton]};
  };
  Kernel kernel = MakeKernel(problem, solve, read);
  SolveInLanes(problem, 0.0, kernel);
  return kernel;
}

void AddForms(const Problem& problem, const ContactPhysics& physics, Methods& methods) {
  const Choice frictionless = ChoosePendulum(problem, physics, DemandFor(Model::kFrictionless));
  if (frictionless.model == Model::kFrictionless) {
    const Problem smooth = Without(frictionless, problem);
    methods.push_back({.name = "frictionless",
                       .method = {.model = Model::kFrictionless, .arithmetic = Arithmetic::kPlain},
                       .kernel = FormsKernel(smooth, first_order::ErrorsOf(smooth).velocity),
                       .claimed_modelling = frictionless.neglected,
                       .exact = MakeReference([smooth](Stopped) { return ExactFrictionless(smooth); })});
  }
  const Choice first_order = ChoosePendulum(problem, physics, DemandFor(Model::kFirstOrder));
  if (first_order.model == Model::kFirstOrder) {
    const Problem rubbing = Without(first_order, problem);
    methods.push_back({.name = "first order",
                       .method = {.model = Model::kFirstOrder, .arithmetic = Arithmetic::kPlain},
                       .kernel = FormsKernel(rubbing, kFirstOrderRounding * rubbing.coefficient),
                       .claimed_modelling = first_order.neglected,
                       .exact = MakeReference([rubbing](Stopped) { return ExactFirstOrder(rubbing); })});
  }
}

}  // namespace

void AddClosedForms(const Problem& problem, const ContactPhysics& physics, const ReferencePointer& exact,
                    Methods& methods) {
  if (problem.omega_minus < 0.0) AddForms(problem, physics, methods);
  const double neglected = NeglectedBy(Model::kPendulum, problem, physics);
  for (const Arithmetic arithmetic : {Arithmetic::kPlain, Arithmetic::kCompensated}) {
    methods.push_back({.name = "closed form, " + NameOf(arithmetic),
                       .method = {.model = Model::kPendulum, .arithmetic = arithmetic},
                       .kernel = arithmetic == Arithmetic::kPlain ? PlainKernel(problem) : CompensatedKernel(problem),
                       .claimed_modelling = neglected,
                       .exact = exact});
  }
}

double NeglectedBy(Model model, const Problem& problem, const ContactPhysics& physics) {
  if (!(problem.omega_minus < 0.0)) return 0.0;
  const Choice choice = ChoosePendulum(problem, physics, DemandFor(model));
  return choice.model == Model::kUnspecified ? kNotKnown : choice.neglected;
}

}  // namespace ricochet
