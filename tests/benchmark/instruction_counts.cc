// Runs fixed pieces of work under callgrind, so that tests/benchmark/instruction_counts.py can compare what each
// executes with what it executed before.
//
// ricochet_instruction_counts prints the names of the pieces, in the order of their numbers. Each runs once before it
// is counted, so that choices made at a first call do not count. Kernels run with AVX2 on every processor, because
// valgrind knows nothing wider; the program ends with 77 on a processor without it.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "hwy/targets.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"
#include "tests/support/only_target.h"

namespace ricochet::bench {
namespace {

constexpr int kCannotRun = 77;
constexpr int64_t kPoints = 4096;
constexpr size_t kRows = 256;
constexpr size_t kWorks = 12;

struct Work {
  const char* name;
  std::function<double()> run;  // Returns a number of the answer.
};

template <typename Response>
const Response& Value(const absl::StatusOr<Response>& response) {
  if (response.ok()) return *response;
  std::fprintf(stderr, "%s\n", response.status().ToString().c_str());
  std::exit(1);
}

Scene With(System system, double friction) {
  Scene scene;
  scene.system = std::move(system);
  scene.friction.kinetic_coefficient = friction;
  scene.restitution = EnergeticCoefficient{0.6};
  return scene;
}

Scene PendulumScene() { return With(Pendulum{1.0, 1.0, 0.1, -1.0}, 0.1); }
Scene ContactScene() { return With(PlanarContact{2.0, 0.5, 1.0, 0.3, -1.0}, 0.5); }
Scene SpaceScene() { return With(SpatialContact{{1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, {1.0, 0.6}, -1.0}, 0.2); }

Scene LinkageScene() {
  Linkage linkage;
  for (int i = 0; i < 8; ++i) linkage.links.push_back({1.0, 1.0, 0.5, 0.1, 0.3 - 0.1 * i, -1.0});
  return With(std::move(linkage), 0.3);
}

// Callgrind counts the instructions of one thread.
LocalSolver OneThread() { return LocalSolver(Limits::None(), 1); }

double Solve(const Scene& scene) {
  SolveRequest request;
  request.scene = scene;
  return Value(OneThread().Solve(request)).outcome.contact_velocity_after.normal_m_s;
}

double Certify() {
  SolveRequest request;
  request.scene = ContactScene();
  request.certified_digits = 50;
  return Value(OneThread().Solve(request)).outcome.contact_velocity_after.normal_m_s;
}

double Enclose() {
  BoundsRequest request;
  request.scene = ContactScene();
  request.ranges = {{"friction.kinetic_coefficient", 0.45, 0.55}};
  return Value(OneThread().Bounds(request)).bounds.sharp.newton.upper;
}

double SweepOver(const Scene& scene, const std::vector<std::string>& columns) {
  SweepRequest request;
  request.grid.scene = scene;
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.05, 0.25, kPoints}}};
  request.columns = columns;
  double last = 0.0;
  for (const absl::StatusOr<SweepChunk>& chunk : OneThread().Sweep(request)) last = Value(chunk).values.back();
  return last;
}

double AuditRows() {
  AuditBatchRequest request;
  request.scene = ContactScene();
  for (size_t i = 0; i < kRows; ++i) {
    request.columns.tangential_after_m_s.push_back(0.1);
    request.columns.normal_after_m_s.push_back(0.002 * static_cast<double>(i));
  }
  return static_cast<double>(Value(OneThread().AuditBatch(request)).reports.size());
}

// Rows of which some slide on and others stop.
double SolveRows() {
  const BatchSetup setup = {.scene = ContactScene(),
                            .fields = {"planar_contact.tangential_m_s", "planar_contact.w_tn_per_kg"},
                            .columns = {"contact_velocity_after.tangential_m_s[0]", "impulse.normal_total_n_s"}};
  std::vector<double> slip(kPoints);
  std::vector<double> coupling(kPoints);
  for (size_t i = 0; i < slip.size(); ++i) {
    slip[i] = 0.001 * static_cast<double>(i);
    coupling[i] = 0.01 * static_cast<double>(i % 100) - 0.5;
  }
  std::vector<double> slip_after(kPoints);
  std::vector<double> impulse(kPoints);
  Value(OneThread().SolveBatch(
      setup, {.inputs = {slip, coupling}, .outputs = {absl::MakeSpan(slip_after), absl::MakeSpan(impulse)}}));
  return impulse.back();
}

// Rows in space of which some turn much and others little.
double SolveRowsInSpace() {
  const BatchSetup setup = {.scene = SpaceScene(),
                            .fields = {"spatial_contact.tangential_m_s[0]", "friction.kinetic_coefficient"},
                            .columns = {"contact_velocity_after.tangential_m_s[0]", "impulse.normal_total_n_s"}};
  std::vector<double> slip(kPoints);
  std::vector<double> friction(kPoints);
  for (size_t i = 0; i < slip.size(); ++i) {
    slip[i] = 0.001 * static_cast<double>(i) - 0.5;
    friction[i] = 0.1 + 0.01 * static_cast<double>(i % 50);
  }
  std::vector<double> slip_after(kPoints);
  std::vector<double> impulse(kPoints);
  Value(OneThread().SolveBatch(
      setup, {.inputs = {slip, friction}, .outputs = {absl::MakeSpan(slip_after), absl::MakeSpan(impulse)}}));
  return impulse.back();
}

const std::vector<Work>& Works() {
  static const std::vector<Work> works = {
      {"solve_pendulum", [] { return Solve(PendulumScene()); }},
      {"solve_planar_contact", [] { return Solve(ContactScene()); }},
      {"solve_spatial_contact", [] { return Solve(SpaceScene()); }},
      {"solve_linkage", [] { return Solve(LinkageScene()); }},
      {"certify", Certify},
      {"enclose", Enclose},
      {"sweep_pendulum",
       [] {
         return SweepOver(PendulumScene(), {"coefficients.newton", "coefficients.poisson", "energy_change_j"});
       }},
      {"sweep_planar_contact",
       [] {
         return SweepOver(ContactScene(), {"coefficients.newton", "energy_change_j"});
       }},
      {"audit_rows", AuditRows},
      {"plan",
       [] {
         PlanRequest request;
         request.scene = SpaceScene();
         return Value(OneThread().Plan(request)).plan.neglected;
       }},
      {"batch_planar_contact", SolveRows},
      {"batch_spatial_contact", SolveRowsInSpace},
  };
  return works;
}

// A function of its own for each piece of work, whose name callgrind reports with its number.
template <size_t kNumber>
[[gnu::noinline]] void Counted() {
  DoNotOptimize(Works()[kNumber].run());
}

template <size_t... kNumbers>
void CountAll(std::index_sequence<kNumbers...> /*numbers*/) {
  (Counted<kNumbers>(), ...);
}

int Main() {
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) {
    std::fprintf(stderr, "this processor has no AVX2, for which the instructions were counted\n");
    return kCannotRun;
  }
  if (Works().size() != kWorks) return 1;
  const OnlyTarget avx2(HWY_AVX2);
  for (const Work& work : Works()) {
    DoNotOptimize(work.run());
    std::printf("%s\n", work.name);
  }
  CountAll(std::make_index_sequence<kWorks>());
  return 0;
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::bench::Main();
}
