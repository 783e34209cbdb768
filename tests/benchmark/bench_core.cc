// The price of accuracy: the pendulum's closed form is compared with the plain formulas, in time and in ulp. The price
// of generality: the planar model is compared with the pendulum's closed form.

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/engine/sweep_run.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/plan/arithmetic.h"
#include "ricochet/engine_info.h"
#include "ricochet/solver.h"
#include "tests/benchmark/division_floor.h"
#include "tests/benchmark/measure.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::bench {
namespace {

using pendulum::Impact;
using pendulum::Output;
using pendulum::Problem;
using pendulum::ProblemColumns;

constexpr int kRounds = 21;

// The paper's formulas for a given energetic coefficient, written plainly. The function is not inlined, because a
// caller that uses one output must not spare the others.
[[gnu::noinline]] Impact PlainSolve(const Problem& p) {
  Impact impact;
  const auto set = [&](Output output, double value) { impact.values[static_cast<size_t>(output)] = value; };
  const double b = std::fabs(p.b);
  const double sign = p.b < 0.0 ? -1.0 : 1.0;
  const bool locked = p.mu_static * b >= p.a;
  const double r = (p.a - p.mu * b) / (p.a + p.mu * b);
  const double eta = locked ? 0.0 : p.coefficient;
  const double kappa = locked ? 0.0 : eta / std::sqrt(r);
  const double kappa_hat = locked ? 0.0 : eta * std::sqrt(r);
  const double tau0 = -p.inertia * p.omega_minus / (p.a + p.mu * b);
  const double omega_plus = -kappa_hat * p.omega_minus;
  const double work_normal = 0.5 * p.a * tau0 * p.omega_minus;
  const double work_tangential = 0.5 * p.mu * b * tau0 * p.omega_minus;
  set(Output::kNewton, kappa_hat);
  set(Output::kPoisson, kappa);
  set(Output::kEnergetic, eta);
  set(Output::kTangentialCoefficient, sign * p.mu * (1.0 - kappa) / (1.0 + kappa));
  set(Output::kOmegaPlus, omega_plus);
  set(Output::kTangentialVelocityAfter, p.b * omega_plus);
  set(Output::kNormalVelocityAfter, p.a * omega_plus);
  set(Output::kNormalImpulseCompression, tau0);
  set(Output::kNormalImpulse, (1.0 + kappa) * tau0);
  set(Output::kTangentialImpulse, sign * p.mu * (1.0 - kappa) * tau0);
  set(Output::kTangentialImpulseCompression, sign * p.mu * tau0);
  set(Output::kWorkNormalCompression, work_normal);
  set(Output::kWorkNormalRestitution, -eta * eta * work_normal);
  set(Output::kWorkTangentialCompression, work_tangential);
  set(Output::kWorkTangentialRestitution, eta * eta * work_tangential);
  set(Output::kWorkNormal, (1.0 - eta * eta) * work_normal);
  set(Output::kWorkTangential, (1.0 + eta * eta) * work_tangential);
  set(Output::kEnergyChange, -0.5 * p.inertia * p.omega_minus * p.omega_minus * (1.0 - kappa_hat * kappa_hat));
  set(Output::kEnergeticExcess, eta - 1.0);
  return impact;
}

// Everyday scenes.
std::vector<Problem> TypicalProblems(size_t count) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  std::vector<Problem> problems(count);
  for (Problem& p : problems) {
    p = {.inertia = uniform(0.1, 5.0),
         .a = uniform(0.1, 2.0),
         .b = uniform(-1.0, 1.0),
         .omega_minus = -uniform(0.1, 10.0),
         .mu = uniform(0.0, 0.2),
         .mu_static = 0.0,
         .law = RestitutionLaw::kEnergetic,
         .coefficient = uniform(0.0, 1.0)};
    p.mu_static = p.mu;
  }
  return problems;
}

// These scenes lie a few ulp to 1e-3 below the friction that locks, or their coefficient is as close to 1.
std::vector<Problem> HardProblems(size_t count) {
  std::mt19937_64 random(2);
  std::vector<Problem> problems = TypicalProblems(count);
  for (Problem& p : problems) {
    const double gap = std::exp2(-std::uniform_real_distribution<>(10.0, 51.0)(random));
    if (random() % 2 == 0) {
      p.mu = p.mu_static = p.a / std::fabs(p.b) * (1.0 - gap);
    } else {
      p.coefficient = 1.0 - gap;
    }
  }
  return problems;
}

