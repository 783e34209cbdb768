// Batches: contacts a second in this process and from a server on loopback, by the size of a batch, and the time of a
// batch of planar contacts against that of the planar model's SIMD lanes alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/models/planar/columns.h"
#include "ricochet/client.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::bench {
namespace {

constexpr int kRounds = 5;
constexpr double kSecondsARound = 0.1;

// Contacts of many courses: slip goes on, stops, or turns back.
double Spread(size_t row, double step) { return std::sin(step * static_cast<double>(row) + 1.0); }

struct Batch {
  BatchSetup setup;
  std::vector<std::vector<double>> in, out;

  Batch(BatchSetup given, size_t rows)
      : setup(std::move(given)), out(setup.columns.size(), std::vector<double>(rows)) {}

  void AddColumn(size_t rows, double centre, double spread) {
    const double step = 0.7 + 0.31 * static_cast<double>(in.size());
    std::vector<double>& column = in.emplace_back(rows);
    for (size_t i = 0; i < rows; ++i) column[i] = centre + spread * Spread(i, step);
  }

  BatchRows Rows() {
    BatchRows rows;
    for (const auto& column : in) rows.inputs.emplace_back(column);
    for (auto& column : out) rows.outputs.push_back(absl::MakeSpan(column));
    return rows;
  }
};

Batch Contacts(size_t rows, double tolerance) {
  Batch batch({.scene = {.system = PlanarContact{}, .restitution = EnergeticCoefficient{0.5}},
               .fields = {"planar_contact.w_tt_per_kg", "planar_contact.w_tn_per_kg", "planar_contact.w_nn_per_kg",
                          "planar_contact.tangential_m_s", "planar_contact.normal_m_s", "friction.kinetic_coefficient"},
               .columns = {"contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.normal_m_s",
                           "impulse.tangential_n_s[0]", "impulse.normal_total_n_s"},
               .demand = {.relative_tolerance = tolerance}},
              rows);
  batch.AddColumn(rows, 3.0, 0.5);
  batch.AddColumn(rows, 0.0, 1.0);
  batch.AddColumn(rows, 1.5, 0.3);
  batch.AddColumn(rows, 0.0, 2.0);
  batch.AddColumn(rows, -1.0, 0.5);
  batch.AddColumn(rows, 0.4, 0.3);
  return batch;
}

// The bodies have these fields each, in the order of their numbers below.
void AddBody(const std::string& prefix, size_t rows, double velocity_n_m_s, Batch& batch) {
  const auto add = [&](const char* field, double centre, double spread) {
    batch.setup.fields.push_back(prefix + field);
    batch.AddColumn(rows, centre, spread);
  };
  add(".mass_kg", 2.0, 1.0);
  add(".inertia_com_kg_m2", 0.5, 0.2);
  add(".offset_t_m", 0.0, 0.5);
  add(".offset_n_m", -0.5, 0.2);
  add(".velocity_t_m_s", 0.0, 2.0);
  add(".velocity_n_m_s", velocity_n_m_s, 0.5);
}

Batch BodiesWithFriction(BatchSetup setup, size_t rows, double tolerance) {
  setup.scene.restitution = EnergeticCoefficient{0.5};
  setup.demand.relative_tolerance = tolerance;
  Batch batch(std::move(setup), rows);
  batch.setup.fields.emplace_back("friction.kinetic_coefficient");
  batch.AddColumn(rows, 0.4, 0.3);
  return batch;
}

Batch Bodies(size_t rows, double tolerance) {
  Batch batch = BodiesWithFriction({.scene = {.system = PlanarBody{1.0, 1.0}},
                                    .columns = {"bodies_after[0].linear_m_s[0]", "bodies_after[0].linear_m_s[1]",
                                                "bodies_after[0].angular_rad_s[0]"}},
                                   rows, tolerance);
  AddBody("planar_body", rows, -2.0, batch);
  return batch;
}

Batch Pairs(size_t rows, double tolerance) {
  Batch batch =
      BodiesWithFriction({.scene = {.system = BodyPair{PlanarPair{PlanarBody{1.0, 1.0}, PlanarBody{1.0, 1.0}}}},
                          .columns = {"bodies_after[0].linear_m_s[1]", "bodies_after[1].linear_m_s[1]",
                                      "bodies_after[0].angular_rad_s[0]", "bodies_after[1].angular_rad_s[0]"}},
                         rows, tolerance);
  AddBody("body_pair.planar.body_1", rows, -2.0, batch);
  AddBody("body_pair.planar.body_2", rows, 0.0, batch);
  return batch;
}

Batch ContactsInSpace(size_t rows, double tolerance) {
  Batch batch({.scene = {.system = SpatialContact{{1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, {1.0, 0.6}, -1.0},
                         .restitution = EnergeticCoefficient{0.5}},
               .fields = {"spatial_contact.tangential_m_s[0]", "spatial_contact.tangential_m_s[1]",
                          "spatial_contact.normal_m_s", "friction.kinetic_coefficient"},
               .columns = {"contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.tangential_m_s[1]",
                           "contact_velocity_after.normal_m_s"},
               .demand = {.relative_tolerance = tolerance}},
              rows);
  batch.AddColumn(rows, 0.0, 2.0);
  batch.AddColumn(rows, 0.0, 2.0);
  batch.AddColumn(rows, -1.0, 0.5);
  batch.AddColumn(rows, 0.4, 0.3);
  return batch;
}

// Contacts a second of a session that solves the batch again and again.
double Rate(const Solver& solver, Batch& batch) {
  absl::StatusOr<BatchSession> session = solver.OpenBatches(batch.setup);
  const BatchRows rows = batch.Rows();
  const auto solve = [&] {
    if (!session->Solve(rows).ok()) std::abort();
  };
  const double once = Seconds(solve);
  const int calls = std::max(1, static_cast<int>(kSecondsARound / once));
  std::vector<double> seconds;
  for (int i = 0; i < kRounds; ++i) {
    seconds.push_back(Seconds([&] {
      for (int k = 0; k < calls; ++k) solve();
    }));
  }
  return static_cast<double>(batch.in[0].size()) * calls / Median(seconds);
}

// The share that checks, plans and the order of rows have in the time of a batch: 1 would be the lanes alone.
void RunAgainstLanes(const Solver& local, double tolerance) {
  constexpr size_t kRows = 1000;
  constexpr int kTimes = 50;
  Batch batch = Contacts(kRows, tolerance);
  const std::vector<double> restitution(kRows, 0.5);
  constexpr std::array kOutputs = {PlanarOutput::kTangentialVelocityAfter, PlanarOutput::kNormalVelocityAfter,
                                   PlanarOutput::kTangentialImpulse, PlanarOutput::kNormalImpulse};
  std::vector<double*> places;
  for (auto& column : batch.out) places.push_back(column.data());
  absl::StatusOr<BatchSession> session = local.OpenBatches(batch.setup);
  const BatchRows rows = batch.Rows();
  const auto solve_batch = [&] {
    for (int i = 0; i < kTimes; ++i) {
      if (!session->Solve(rows).ok()) std::abort();
    }
  };
  const auto solve_lanes = [&] {
    for (int i = 0; i < kTimes; ++i) {
      planar::SolveColumns({.wtt = batch.in[0],
                            .wtn = batch.in[1],
                            .wnn = batch.in[2],
                            .u0 = batch.in[3],
                            .v0 = batch.in[4],
                            .mu = batch.in[5],
                            .mu_static = batch.in[5],
                            .coefficient = restitution},
                           tolerance, {.outputs = kOutputs, .columns = places, .regimes = {}, .inadmissible = {}});
    }
  };
  const Comparison compared = Compare(21, solve_batch, solve_lanes);
  Print(absl::StrFormat("A planar contact in a batch of %d, tolerance %.0e", kRows, tolerance),
        absl::StrFormat("%.1f ns", compared.seconds_a / (kRows * kTimes) * 1e9),
        absl::StrFormat("%.2f of the planar model in lanes alone", compared.ratio));
}

// Measures what derivatives of two numbers of the outcome by four of the scene add to a row.
void RunWithDerivatives(const Solver& local) {
  constexpr size_t kRows = 10'000;
  Batch without = Contacts(kRows, 1e-12);
  Batch with = Contacts(kRows, 1e-12);
  for (const size_t of : {0u, 1u}) {
    for (const size_t by : {0u, 1u, 3u, 5u}) {
      with.setup.columns.push_back(absl::StrCat("d(", with.setup.columns[of], ")/d(", with.setup.fields[by], ")"));
      with.out.emplace_back(kRows);
    }
  }
  const auto solve = [&local](Batch& batch) {
    if (!local.OpenBatches(batch.setup)->Solve(batch.Rows()).ok()) std::abort();
  };
  const Comparison compared = Compare(
      11, [&] { solve(with); }, [&] { solve(without); });
  Print("A planar contact with 8 derivatives in a batch", absl::StrFormat("%.0f ns", compared.seconds_a / kRows * 1e9),
        absl::StrFormat("%.1f x without them, goal 3", compared.ratio));
}

// The rate on two threads against that on one.
void CompareThreads(const char* what, double goal, absl::FunctionRef<void(const Solver&)> solve) {
  const LocalSolver one(Limits::None(), 1);
  const LocalSolver two(Limits::None(), 2);
  const Comparison compared = Compare(
      11, [&] { solve(one); }, [&] { solve(two); });
  Print(what, absl::StrFormat("%.2f x", compared.ratio), absl::StrFormat("goal %.1f", goal));
}

void SweepPendulums(const Solver& solver) {
  constexpr int64_t kPoints = 10'000'000;
  const SweepRequest request = {
      .grid = {.scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                         .restitution = EnergeticCoefficient{0.5}},
               .axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.25, kPoints}}}},
      .columns = {"coefficients.newton"},
      .end_index = kPoints};
  for (const absl::StatusOr<SweepChunk>& chunk : solver.Sweep(request)) {
    if (!chunk.ok()) std::abort();
  }
}

