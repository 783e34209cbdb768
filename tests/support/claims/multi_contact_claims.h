// Holds what orders, springs and the possible outcomes of several contacts claim against an oracle of 128 bits on
// random planar scenes of two to four contacts.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_MULTI_CONTACT_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_MULTI_CONTACT_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/multi/energy.h"
#include "core/multi/mirror.h"
#include "core/multi/orders.h"
#include "core/multi/possible.h"
#include "core/multi/springs.h"
#include "tests/support/claims/claims.h"
#include "tests/support/oracles/multi_contact_oracle.h"
#include "tests/support/scenes/random_multi_contact.h"

namespace ricochet::multi {

struct MultiContactClaims {
  ClaimTally orders;    // Errors of the velocities of every outcome of orders.
  ClaimTally missing;   // How far every exact sequence is from the nearest outcome, which may stand for several.
  ClaimTally springs;   // Errors of the velocities of springs.
  ClaimTally possible;  // How far exact outcomes of both are outside their ranges.
  ClaimTally energy;    // By how much energy rises, and works do not add up to its change.
  int skipped = 0;      // Sequences that the oracle did not follow to their end.
};

namespace claims {

inline double Rounding(double x) { return 0x1p-52 * std::abs(x); }

// The largest error of a velocity over its claim, and that error.
struct Worst {
  double claimed = 0.0, achieved = 0.0;
};
inline Worst WorstOf(const Problem& problem, const Attained& found, const ExactOutcome& exact) {
  Worst worst;
  double ratio = -1.0;
  for (int j = 0; j < found.v.size(); ++j) {
    const double expected = exact.v[static_cast<size_t>(j)];
    const double claimed = found.ErrorOf(problem, j) + Rounding(expected);
    const double achieved = std::abs(found.v(j) - expected);
    if (claimed == 0.0 && achieved == 0.0) continue;
    if (achieved / claimed > ratio) ratio = achieved / claimed, worst = {claimed, achieved};
  }
  return worst;
}

template <typename List, typename OutcomeOf>
Worst NearestOf(const List& list, const OutcomeOf& worst_of) {
  Worst nearest = {.claimed = 0.0, .achieved = std::numeric_limits<double>::infinity()};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& one : list) {
    const Worst worst = worst_of(one);
    const double ratio = worst.achieved == 0.0 ? 0.0 : worst.achieved / worst.claimed;
    if (ratio < least) least = ratio, nearest = worst;
  }
  return nearest;
}

inline void AddEnergy(const Problem& problem, const Attained& attained, const std::string& scene, ClaimTally& tally) {
  double change = 0.0, works = 0.0;
  for (int j = 0; j < attained.p.size(); ++j) change += 0.5 * attained.p(j) * (problem.v(j) + attained.v(j));
  for (int i = 0; i < problem.k; ++i) {
    const ContactWorks& own = attained.works[static_cast<size_t>(i)];
    const double e = problem.laws[static_cast<size_t>(i)].e;
    works += own.compression + own.restitution + own.friction;
    tally.Add(attained.work_error + 1e-15, std::abs(own.restitution + e * e * own.compression), scene);
  }
  tally.Add(attained.work_error + 1e-15, std::max(change, 0.0), scene);
  tally.Add(3.0 * attained.work_error + 1e-14, std::abs(works - change), scene);
}

inline bool IsAttained(MultiContactEnd end) {
  return end == MultiContactEnd::kSeparated || end == MultiContactEnd::kEndless ||
         end == MultiContactEnd::kEndlessEstimate;
}

}  // namespace claims

inline void AddClaims(const Problem& problem, bool has_springs, const std::string& scene, MultiContactClaims& tallies) {
  using claims::Worst;
  const auto never = [] { return false; };
  const EnergyMetric metric = MetricOf(problem);
  const Eigen::VectorXd apart = PushApart(problem, metric);
  std::vector<Eigen::VectorXd> gammas;
  for (int j = 0; j < problem.v.size(); ++j) gammas.emplace_back(Eigen::VectorXd::Unit(problem.v.size(), j));
  const std::vector<Range> ranges = FindPossible(problem, metric, apart, gammas, never);
  const auto add_inside = [&](const ExactOutcome& exact) {
    for (size_t j = 0; j < ranges.size(); ++j) {
      const double outside = std::max({0.0, exact.v[j] - ranges[j].upper, ranges[j].lower - exact.v[j]});
      tallies.possible.Add(claims::Rounding(exact.v[j]), outside, scene);
    }
  };
  const Orders orders = FindOrders(problem, never);
  for (const DistinctOutcome& one : orders.outcomes) {
    claims::AddEnergy(problem, one.attained, scene, tallies.energy);
  }
  const auto exact = OrdersExactly(problem, 1500);
  tallies.skipped += exact.has_value() && orders.complete ? 0 : 1;
  if (exact.has_value() && orders.complete) {
    for (const DistinctOutcome& one : orders.outcomes) {
      const Worst worst = claims::NearestOf(
          *exact, [&](const ExactOutcome& other) { return claims::WorstOf(problem, one.attained, other); });
      tallies.orders.Add(worst.claimed, worst.achieved, scene);
    }
    for (const ExactOutcome& one : *exact) {
      add_inside(one);
      const Worst worst = claims::NearestOf(
          orders.outcomes, [&](const DistinctOutcome& other) { return claims::WorstOf(problem, other.attained, one); });
      tallies.missing.Add(4.0 * worst.claimed, worst.achieved, scene);
    }
  }
  if (!has_springs) return;
  const SortedProblem sorted = Sort(problem);
  const Attained springs = FindSprings(sorted.problem, sorted.mirror, never);
  const auto exact_springs = SpringsExactly(sorted.problem, 400);
  if (!exact_springs.has_value() || apart.size() == 0) {
    ++tallies.skipped;
    return;
  }
  const Worst worst = claims::WorstOf(sorted.problem, springs, *exact_springs);
  tallies.springs.Add(worst.claimed, claims::IsAttained(springs.end) ? worst.achieved : 1.0, scene);
  claims::AddEnergy(sorted.problem, springs, scene, tallies.energy);
  ExactOutcome in_scene = *exact_springs;
  Vector v(problem.v.size());
  for (int j = 0; j < v.size(); ++j) v(j) = in_scene.v[static_cast<size_t>(j)];
  v = sorted.InScene(v);
  in_scene.v.assign(v.begin(), v.end());
  add_inside(in_scene);
}

// Every other scene has springs.
inline MultiContactClaims MultiContactClaimsOf(int count, uint64_t seed) {
  MultiContactClaims tallies;
  for (int scene = 0; scene < count; ++scene) {
    std::mt19937_64 random(seed + static_cast<uint64_t>(scene));
    const bool springs = scene % 2 == 1;
    AddClaims(RandomMultiContact(random, springs), springs,
              "seed " + std::to_string(seed) + " + " + std::to_string(scene), tallies);
  }
  return tallies;
}

}  // namespace ricochet::multi

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_MULTI_CONTACT_CLAIMS_H_
