// Planar contacts in columns: the time of one contact among many in SIMD lanes, against the same contacts one by one,
// and against divisions and square roots alone.

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/models/planar/columns.h"
#include "core/models/planar/planar.h"
#include "core/plan/arithmetic.h"
#include "tests/benchmark/division_floor.h"
#include "tests/benchmark/measure.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/solved_in_lanes.h"

namespace ricochet::bench {
namespace {

using planar::Output;
using planar::Problem;

constexpr int kRounds = 21;
constexpr int kTimes = 8;
constexpr size_t kContacts = 1024;
constexpr double kDefaultTolerance = 1e-12;

// A simulator needs these numbers of a contact, beside its regime.
constexpr std::array kStep = {Output::kTangentialVelocityAfter, Output::kNormalVelocityAfter, Output::kNormalImpulse,
                              Output::kTangentialImpulse,       Output::kEnergyChange,        Output::kRelativeError};

constexpr std::array kAll = {Output::kNewton,
                             Output::kPoisson,
                             Output::kEnergetic,
                             Output::kTangentialCoefficient,
                             Output::kTangentialVelocityAfter,
                             Output::kNormalVelocityAfter,
                             Output::kNormalImpulseCompression,
                             Output::kNormalImpulse,
                             Output::kTangentialImpulse,
                             Output::kWorkNormalCompression,
                             Output::kWorkNormalRestitution,
                             Output::kWorkTangentialCompression,
                             Output::kWorkTangentialRestitution,
                             Output::kWorkNormal,
                             Output::kWorkTangential,
                             Output::kFrictionDissipation,
                             Output::kEnergyChange,
                             Output::kRelativeError};

// Contacts of one law and room for their outputs. All of it stays in the cache.
class Bench {
 public:
  explicit Bench(const std::vector<Problem>& problems)
      : problems_(problems),
        numbers_{.law = problems.front().law},
        values_(problems.size() * kAll.size()),
        regimes_(problems.size()),
        inadmissible_(std::make_unique<bool[]>(problems.size())) {
    for (const Problem& problem : problems) numbers_.Add(problem);
    for (size_t c = 0; c < kAll.size(); ++c) columns_.push_back(&values_[c * problems.size()]);
  }

  size_t size() const { return problems_.size(); }

  size_t Solve(absl::Span<const Output> outputs, double tolerance) {
    return planar::SolveColumns(numbers_.Columns(), tolerance,
                                {.outputs = outputs,
                                 .columns = absl::MakeConstSpan(columns_).first(outputs.size()),
                                 .regimes = absl::MakeSpan(regimes_),
                                 .inadmissible = {inadmissible_.get(), size()}});
  }

  void SolveOneByOne(double tolerance) {
    for (size_t i = 0; i < size(); ++i) {
      const SolvedImpact<planar::Impact> solved = SolveWithin(problems_[i], tolerance);
      const planar::Impact& impact = solved.impact;
      const std::array numbers = {
          impact.u1, impact.v1, impact.tau1, impact.f1, impact.energy_change, solved.relative_error()};
      for (size_t c = 0; c < numbers.size(); ++c) columns_[c][i] = numbers[c];
      regimes_[i] = impact.regime;
    }
  }

  // The divisions and roots of a contact that slides and then sticks.
  void Floor() { DivisionsAndRoots(8, 1, size(), numbers_.numbers[0].data(), columns_[0]); }

 private:
  std::vector<Problem> problems_;
  planar::PlanarColumnsOfLaw numbers_;
  std::vector<double> values_;
  std::vector<double*> columns_;
  std::vector<Regime> regimes_;
  std::unique_ptr<bool[]> inadmissible_;
};

void PrintRow(const std::string& what, Bench& bench, absl::Span<const Output> outputs, double tolerance) {
  const auto times = [](auto run) {
    return [run] {
      for (int i = 0; i < kTimes; ++i) run();
    };
  };
  const auto solve = times([&] { bench.Solve(outputs, tolerance); });
  const Comparison single = Compare(kRounds, solve, times([&] { bench.SolveOneByOne(tolerance); }));
  const Comparison floor = Compare(kRounds, solve, times([&] { bench.Floor(); }));
  const double count = static_cast<double>(bench.size() * kTimes);
  const auto nanoseconds = [&](double seconds) { return seconds / count * 1e9; };
  const double redone = static_cast<double>(bench.Solve(outputs, tolerance)) / static_cast<double>(bench.size());
  Print(what, absl::StrFormat("%.1f ns/contact", nanoseconds(single.seconds_a)),
        absl::StrFormat("%.3f x one by one, %.1f ns; %.2f x 8 divisions and a root, %.1f ns; %.1f %% compensated",
                        single.ratio, nanoseconds(single.seconds_b), floor.ratio, nanoseconds(floor.seconds_b),
                        100.0 * redone));
}

std::vector<Problem> Contacts(RestitutionLaw law, Problem (planar::SceneSource::*draw)()) {
  planar::SceneSource source(1);
  std::vector<Problem> contacts;
  while (contacts.size() < kContacts) {
    const Problem problem = (source.*draw)();
    if (problem.law == law) contacts.push_back(problem);
  }
  return contacts;
}

// Contacts that all take one course, as neighbours in a sweep do.
std::vector<Problem> ContactsOfRegime(Regime regime) {
  planar::SceneSource source(2);
  std::vector<Problem> contacts;
  while (contacts.size() < kContacts) {
    const Problem problem = source.Everyday();
    if (problem.law != RestitutionLaw::kEnergetic || planar::Solve(problem).regime != regime) continue;
    if (planar::SolvePlain(problem).proved) contacts.push_back(problem);
  }
  return contacts;
}

void RunAll() {
  std::printf("Planar contacts in columns; velocities, impulses, energy, error, regime and limits\n");
  const auto everyday = [](RestitutionLaw law) { return Bench(Contacts(law, &planar::SceneSource::Everyday)); };
  Bench energetic = everyday(RestitutionLaw::kEnergetic);
  Bench newton = everyday(RestitutionLaw::kNewton);
  Bench poisson = everyday(RestitutionLaw::kPoisson);
  PrintRow("everyday, energetic law, at 1e-12", energetic, kStep, kDefaultTolerance);
  PrintRow("everyday, Newton's law, at 1e-12", newton, kStep, kDefaultTolerance);
  PrintRow("everyday, Poisson's law, at 1e-12", poisson, kStep, kDefaultTolerance);
  PrintRow("everyday, energetic law, all outputs", energetic, kAll, kDefaultTolerance);
  PrintRow("everyday, Newton's law, all outputs", newton, kAll, kDefaultTolerance);
  PrintRow("everyday, energetic law, at 0", energetic, kStep, 0.0);
  Bench hard(Contacts(RestitutionLaw::kEnergetic, &planar::SceneSource::Any));
  PrintRow("near thresholds, energetic law, at 1e-12", hard, kStep, kDefaultTolerance);
  Bench sliding(ContactsOfRegime(Regime::kSliding));
  Bench stick_early(ContactsOfRegime(Regime::kStickInCompression));
  Bench stick_late(ContactsOfRegime(Regime::kStickInRestitution));
  PrintRow("all slide", sliding, kStep, kDefaultTolerance);
  PrintRow("all stick in compression", stick_early, kStep, kDefaultTolerance);
  PrintRow("all stick in restitution", stick_late, kStep, kDefaultTolerance);
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
