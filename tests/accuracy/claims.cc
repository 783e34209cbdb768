// Prints the table of claims: for each method, tolerance and kind of scenes, how the errors claimed compare with the
// errors achieved. It takes the number of scenes of each row as its argument and fails if a claim is broken.
//
// Rows of coefficients, impulses and works hold each number of an outcome against its own error, on its own scale.
// docs/accuracy.md explains the columns. "unknown" counts infinite claims, "least" and "median" are of claimed over
// achieved, "goal" is what their median shall be at most, "worst" is the largest error achieved, and the last two
// columns count claims and errors above the tolerance.

#include "tests/support/claims/claims.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/claims/compliant_claims.h"
#include "tests/support/claims/finite_duration_claims.h"
#include "tests/support/claims/mechanism_claims.h"
#include "tests/support/claims/multi_contact_claims.h"
#include "tests/support/claims/pendulum_claims.h"
#include "tests/support/claims/planar_claims.h"
#include "tests/support/claims/sliding_claims.h"
#include "tests/support/claims/spatial_claims.h"
#include "tests/support/claims/spatial_number_claims.h"

namespace ricochet {
namespace {

constexpr uint64_t kSeed = 77;

// One row of the table.
struct Row {
  std::string method;
  std::string scenes;
  ClaimTally tally;
};

// The rows whose scenes are solved together. They do not depend on any other rows.
using Job = std::function<std::vector<Row>()>;
struct Jobs {
  std::string only;  // what the name of a method must contain, of those whose numbers are compared
  std::vector<Job> all;
};

// The median of claimed over achieved shall be at most this.
struct Goal {
  const char* method;
  double median;
};
constexpr Goal kGoals[] = {{"planar plain, largest", 10.0},
                           {"planar comp., largest", 10.0},
                           {"space", 5.0},
                           {"compliant", 5.0},
                           {"duration, compliant", 10.0}};

double GoalOf(const std::string& method) {
  for (const auto& [name, median] : kGoals) {
    if (method == name) return median;
  }
  return 0.0;
}

std::string TextOf(double tolerance) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.0e", tolerance);
  return text;
}

// Calls `add` for typical and for hard scenes.
template <typename Add>
void ForBothKinds(const Add& add) {
  add("typical", false);
  add("hard", true);
}

// The rows of the numbers of one method: each number is judged on its own scale.
template <typename Claims>
void AddNumbers(const std::string& method, const std::string& scenes, Jobs& jobs, const Claims& claims_of) {
  if (method.find(jobs.only) == std::string::npos) return;
  jobs.all.push_back([=] {
    const NumberClaims claims = claims_of();
    return std::vector<Row>{{method + ", u and v", scenes, claims.velocity},
                            {method + ", coefficients", scenes, claims.coefficient},
                            {method + ", impulses", scenes, claims.impulse},
                            {method + ", works", scenes, claims.work}};
  });
}

void AddNumbersOfClosedForms(int count, Jobs& jobs) {
  ForBothKinds([&](const char* scenes, bool hard) {
    AddNumbers("pendulum plain", scenes, jobs, [=] { return pendulum::NumberClaimsOf(true, hard, count, kSeed); });
    AddNumbers("pendulum comp.", scenes, jobs, [=] { return pendulum::NumberClaimsOf(false, hard, count, kSeed); });
    AddNumbers("first order", scenes, jobs, [=] { return first_order::NumberClaimsOf(true, hard, count, kSeed); });
    AddNumbers("smooth pendulum", scenes, jobs, [=] { return first_order::NumberClaimsOf(false, hard, count, kSeed); });
    for (const bool grazing : {false, true}) {
      const std::string kind = grazing ? std::string("grazing") : scenes;
      if (grazing && hard) continue;
      AddNumbers("planar plain", kind, jobs,
                 [=] { return planar::NumberClaimsOf(planar::SolvePlain, hard, grazing, count, kSeed); });
      AddNumbers("planar comp.", kind, jobs,
                 [=] { return planar::NumberClaimsOf(planar::InDoubleDouble, hard, grazing, count, kSeed); });
      for (const bool friction : {true, false}) {
        const std::string method = friction ? "sliding" : "smooth";
        AddNumbers(method + " (2D)", kind, jobs,
                   [=] { return sliding::NumberClaimsOf<1>(friction, hard, grazing, count, kSeed); });
        AddNumbers(method + " (3D)", kind, jobs,
                   [=] { return sliding::NumberClaimsOf<2>(friction, hard, grazing, count, kSeed); });
      }
    }
  });
}

// The velocities of a mechanism after the impact, and the momentum that it takes.
void AddMechanisms(int count, Jobs& jobs) {
  if (std::string("mechanism").find(jobs.only) == std::string::npos) return;
  const auto add = [&](const char* scenes, const std::string& where, bool in_space, bool hard, bool one_free) {
    jobs.all.push_back([=] {
      const int scene_count = in_space ? count / 10 : count;
      const MechanismClaims claims = MechanismClaimsOf(in_space, hard, scene_count, kSeed, one_free);
      return std::vector<Row>{{"mechanism, rates" + where, scenes, claims.rates},
                              {"mechanism, mom." + where, scenes, claims.momentum}};
    });
  };
  ForBothKinds([&](const char* scenes, bool hard) {
    add(scenes, " (2D)", /*in_space=*/false, hard, /*one_free=*/false);
    add(scenes, " (3D)", /*in_space=*/true, hard, /*one_free=*/false);
  });
  // Held coordinates count as known, and a hard M would leave one free coordinate as it is.
  add("one free", " (3D)", /*in_space=*/true, /*hard=*/false, /*one_free=*/true);
}

// Several contacts in a plane: the velocities of orders and of springs, whether a sequence is missing, how far exact
// outcomes lie outside the ranges, and the ledger of energy. Each row has a part of the scenes.
void AddSeveralContacts(int count, Jobs& jobs) {
  if (std::string("several contacts").find(jobs.only) == std::string::npos) return;
  constexpr int kParts = 4;
  for (int part = 0; part < kParts; ++part) {
    jobs.all.push_back([=] {
      const int scenes = count / kParts;
      const auto claims =
          multi::MultiContactClaimsOf(scenes, 1 + static_cast<uint64_t>(part) * static_cast<uint64_t>(scenes));
      const std::string name = "part " + std::to_string(part + 1);
      return std::vector<Row>{{"contacts, orders", name, claims.orders},
                              {"contacts, missing", name, claims.missing},
                              {"contacts, springs", name, claims.springs},
                              {"contacts, possible", name, claims.possible},
                              {"contacts, energy", name, claims.energy}};
    });
  }
}

void AddNumbersOfSpace(int count, Jobs& jobs) {
  for (const double tolerance : spatial::kClaimTolerances) {
    ForBothKinds([&](const char* scenes, bool hard) {
      AddNumbers("space " + TextOf(tolerance), scenes, jobs,
                 [=] { return spatial::NumberClaimsOf(hard, tolerance, count, kSeed); });
    });
  }
  for (const double tolerance : {1e-6, 1e-12}) {
    ForBothKinds([&](const char* scenes, bool hard) {
      AddNumbers("grazing " + TextOf(tolerance), scenes, jobs,
                 [=] { return spatial::GrazingClaimsOf(hard, tolerance, count, kSeed); });
    });
  }
}

void AddNumbersOfSprings(int count, Jobs& jobs) {
  using finite_duration::ClaimKind;
  ForBothKinds([&](const char* scenes, bool hard) {
    AddNumbers("compliant", scenes, jobs, [=] { return compliant::NumberClaimsOf(hard, count, kSeed); });
    for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
      AddNumbers("linear " + TextOf(tolerance), scenes, jobs,
                 [=] { return finite_duration::NumberClaimsOf(ClaimKind::kLinear, hard, tolerance, count, kSeed); });
      AddNumbers("Hertz " + TextOf(tolerance), scenes, jobs,
                 [=] { return finite_duration::NumberClaimsOf(ClaimKind::kHertz, hard, tolerance, count, kSeed); });
      AddNumbers("springs " + TextOf(tolerance), scenes, jobs,
                 [=] { return finite_duration::NumberClaimsOf(ClaimKind::kCompliant, hard, tolerance, count, kSeed); });
    }
  });
}

