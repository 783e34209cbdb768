// The price of several contacts: the median time of each way to answer a random scene in a plane, beside one contact.

#include <Eigen/Core>
#include <cstdio>
#include <random>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"
#include "tests/support/scenes/random_multi_contact.h"

namespace ricochet::bench {
namespace {

using Method = MultiContactMethod;

constexpr int kRounds = 11;
constexpr size_t kScenes = 200;

MultiContactRequest RequestOf(const multi::Problem& problem) {
  MultiContactRequest request;
  const Eigen::MatrixXd w = problem.w.transpose();
  request.scene.system = ContactMatrix{.w_per_kg = {w.data(), w.data() + w.size()},
                                       .velocity_m_s = {problem.v.data(), problem.v.data() + problem.v.size()}};
  for (const multi::ContactLaw& law : problem.laws) {
    request.scene.contacts.push_back({.friction = law.mu, .energetic = law.e, .relative_stiffness = law.stiffness});
  }
  return request;
}

std::vector<MultiContactRequest> Requests(int contacts) {
  std::mt19937_64 random(1);
  std::vector<MultiContactRequest> requests;
  while (requests.size() < kScenes) {
    const multi::Problem problem = multi::RandomMultiContact(random, true);
    if (problem.k == contacts) requests.push_back(RequestOf(problem));
  }
  return requests;
}

void SolveOne() {
  SolveRequest request;
  request.scene.system = PlanarContact{2.5, 1.5, 2.5, -1.0, -1.0};
  request.scene.friction.kinetic_coefficient = 0.7;
  request.scene.restitution = EnergeticCoefficient{0.8};
  DoNotOptimize(LocalSolver().Solve(request)->outcome.impulse.normal_total_n_s);
}

// The median over the scenes of each one's median over the rounds.
void Measure(int contacts, const char* what, const std::vector<Method>& methods, double goal_us) {
  constexpr int kSingle = 100;  // One contact is timed so many times at once.
  std::vector<double> times, singles;
  const LocalSolver solver;
  for (MultiContactRequest& request : Requests(contacts)) {
    request.methods = methods;
    const Comparison time = Compare(
        kRounds, [&] { DoNotOptimize(solver.MultiContact(request)->answers.front().energy_before_j); },
        [] {
          for (int i = 0; i < kSingle; ++i) SolveOne();
        });
    times.push_back(time.seconds_a * 1e6);
    singles.push_back(time.seconds_b * 1e6 / kSingle);
  }
  Print(absl::StrFormat("%d contacts, %s", contacts, what), absl::StrFormat("%.1f us", Median(times)),
        absl::StrFormat("goal %g us; 90 %% below %.1f us; %.0f x a Solve of one contact", goal_us, Quantile(times, 0.9),
                        Median(times) / Median(singles)));
}

void RunAll() {
  std::printf("Several contacts in a plane, one request, median of %zu random scenes\n", kScenes);
  for (const int contacts : {2, 4}) {
    const double more = contacts == 2 ? 1.0 : 100.0;
    Measure(contacts, "orders and verdict", {Method::kOrders}, 10.0 * more);
    Measure(contacts, "springs", {Method::kSprings}, 100.0 * more);
    Measure(contacts, "all bounds of what is possible", {Method::kPossible}, 200.0 * more);
  }
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
