// Kernel: one method of a study of cost, ready to be run: the model's function and its problem, behind a common face.
//
// A kernel calls the model itself. Planning, reduction and the making of an outcome are not part of it, because all
// methods share them.

#ifndef RICOCHET_CORE_COST_COST_KERNEL_H_
#define RICOCHET_CORE_COST_COST_KERNEL_H_

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/functional/function_ref.h"
#include "ricochet/cost.h"
#include "ricochet/scene.h"

namespace ricochet {

// The contact velocity along t1, t2 and n, m/s. In a plane the second is 0.
using Velocity3 = std::array<double, 3>;

// The part of a model's answer that a study reads.
struct KernelAnswer {
  Velocity3 velocity = {};
  double claimed = 0.0;    // The model's own numerical error over V, as a bound or an estimate.
  double modelling = 0.0;  // The error that effects left out cause, as the answer states it, over V.
  // The numerical error over V, if the answer has more digits than doubles can tell.
  std::optional<double> numerical_error;
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
  std::string note;      // One sentence about the answer; may be empty.
  std::string failure;   // One sentence that says why there is no answer; empty if there is one.
  bool stopped = false;  // The caller stopped the solve, and the other members have no meaning.
};

using Stopped = absl::FunctionRef<bool()>;

struct Kernel {
  std::function<KernelAnswer(Stopped)> answer;
  // Solves the problem so many times.
  std::function<void(int64_t times, Stopped)> repeat;
  // Makes kCostBatch problems whose velocities differ by up to 0.1 %. The function that it gives solves a part of them.
  std::function<std::function<void(int64_t first, int64_t count, Stopped)>()> make_batch;
  bool in_lanes = false;  // The batch is solved in SIMD lanes.
};

// Makes the compiler believe that `value` is read, so that computing it cannot be left out.
template <typename T>
void DoNotOptimize(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

// The factor of the velocity before impact number i of a batch, in (0.999, 1], so that no velocity exceeds the largest
// double.
inline double BatchFactor(int64_t i) { return 1.0 - 1e-3 * static_cast<double>(i) / static_cast<double>(kCostBatch); }

// Any model's problem with its velocities before the impact multiplied, so that a batch has problems that differ.
template <typename Problem>
Problem Scaled(Problem problem, double factor) {
  if constexpr (requires { problem.contact; }) {
    problem.contact = Scaled(problem.contact, factor);
  } else if constexpr (requires { problem.omega_minus; }) {
    problem.omega_minus *= factor;
  } else {
    if constexpr (requires { problem.u0 *= factor; }) {
      problem.u0 *= factor;
    } else {
      for (double& u : problem.u0) u *= factor;
    }
    problem.v0 *= factor;
  }
  return problem;
}

// A scene that can be certified: that of a pendulum or of a planar contact.
template <>
inline Scene Scaled(Scene scene, double factor) {
  if (auto* pendulum = std::get_if<Pendulum>(&scene.system)) pendulum->omega_minus_rad_s *= factor;
  if (auto* contact = std::get_if<PlanarContact>(&scene.system)) {
    contact->tangential_m_s *= factor;
    contact->normal_m_s *= factor;
  }
  return scene;
}

// `solve(problem, stopped)` gives the model's result, `read(problem, result)` a KernelAnswer.
template <typename Problem, typename Solve, typename Read>
Kernel MakeKernel(Problem problem, Solve solve, Read read) {
  Kernel kernel;
  kernel.answer = [=](Stopped stopped) { return read(problem, solve(problem, stopped)); };
  kernel.repeat = [=](int64_t times, Stopped stopped) {
    for (int64_t i = 0; i < times; ++i) DoNotOptimize(solve(problem, stopped));
  };
  kernel.make_batch = [=] {
    auto problems = std::make_shared<std::vector<Problem>>();
    for (int64_t i = 0; i < kCostBatch; ++i) problems->push_back(Scaled(problem, BatchFactor(i)));
    return [=](int64_t first, int64_t count, Stopped stopped) {
      for (int64_t i = first; i < first + count; ++i)
        DoNotOptimize(solve((*problems)[static_cast<size_t>(i)], stopped));
    };
  };
  return kernel;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_COST_KERNEL_H_
