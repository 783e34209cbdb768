// LocalSolver and Client give the same bits, including those of a NaN and of -0.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "proto/wire/audit.h"
#include "proto/wire/fit.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "tests/contract/solvers.h"
#include "tests/core/fit/fit_cases.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr int kScenes = 2000;

// The bytes of a message hold the bits of its doubles.
std::string Bytes(const SolveResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(const BoundsResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(const AuditResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(const AuditBatchResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(const FitResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(const MultiContactResponse& response) { return ToProto(response).SerializeAsString(); }
std::string Bytes(SweepChunk chunk) {
  // The time of a clock is not a result.
  if (chunk.summary.has_value()) chunk.summary->elapsed_s.reset();
  v1::SweepResponse proto;
  ToProto(chunk, proto);
  return proto.SerializeAsString();
}

template <typename Response>
void ExpectSame(const absl::StatusOr<Response>& local, const absl::StatusOr<Response>& remote) {
  ExpectSameStatus(local.status(), remote.status());
  if (!local.ok() || !remote.ok()) return;
  EXPECT_EQ(Bytes(*local), Bytes(*remote));
}

// The two solvers may cut chunks differently, but the points, the regimes and the tallies must be equal.
struct Points {
  std::vector<std::string> values;  // The bytes of the values of each column.
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
  std::string summary;
};

Points Join(const std::vector<absl::StatusOr<SweepChunk>>& chunks, size_t columns) {
  Points points;
  points.values.resize(columns);
  for (const auto& chunk : chunks) {
    const auto count = static_cast<size_t>(chunk->count);
    for (size_t c = 0; c < columns; ++c) {
      points.values[c].append(reinterpret_cast<const char*>(chunk->values.data() + c * count), count * sizeof(double));
    }
    points.regimes.insert(points.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    points.statuses.insert(points.statuses.end(), chunk->statuses.begin(), chunk->statuses.end());
    if (!chunk->summary.has_value()) continue;
    points.summary = Bytes({.values = {}, .regimes = {}, .summary = chunk->summary, .engine = {}});
  }
  return points;
}

void ExpectSameSweep(const SweepRequest& request) {
  const auto local = Collect(Local().Sweep(request));
  const auto remote = Collect(Remote().Sweep(request));
  ASSERT_TRUE(local.back().ok()) << local.back().status();
  ASSERT_TRUE(remote.back().ok()) << remote.back().status();
  const Points here = Join(local, request.columns.size());
  const Points there = Join(remote, request.columns.size());
  EXPECT_TRUE(here.values == there.values);
  EXPECT_TRUE(here.regimes == there.regimes);
  EXPECT_TRUE(here.statuses == there.statuses);
  EXPECT_EQ(here.summary, there.summary);
  EXPECT_FALSE(here.summary.empty());
}

SweepRequest Request(std::vector<Axis> axes) {
  SweepRequest request;
  request.grid.scene = PaperScene();
  request.grid.axes = std::move(axes);
  request.columns = {"coefficients.newton", "rates_after_rad_s[0]", "impulse.tangential_n_s[0]",
                     "work.tangential_total_j", "energy_change_j"};
  request.with_regime = true;
  return request;
}

TEST(SameBits, OfSolvesOverAllDoublesAndLaws) {
  pendulum::SceneSource source(7);
  for (int i = 0; i < kScenes; ++i) {
    const pendulum::Problem problem = source.Any();
    SCOPED_TRACE(ToString(problem));
    SolveRequest request{.scene = MakeScene(problem), .history_at_n_s = {}, .inadmissible_is_error = i % 4 == 0};
    const auto local = Local().Solve(request);
    ExpectSame(local, Remote().Solve(request));
    if (!local.ok() || i % 8 != 0) continue;
    const double total = local->outcome.impulse.normal_total_n_s;
    request.history_at_n_s = {0.0, 0.3 * total, total, std::nextafter(total, 2.0 * total)};
    ExpectSame(Local().Solve(request), Remote().Solve(request));
  }
}

TEST(SameBits, OfBoundsOverAllDoubles) {
  pendulum::SceneSource source(8);
  for (int i = 0; i < kScenes; ++i) {
    const pendulum::Problem problem = source.Any();
    SCOPED_TRACE(ToString(problem));
    BoundsRequest request{.scene = MakeScene(problem)};
    if (i % 2 == 0) request.scene.restitution = std::monostate();
    ExpectSame(Local().Bounds(request), Remote().Bounds(request));
  }
}

TEST(SameBits, OfScenesThatBreakRules) {
  pendulum::SceneSource source(9);
  constexpr double kBad[] = {-1.0, 0.0, -0.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  for (int i = 0; i < 500; ++i) {
    pendulum::Problem problem = source.Any();
    double* const fields[] = {&problem.inertia, &problem.a,         &problem.b,          &problem.omega_minus,
                              &problem.mu,      &problem.mu_static, &problem.coefficient};
    for (int j = 0; j < 2; ++j) *fields[source.Below(7)] = kBad[source.Below(5)];
    SCOPED_TRACE(ToString(problem));
    const Scene scene = MakeScene(problem);
    ExpectSame(Local().Solve({.scene = scene, .history_at_n_s = {}}),
               Remote().Solve({.scene = scene, .history_at_n_s = {}}));
    ExpectSame(Local().Bounds({.scene = scene}), Remote().Bounds({.scene = scene}));
  }
}

TEST(SameBits, OfASweepOverAProductOfAList_ALinspaceAndALogspace) {
  ExpectSameSweep(Request({{"friction.kinetic_coefficient", ListValues{{0.1, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0}}},
                           {"pendulum.b_m", Linspace{-2.0, 2.0, 41}},
                           {"pendulum.inertia_kg_m2", Logspace{1e-300, 1e300, 31}}}));
}

TEST(SameBits, OfASweepOverTheAngle) {
  ExpectSameSweep(Request({{"friction.kinetic_coefficient", ListValues{{0.1, 1.0}}},
                           {"pendulum.phi_rad", Linspace{0.01, 1.5707963267948966, 30000}}}));
}

TEST(SameBits, OfAZippedSweep) {
  SweepRequest request = Request(
      {{"restitution.newton", Linspace{0.0, 2.0, 5000}}, {"pendulum.omega_minus_rad_s", Linspace{-1.0, 0.1, 5000}}});
  request.grid.combination = Combination::kZip;
  ExpectSameSweep(request);
}

TEST(SameBits, OfPointsThatBreakRules) { ExpectSameSweep(Request({{"pendulum.a_m", Linspace{-1.0, 1.0, 20001}}})); }

TEST(SameBits, OfASubRange) {
  SweepRequest request = Request(
      {{"restitution.poisson", Linspace{0.0, 2.0, 300}}, {"friction.kinetic_coefficient", Logspace{1e-9, 1.0, 300}}});
  request.first_index = 12'345;
  request.end_index = 78'901;
  ExpectSameSweep(request);
}

TEST(SameBits, OfSolvesOfEverySystem) {
  for (const System& system : Systems()) {
    for (const double mu : {0.0, 0.2, 0.9}) {
      SolveRequest request{.scene = With(system), .demand = {.relative_tolerance = 1e-8}};
      request.scene.friction.kinetic_coefficient = mu;
      ExpectSame(Local().Solve(request), Remote().Solve(request));
    }
  }
}

TEST(SameBits, OfBoundsOfEverySystemAndOfEnclosures) {
  for (const System& system : Systems()) {
    for (const double mu : {0.0, 0.2, 0.9}) {
      BoundsRequest request{.scene = With(system), .ranges = {}};
      request.scene.friction.kinetic_coefficient = mu;
      ExpectSame(Local().Bounds(request), Remote().Bounds(request));
      request.ranges = {{"friction.kinetic_coefficient", 0.5 * mu, mu}};
      ExpectSame(Local().Bounds(request), Remote().Bounds(request));
    }
  }
}

TEST(SameBits, OfSweepsOverEverySystem) {
  for (const System& system : Systems()) {
    SweepRequest request;
    request.grid.scene = With(system);
    request.grid.axes = {{"friction.kinetic_coefficient", Linspace{-0.1, 1.0, 23}},
                         {"restitution.newton", ListValues{{0.0, 0.5, 1.0}}}};
    request.columns = Columns(request.grid.scene);
    request.with_regime = true;
    ExpectSameSweep(request);
  }
}

TEST(SameBits, OfImpactLawsAndSpeedDependence) {
  Scene law = With(Flat());
  law.restitution = std::monostate();
  law.impact_law = ChatterjeeRuinaLaw{0.5, 0.25};
  Scene by_speed = With(Chain());
  by_speed.friction.by_speed = SpeedTable{{0.0, 2.0}, {1.0, 0.5}};
  by_speed.restitution_by_speed = PowerLaw{0.1, 0.2};
  by_speed.surface_velocity = SurfaceVelocity{{0.1}, 0.0};
  for (const Scene& scene : {law, by_speed}) {
    const auto local = Local().Solve({.scene = scene});
    ASSERT_TRUE(local.ok()) << local.status();
    ExpectSame(local, Remote().Solve({.scene = scene}));
  }
}

TEST(SameBits, OfAuditsOfEverySystemAndOfTheirErrors) {
  for (const System& system : Systems()) {
    const Scene scene = With(system);
    const auto solved = Local().Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(solved.ok()) << solved.status();
    ContactVelocity seen = solved->outcome.contact_velocity_after;
    for (const double factor : {1.0, 0.3, -1.0, 7.0}) {
      seen.normal_m_s = factor * solved->outcome.contact_velocity_after.normal_m_s;
      const AuditRequest request = {.scene = scene, .observed = seen, .velocity_uncertainty_m_s = 1e-3};
      ExpectSame(Local().Audit(request), Remote().Audit(request));
      AuditBatchRequest batch = {.scene = scene, .columns = {}};
      const bool in_space = seen.tangential_m_s.size() == 2;
      batch.columns.tangential_after_m_s = {seen.tangential_m_s[0]};
      if (in_space) batch.columns.tangential_2_after_m_s = {seen.tangential_m_s[1]};
      batch.columns.normal_after_m_s = {seen.normal_m_s, 1.0, std::nan(""), -0.0};
      ExpectSame(Local().AuditBatch(batch), Remote().AuditBatch(batch));
    }
  }
  ExpectSame(Local().Audit({}), Remote().Audit({}));
  ExpectSame(Local().AuditBatch({}), Remote().AuditBatch({}));
}

TEST(SameBits, OfFitsAndOfTheirErrors) {
  using fit::Noiseless;
  for (const fit::Case& given : {fit::ContactCase(), fit::SpaceCase(), fit::CompliantCase()}) {
    FitRequest request = Noiseless(given);
    request.measured[0].values[1] += 0.01;
    request.measured[1].values[0] = std::nan("");
    request.starts = 2;
    request.region = {request.unknowns[0].path, request.unknowns[1].path};
    ASSERT_TRUE(Local().Fit(request).ok()) << Local().Fit(request).status();
    ExpectSame(Local().Fit(request), Remote().Fit(request));
    request.inputs[0].sigma = {0.01};
    request.starts.reset();
    request.region.clear();
    ASSERT_TRUE(Local().Fit(request).ok()) << Local().Fit(request).status();
    ExpectSame(Local().Fit(request), Remote().Fit(request));
    request.measured[0].sigma = {-1.0};
    ExpectSame(Local().Fit(request), Remote().Fit(request));
  }
  ExpectSame(Local().Fit({}), Remote().Fit({}));
}

TEST(SameBits, OfSeveralContactsAndOfTheirErrors) {
  MultiContactRequest block = {.scene = FallingBlock(0.7, 0.3, 3.0),
                               .states = {{{0.2, -1.0, 0.4}}, {{-0.1, -0.5, 0.0}}},
                               .outputs = {{.name = "top", .coefficients = {1.0, 0.0, -1.0}}},
                               .stiffness_range = StiffnessRange{.contact = 2, .low = 0.1, .high = 10.0}};
  ExpectSame(Local().MultiContact(block), Remote().MultiContact(block));
  const MultiContactRequest balls = {.scene = RowOfBalls({1, 2, 1}, {1, 0, -1}, {1, 0.5})};
  ExpectSame(Local().MultiContact(balls), Remote().MultiContact(balls));
  ExpectSame(Local().MultiContact({.scene = SpatialBox()}), Remote().MultiContact({.scene = SpatialBox()}));
  block.scene.contacts.front().friction = -1.0;
  block.methods = {MultiContactMethod::kUnspecified};
  ExpectSame(Local().MultiContact(block), Remote().MultiContact(block));
  ExpectSame(Local().MultiContact({}), Remote().MultiContact({}));
}

}  // namespace
}  // namespace ricochet