Batch ContactsOnSprings(size_t rows) {
  Batch batch({.scene = {.system = PlanarContact{.w_tt_per_kg = 3.0, .w_tn_per_kg = 0.5, .w_nn_per_kg = 1.5},
                         .restitution = EnergeticCoefficient{0.5},
                         .compliance = Compliance{.normal = LinearSpring{1e5}}},
               .fields = {"planar_contact.tangential_m_s", "planar_contact.normal_m_s", "friction.kinetic_coefficient"},
               .columns = {"contact_velocity_after.normal_m_s", "contact.duration_s"}},
              rows);
  batch.AddColumn(rows, 0.0, 2.0);
  batch.AddColumn(rows, -1.0, 0.5);
  batch.AddColumn(rows, 0.4, 0.3);
  return batch;
}

void CompareThreads() {
  std::printf("Rate on two threads over that on one, medians of 11 rounds\n");
  CompareThreads("sweep of 10^7 pendulums", 1.8, SweepPendulums);
  const auto compare_batch = [](const char* what, double goal, Batch batch) {
    CompareThreads(what, goal, [&batch](const Solver& solver) {
      if (!solver.OpenBatches(batch.setup)->Solve(batch.Rows()).ok()) std::abort();
    });
  };
  compare_batch("batch of 10^6 planar contacts", 1.7, Contacts(1'000'000, 1e-12));
  compare_batch("batch of 20,000 planar contacts on a spring", 1.9, ContactsOnSprings(20'000));
  compare_batch("batch of 64 planar contacts on a spring", 1.7, ContactsOnSprings(64));
}

// Measures a fit of two numbers to impacts that are followed in time, which has no exact derivatives, against one
// solution of its rows.
void RunFit(const Solver& local) {
  Batch batch = ContactsOnSprings(8);
  const auto solve = [&] {
    if (!local.OpenBatches(batch.setup)->Solve(batch.Rows()).ok()) std::abort();
  };
  solve();
  FitRequest request = {.scene = batch.setup.scene,
                        .unknowns = {{.path = "compliance.linear.stiffness_n_m", .start = 8e4},
                                     {.path = "restitution.energetic", .start = 0.4}}};
  for (size_t k = 0; k < batch.in.size(); ++k) request.inputs.push_back({batch.setup.fields[k], batch.in[k]});
  for (size_t c = 0; c < batch.out.size(); ++c) {
    std::vector<double> values = batch.out[c];
    for (size_t row = 0; row < values.size(); ++row) values[row] *= 1.0 + 0.01 * Spread(row, 1.3);
    const double sigma = 0.01 * *std::max_element(values.begin(), values.end());
    request.measured.push_back({batch.setup.columns[c], std::move(values), {sigma}});
  }
  const auto fit = [&] {
    if (!local.Fit(request).ok()) std::abort();
  };
  const Comparison compared = Compare(3, fit, solve);
  Print("A fit of two numbers to 8 impacts in time", absl::StrFormat("%.0f ms", compared.seconds_a * 1e3),
        absl::StrFormat("%.0f times the time of its rows", compared.ratio));
}

struct Solvers {
  LocalSolver one_thread{Limits::None(), 1};
  LocalSolver all_cores;
  const Solver& remote;
};

void Run(const char* name, const Solvers& solvers, Batch (*make)(size_t, double), double tolerance) {
  std::printf("%s, tolerance %.0e, medians of %d rounds\n", name, tolerance, kRounds);
  std::printf("  %9s %16s %16s %16s %18s\n", "rows", "one thread M/s", "all cores M/s", "loopback M/s",
              "loopback us/call");
  for (const size_t rows : {1u, 64u, 1000u, 10'000u, 100'000u}) {
    Batch batch = make(rows, tolerance);
    const double alone = Rate(solvers.one_thread, batch);
    const double together = Rate(solvers.all_cores, batch);
    const double there = Rate(solvers.remote, batch);
    std::printf("  %9zu %16.2f %16.2f %16.2f %18.0f\n", rows, alone / 1e6, together / 1e6, there / 1e6,
                static_cast<double>(rows) / there * 1e6);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  using namespace ricochet;
  using namespace ricochet::bench;
  const ServerProcess server;
  const auto client = Client::Connect({.target = server.address()});
  if (!client.ok()) return 1;
  const Solvers solvers = {.remote = *client};
  RunAgainstLanes(solvers.one_thread, 1e-12);
  RunWithDerivatives(solvers.one_thread);
  RunFit(solvers.one_thread);
  CompareThreads();
  Run("Planar contacts", solvers, Contacts, 1e-12);
  Run("Planar contacts", solvers, Contacts, 1e-6);
  Run("Bodies in a plane", solvers, Bodies, 1e-12);
  Run("Pairs of bodies in a plane", solvers, Pairs, 1e-12);
  Run("Contacts in space", solvers, ContactsInSpace, 1e-6);
  Run("Contacts in space", solvers, ContactsInSpace, 1e-10);
  return 0;
}