void AddPendulum(int count, Jobs& jobs) {
  ForBothKinds([&](const char* scenes, bool hard) {
    jobs.all.push_back([=] {
      return std::vector<Row>{{"pendulum, plain", scenes, pendulum::PlainClaims(hard, count, kSeed)},
                              {"pendulum, compensated", scenes, pendulum::CompensatedClaims(hard, count, kSeed)}};
    });
    jobs.all.push_back([=] {
      const first_order::Claims claims = first_order::ClaimsOf(hard, count, kSeed);
      return std::vector<Row>{{"first order, velocity", scenes, claims.velocity},
                              {"first order, impulse", scenes, claims.impulse}};
    });
  });
}

void AddPlanar(int count, Jobs& jobs) {
  using Next = planar::Problem (*)(planar::SceneSource&, int);
  const auto add = [&](const std::string& method, auto solve, const char* scenes, Next next) {
    jobs.all.push_back([=] {
      const planar::Claims claims = planar::ClaimsOf(solve, next, count, kSeed);
      return std::vector<Row>{{method + ", velocity", scenes, claims.velocity},
                              {method + ", impulse", scenes, claims.impulse},
                              {method + ", work", scenes, claims.work},
                              {method + ", largest", scenes, claims.largest}};
    });
  };
  constexpr std::pair<const char*, Next> kScenes[] = {{"typical", planar::EverydayScene}, {"hard", planar::HardScene}};
  for (const auto& [scenes, next] : kScenes) {
    add("planar plain", planar::SolvePlain, scenes, next);
    add("planar comp.", planar::InDoubleDouble, scenes, next);
  }
  add("planar comp.", planar::InDoubleDouble, "singular", planar::NearlySingularScene);
}