double LargestUlp(const std::vector<Problem>& problems) {
  double largest = 0.0;
  for (const Problem& problem : problems) {
    const Impact exact = pendulum::Solve(problem);
    if (exact.regime == Regime::kLocked) continue;
    const Impact plain = PlainSolve(problem);
    for (int i = 0; i < pendulum::kOutputCount; ++i) {
      const auto output = static_cast<Output>(i);
      largest = std::max(largest, static_cast<double>(UlpDistance(exact[output], plain[output])));
    }
  }
  return largest;
}

constexpr double kDefaultTolerance = 1e-12;

// The first arithmetic that is exact enough, as a request with the default tolerance takes it.
Impact SolveAtDefault(const Problem& problem) { return SolveWithin(problem, kDefaultTolerance).impact; }

void ScalarSolve() {
  const std::vector<Problem> problems = TypicalProblems(4096);
  const auto run = [&](auto solve) {
    double sum = 0.0;
    for (const Problem& problem : problems) sum += solve(problem)[Output::kOmegaPlus];
    DoNotOptimize(sum);
  };
  const auto against_plain = [&](auto solve) {
    return Compare(
        kRounds, [&] { run(solve); }, [&] { run(PlainSolve); });
  };
  const Comparison exact = against_plain(pendulum::Solve);
  const Comparison at_default = against_plain(SolveAtDefault);
  const double count = static_cast<double>(problems.size());
  const auto nanoseconds = [&](double seconds) { return absl::StrFormat("%.1f ns", seconds / count * 1e9); };
  std::printf("Pendulum, one solve, all %d outputs\n", pendulum::kOutputCount);
  Print("at tolerance 0", nanoseconds(exact.seconds_a),
        absl::StrFormat("%.2f x plain, within 1 ulp of exact, always", exact.ratio));
  Print("at tolerance 1e-12", nanoseconds(at_default.seconds_a),
        absl::StrFormat("%.2f x plain, error and signs proved", at_default.ratio));
  Print("the same formulas, plain C++", nanoseconds(at_default.seconds_b),
        absl::StrFormat("wrong by up to %.3g ulp in everyday scenes, %.3g ulp in hard ones",
                        LargestUlp(TypicalProblems(100000)), LargestUlp(HardProblems(100000))));
}

const std::vector<Output> kEightOutputs = {Output::kNewton,     Output::kPoisson,       Output::kTangentialCoefficient,
                                           Output::kOmegaPlus,  Output::kNormalImpulse, Output::kTangentialImpulse,
                                           Output::kWorkNormal, Output::kEnergyChange};

// Problems of one law and room for eight columns of their outputs. All of it stays in the cache.
class Bench {
 public:
  explicit Bench(const std::vector<Problem>& problems)
      : problems_(RestitutionLaw::kEnergetic, problems.size()),
        values_(problems.size() * kEightOutputs.size()),
        regimes_(problems.size()),
        inadmissible_(std::make_unique<bool[]>(problems.size())) {
    for (size_t i = 0; i < problems.size(); ++i) problems_.Set(i, problems[i]);
    for (size_t c = 0; c < kEightOutputs.size(); ++c) columns_.push_back(&values_[c * problems.size()]);
  }

  size_t size() const { return problems_.size(); }
  const ProblemColumns& problems() const { return problems_; }
  double* column(size_t c) { return columns_[c]; }

  void Solve(size_t columns_wanted, double tolerance) {
    pendulum::SolveColumns(problems_, 0, size(), tolerance,
                           {.outputs = absl::MakeConstSpan(kEightOutputs).first(columns_wanted),
                            .columns = absl::MakeConstSpan(columns_).first(columns_wanted),
                            .regimes = absl::MakeSpan(regimes_),
                            .inadmissible = {inadmissible_.get(), size()}});
  }

 private:
  ProblemColumns problems_;
  std::vector<double> values_;
  std::vector<double*> columns_;
  std::vector<Regime> regimes_;
  std::unique_ptr<bool[]> inadmissible_;
};

