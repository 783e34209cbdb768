// The price of accuracy: the pendulum's closed form is compared with the plain formulas, in time and in ulp. The price of
// generality: the planar model is compared with the pendulum's closed form.

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/engine/engine.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/sweep/sweep_run.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"
#include "tests/support/known_contacts.h"
#include "tests/support/planar_scenes.h"
#include "tests/support/ulp.h"

namespace ricochet::bench {
namespace {

using pendulum::Impact;
using pendulum::Output;
using pendulum::Problem;

constexpr int kRounds = 21;

// The paper's formulas for a given energetic coefficient, written plainly. The function is not inlined, because a caller
// that uses one output must not spare the others.
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

void ScalarSolve() {
  const std::vector<Problem> problems = TypicalProblems(4096);
  const auto run = [&](auto solve) {
    double sum = 0.0;
    for (const Problem& problem : problems) sum += solve(problem)[Output::kOmegaPlus];
    Keep(sum);
  };
  const Comparison time = Compare(
      kRounds, [&] { run(pendulum::Solve); }, [&] { run(PlainSolve); });
  const double count = static_cast<double>(problems.size());
  std::printf("Pendulum, one solve, all %d outputs\n", pendulum::kOutputCount);
  Print("ricochet", absl::StrFormat("%.1f ns", time.seconds_a / count * 1e9), "within 1 ulp of exact, always");
  Print("the same formulas, plain C++", absl::StrFormat("%.1f ns", time.seconds_b / count * 1e9),
        absl::StrFormat("wrong by up to %.3g ulp in everyday scenes, %.3g ulp in hard ones",
                        LargestUlp(TypicalProblems(100000)), LargestUlp(HardProblems(100000))));
  Print("ratio", absl::StrFormat("%.2f x", time.ratio), "ricochet / plain, median of rounds");
}

const std::vector<Output> kEightOutputs = {Output::kNewton,     Output::kPoisson,       Output::kTangentialCoefficient,
                                           Output::kOmegaPlus,  Output::kNormalImpulse, Output::kTangentialImpulse,
                                           Output::kWorkNormal, Output::kEnergyChange};

void Columns() {
  const std::vector<Problem> problems = TypicalProblems(4096);
  const size_t count = problems.size();
  std::vector<double> values(count * kEightOutputs.size());
  std::vector<double*> columns;
  for (size_t c = 0; c < kEightOutputs.size(); ++c) columns.push_back(&values[c * count]);
  std::vector<Regime> regimes(count);
  const auto inadmissible = std::make_unique<bool[]>(count);
  const auto solve_columns = [&](size_t columns_wanted) {
    pendulum::SolveColumns(problems, absl::MakeConstSpan(kEightOutputs).first(columns_wanted),
                           absl::MakeConstSpan(columns).first(columns_wanted), absl::MakeSpan(regimes),
                           absl::MakeSpan(inadmissible.get(), count));
  };
  const auto plain_columns = [&] {
    for (size_t i = 0; i < count; ++i) {
      const Impact impact = PlainSolve(problems[i]);
      for (size_t c = 0; c < kEightOutputs.size(); ++c) columns[c][i] = impact[kEightOutputs[c]];
    }
  };
  const Comparison eight = Compare(
      kRounds, [&] { solve_columns(8); }, plain_columns);
  const Comparison one = Compare(
      kRounds, [&] { solve_columns(1); }, [&] { solve_columns(8); });
  const double points = static_cast<double>(count);
  std::printf("Pendulum, columns of many solves\n");
  Print("8 columns", absl::StrFormat("%.1f ns/point", eight.seconds_a / points * 1e9),
        absl::StrFormat("%.2f x plain C++ in a loop", eight.ratio));
  Print("1 column", absl::StrFormat("%.1f ns/point", one.seconds_a / points * 1e9),
        absl::StrFormat("%.2f x eight columns: only what is asked for is computed", one.ratio));
}

// Measures what a sweep adds to the columns of its problems: the grid, the validation and the summary.
void CompareSweep(const std::string& what, const std::vector<std::string>& names, const std::vector<Output>& outputs) {
  constexpr int64_t kPoints = 65536;
  const SweepRequest request = {
      .grid = {.scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                         .restitution = EnergeticCoefficient{1.0}},
               .axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.25, 256}},
                        {"restitution.energetic", Linspace{0.0, 1.0, 256}}}},
      .columns = names};
  const auto sweep = [&] {
    absl::StatusOr<SweepRun> run = SweepRun::Make(request);
    while (!run->ended()) Keep(run->NextChunk([] { return false; }).ok());
  };
  const std::vector<Problem> problems = TypicalProblems(kPoints);
  std::vector<double> solved(problems.size() * outputs.size());
  std::vector<double*> columns;
  for (size_t c = 0; c < outputs.size(); ++c) columns.push_back(&solved[c * problems.size()]);
  std::vector<Regime> regimes(problems.size());
  const auto inadmissible = std::make_unique<bool[]>(problems.size());
  const auto solve = [&] {
    pendulum::SolveColumns(problems, outputs, columns, absl::MakeSpan(regimes),
                           absl::MakeSpan(inadmissible.get(), problems.size()));
  };
  const Comparison time = Compare(kRounds, sweep, solve);
  Print(what, absl::StrFormat("%.1f ns/point", time.seconds_a / kPoints * 1e9),
        absl::StrFormat("%.2f x the columns of as many problems", time.ratio));
}