template <size_t kTangential>
void AddSliding(const std::string& where, int count, Jobs& jobs) {
  ForBothKinds([&](const char* scenes, bool hard) {
    for (const bool friction : {true, false}) {
      const std::string method = friction ? "sliding" : "smooth";
      jobs.all.push_back([=] {
        const sliding::Claims claims = sliding::ClaimsOf<kTangential>(friction, hard, count, kSeed);
        return std::vector<Row>{{method + ", velocity" + where, scenes, claims.velocity},
                                {method + ", impulse" + where, scenes, claims.impulse}};
      });
    }
  });
}

void AddSpatial(int count, Jobs& jobs) {
  for (const double tolerance : spatial::kClaimTolerances) {
    ForBothKinds([&](const char* scenes, bool hard) {
      jobs.all.push_back([=] {
        return std::vector<Row>{{"space", scenes, spatial::SpatialClaims(hard, tolerance, count, kSeed)}};
      });
    });
  }
}

void AddCompliant(int count, Jobs& jobs) {
  ForBothKinds([&](const char* scenes, bool hard) {
    jobs.all.push_back([=] {
      return std::vector<Row>{{"compliant", scenes, compliant::ClaimsOf(hard, count, kSeed)}};
    });
  });
}

void AddFiniteDuration(int count, Jobs& jobs) {
  using finite_duration::ClaimKind;
  constexpr std::pair<const char*, ClaimKind> kKinds[] = {
      {"linear", ClaimKind::kLinear}, {"Hertz", ClaimKind::kHertz}, {"compliant", ClaimKind::kCompliant}};
  for (const auto& [name, kind] : kKinds) {
    const std::string method = std::string("duration, ") + name;
    for (const double tolerance : finite_duration::kClaimTolerances) {
      ForBothKinds([&, kind = kind](const char* scenes, bool hard) {
        jobs.all.push_back([=] {
          return std::vector<Row>{{method, scenes, finite_duration::ClaimsOf(kind, hard, tolerance, count, kSeed)}};
        });
      });
    }
  }
}

// Does the jobs on all cores and prints their rows in order, each as soon as those before it are known. Returns how
// many claims are broken. Each job draws its own scenes, so that no number depends on the cores.
int PrintTable(const Jobs& jobs) {
  std::vector<std::packaged_task<std::vector<Row>()>> tasks(jobs.all.begin(), jobs.all.end());
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < tasks.size(); i = next++) tasks[i]();
  };
  std::vector<std::future<std::vector<Row>>> results;
  for (auto& task : tasks) results.push_back(task.get_future());
  std::vector<std::jthread> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) workers.emplace_back(work);
  int broken = 0;
  PrintClaimsHeader();
  for (std::future<std::vector<Row>>& result : results) {
    for (const Row& row : result.get()) {
      PrintClaims(row.method, row.scenes, row.tally, GoalOf(row.method));
      broken += row.tally.broken();
    }
    std::fflush(stdout);
  }
  return broken;
}

void AddVelocities(int count, Jobs& jobs) {
  AddPendulum(count, jobs);
  AddPlanar(count, jobs);
  AddSliding<1>(" (2D)", count, jobs);
  AddSliding<2>(" (3D)", count, jobs);
  AddSpatial(count, jobs);
  AddCompliant(count, jobs);
  AddFiniteDuration(count, jobs);
}

int Run(int count, const std::string& only) {
  Jobs jobs = {.only = only, .all = {}};
  if (only.empty()) AddVelocities(count, jobs);
  AddMechanisms(count, jobs);
  AddSeveralContacts(count, jobs);
  AddNumbersOfClosedForms(count, jobs);
  AddNumbersOfSpace(count, jobs);
  AddNumbersOfSprings(count, jobs);
  const int broken = PrintTable(jobs);
  std::printf("%d claims broken\n", broken);
  return broken == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  constexpr int kCount = 10'000;
  return ricochet::Run(argc > 1 ? std::atoi(argv[1]) : kCount, argc > 2 ? argv[2] : "");
}