void Columns() {
  constexpr size_t kPoints = 1024;
  constexpr int kTimes = 16;
  const std::vector<Problem> problems = TypicalProblems(kPoints);
  Bench bench(problems);
  const auto solve = [&](size_t columns, double tolerance) {
    return [&bench, columns, tolerance] {
      for (int i = 0; i < kTimes; ++i) bench.Solve(columns, tolerance);
    };
  };
  const auto plain_columns = [&] {
    for (int k = 0; k < kTimes; ++k) {
      for (size_t i = 0; i < kPoints; ++i) {
        const Impact impact = PlainSolve(problems[i]);
        for (size_t c = 0; c < kEightOutputs.size(); ++c) bench.column(c)[i] = impact[kEightOutputs[c]];
      }
    }
  };
  const auto print = [](const std::string& what, const Comparison& time, const std::string& against) {
    Print(what, absl::StrFormat("%.2f ns/point", time.seconds_a / (kPoints * kTimes) * 1e9),
          absl::StrFormat("%.2f x %s, %.2f ns", time.ratio, against, time.seconds_b / (kPoints * kTimes) * 1e9));
  };
  // Divisions and square roots are the slowest of the operations that no arithmetic spares.
  const auto floor = [&](int divisions, int roots) {
    return [&bench, divisions, roots] {
      for (int i = 0; i < kTimes; ++i) {
        DivisionsAndRoots(divisions, roots, bench.size(), bench.problems().a(), bench.column(0));
      }
    };
  };
  std::printf("Pendulum, columns of many solves\n");
  print("8 columns at 1e-12", Compare(kRounds, solve(8, kDefaultTolerance), floor(2, 1)),
        "2 divisions and a root in lanes");
  print("1 column at 1e-12", Compare(kRounds, solve(1, kDefaultTolerance), floor(1, 1)),
        "a division and a root in lanes");
  print("8 columns at 1e-12", Compare(kRounds, solve(8, kDefaultTolerance), plain_columns), "plain C++ in a loop");
  print("8 columns at 0", Compare(kRounds, solve(8, 0.0), plain_columns), "plain C++ in a loop");
  print("1 column at 0", Compare(kRounds, solve(1, 0.0), solve(8, 0.0)), "eight columns");
}

// Measures what a sweep adds to the columns of its problems: the grid, the validation and the summary.
void CompareSweep(const std::string& what, const std::vector<std::string>& names, const char* goal) {
  constexpr int64_t kPoints = 65536;
  const SweepRequest request = {
      .grid = {.scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                         .restitution = EnergeticCoefficient{1.0}},
               .axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.25, 256}},
                        {"restitution.energetic", Linspace{0.0, 1.0, 256}}}},
      .columns = names};
  const auto sweep = [&] {
    absl::StatusOr<SweepRun> run = SweepRun::Make(request);
    while (!run->ended()) DoNotOptimize(run->NextChunk([] { return false; }).ok());
  };
  const std::vector<Problem> problems = TypicalProblems(kPoints);
  Bench bench(problems);
  const Comparison time = Compare(kRounds, sweep, [&] { bench.Solve(names.size(), kDefaultTolerance); });
  Print(what, absl::StrFormat("%.1f ns/point", time.seconds_a / kPoints * 1e9),
        absl::StrFormat("%.2f x the columns of as many problems%s", time.ratio, goal));
}

void Sweeps() {
  std::printf("Pendulum, sweeps over two axes\n");
  CompareSweep("8 columns",
               {"coefficients.newton", "coefficients.poisson", "coefficients.tangential", "rates_after_rad_s[0]",
                "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_total_j", "energy_change_j"},
               "; goal 1.5");
  CompareSweep("1 column", {"coefficients.newton"}, "");
}