void Sweeps() {
  std::printf("Pendulum, sweeps over two axes\n");
  CompareSweep("8 columns",
               {"coefficients.newton", "coefficients.poisson", "coefficients.tangential", "rates_after_rad_s[0]",
                "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_total_j", "energy_change_j"},
               kEightOutputs);
  CompareSweep("1 column", {"coefficients.newton"}, {Output::kNewton});
}

void ComparePlanar(const std::string& what, const std::vector<planar::Problem>& contacts,
                   const std::vector<Problem>& pendulums) {
  const Comparison time = Compare(
      kRounds,
      [&] {
        double sum = 0.0;
        for (const planar::Problem& contact : contacts) sum += planar::Solve(contact).v1;
        Keep(sum);
      },
      [&] {
        double sum = 0.0;
        for (const Problem& pendulum : pendulums) sum += pendulum::Solve(pendulum)[Output::kOmegaPlus];
        Keep(sum);
      });
  Print(what, absl::StrFormat("%.1f ns", time.seconds_a / static_cast<double>(contacts.size()) * 1e9),
        absl::StrFormat("%.2f x the pendulum's closed form, %.1f ns", time.ratio,
                        time.seconds_b / static_cast<double>(pendulums.size()) * 1e9));
}

// Plain arithmetic with its bound, compared with formulas in plain C++ that know no bound.
void ComparePlainPlanar(const std::string& what, const std::vector<planar::Problem>& contacts,
                        const std::vector<Problem>& pendulums) {
  double proved = 0.0;
  for (const planar::Problem& contact : contacts) proved += planar::SolvePlain(contact).proved ? 1.0 : 0.0;
  const Comparison time = Compare(
      kRounds,
      [&] {
        double sum = 0.0;
        for (const planar::Problem& contact : contacts) sum += planar::SolvePlain(contact).impact.v1;
        Keep(sum);
      },
      [&] {
        double sum = 0.0;
        for (const Problem& pendulum : pendulums) sum += PlainSolve(pendulum)[Output::kOmegaPlus];
        Keep(sum);
      });
  const double count = static_cast<double>(contacts.size());
  Print(what, absl::StrFormat("%.1f ns", time.seconds_a / count * 1e9),
        absl::StrFormat("%.2f x the pendulum's formulas in plain C++; %.1f %% proved", time.ratio,
                        100.0 * proved / count));
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
    for (const auto& chunk : LocalSolver().Sweep(EndlessSweep(), {.stop = stop.get_token()})) Keep(chunk.ok());
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