void ComparePlanar(const std::string& what, const std::vector<planar::Problem>& contacts,
                   const std::vector<Problem>& pendulums) {
  const Comparison time = Compare(
      kRounds,
      [&] {
        double sum = 0.0;
        for (const planar::Problem& contact : contacts) sum += planar::Solve(contact).v1;
        DoNotOptimize(sum);
      },
      [&] {
        double sum = 0.0;
        for (const Problem& pendulum : pendulums) sum += pendulum::Solve(pendulum)[Output::kOmegaPlus];
        DoNotOptimize(sum);
      });
  Print(what, absl::StrFormat("%.1f ns", time.seconds_a / static_cast<double>(contacts.size()) * 1e9),
        absl::StrFormat("%.2f x the pendulum's closed form, %.1f ns", time.ratio,
                        time.seconds_b / static_cast<double>(pendulums.size()) * 1e9));
}

// The kernel in plain arithmetic with its bound, compared with formulas in plain C++ that know no bound.
void ComparePlainPlanar(const std::string& what, const std::vector<planar::Problem>& contacts,
                        const std::vector<Problem>& pendulums) {
  double served = 0.0;
  for (const planar::Problem& contact : contacts) {
    served += SolveWithin(contact, kDefaultTolerance).arithmetic.arithmetic == Arithmetic::kPlain ? 1.0 : 0.0;
  }
  const Comparison time = Compare(
      kRounds,
      [&] {
        double sum = 0.0;
        for (const planar::Problem& contact : contacts) sum += planar::SolvePlain(contact).impact.v1;
        DoNotOptimize(sum);
      },
      [&] {
        double sum = 0.0;
        for (const Problem& pendulum : pendulums) sum += PlainSolve(pendulum)[Output::kOmegaPlus];
        DoNotOptimize(sum);
      });
  const double count = static_cast<double>(contacts.size());
  Print(what, absl::StrFormat("%.1f ns", time.seconds_a / count * 1e9),
        absl::StrFormat("%.2f x the pendulum's formulas in plain C++; serves %.1f %% at 1e-12", time.ratio,
                        100.0 * served / count));
}

void PlanarSolve() {
  constexpr size_t kCount = 4096;
  const std::vector<Problem> pendulums = TypicalProblems(kCount);
  std::vector<planar::Problem> as_contacts;
  for (const Problem& pendulum : pendulums) as_contacts.push_back(ContactOf(pendulum));
  std::vector<planar::Problem> everyday;
  std::vector<planar::Problem> hard;
  planar::SceneSource source(1);
  for (size_t i = 0; i < kCount; ++i) {
    everyday.push_back(source.Everyday());
    hard.push_back(source.Any());
  }
  std::printf("Planar contact, one solve with its events and works\n");
  ComparePlanar("everyday contacts, W of full rank", everyday, pendulums);
  ComparePlanar("everyday contacts and ones near thresholds", hard, pendulums);
  ComparePlanar("the same pendulums, W of rank one", as_contacts, pendulums);
  ComparePlainPlanar("plain: everyday contacts", everyday, pendulums);
  ComparePlainPlanar("plain: everyday ones and ones near thresholds", hard, pendulums);
  ComparePlainPlanar("plain: the same pendulums", as_contacts, pendulums);
}

SweepRequest EndlessSweep() {
  return {
      .grid = {.scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                         .friction = {.kinetic_coefficient = 0.1},
                         .restitution = EnergeticCoefficient{1.0}},
               .axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.25, 1'000'000'000}}}},
      .columns = {"coefficients.newton"}};
}

void CancellationLatency() {
  std::vector<double> seconds;
  for (int i = 0; i < kRounds; ++i) {
    std::stop_source stop;
    std::chrono::steady_clock::time_point asked;
    std::jthread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      asked = std::chrono::steady_clock::now();
      stop.request_stop();
    });
    for (const auto& chunk : LocalSolver().Sweep(EndlessSweep(), {.stop = stop.get_token()})) DoNotOptimize(chunk.ok());
    const auto ended = std::chrono::steady_clock::now();
    stopper.join();
    seconds.push_back(std::chrono::duration<double>(ended - asked).count());
  }
  std::printf("Stopping an embedded sweep of 10^9 points\n");
  Print("from the request to the end of the stream", absl::StrFormat("%.1f us", Median(seconds) * 1e6),
        "median; at most 1024 points are computed in between");
}

void RunAll() {
  std::printf("ricochet core, engine %s\n", ThisEngine().fingerprint.c_str());
  ScalarSolve();
  Columns();
  Sweeps();
  PlanarSolve();
  CancellationLatency();
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
