// A stop that another thread asks for ends each expensive call long before it would end by itself.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <ostream>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "core/answer/derivatives.h"
#include "core/answer/scene_bounds.h"
#include "core/answer/scene_enclosure.h"
#include "core/answer/scene_outcome.h"
#include "core/certified/certified.h"
#include "core/multi/solve_multi_contact.h"
#include "ricochet/solver.h"
#include "tests/core/fit/fit_cases.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

Scene ChainScene(size_t links) {
  return {.system = Chain(links), .friction = {.kinetic_coefficient = 0.2}, .restitution = EnergeticCoefficient{0.5}};
}

// A contact whose tangential spring is a million times stiffer than the normal one, so that each impact takes
// milliseconds.
Scene StiffContact() {
  Scene scene = {
      .system =
          PlanarContact{
              .w_tt_per_kg = 2.5, .w_tn_per_kg = 1.0, .w_nn_per_kg = 2.5, .tangential_m_s = -0.5, .normal_m_s = -1.0},
      .friction = {.kinetic_coefficient = 0.3},
      .restitution = EnergeticCoefficient{0.5}};
  scene.compliance = Compliance{.tangential_ratio_squared = 1e-6, .normal = LinearSpring{1e4}};
  scene.finite_forces = ContactAcceleration{.tangential_m_s2 = 0.0, .normal_m_s2 = -9.81};
  return scene;
}

BoundsRequest WideBounds() {
  BoundsRequest request = {.scene = ChainScene(64)};
  for (int i = 0; i < 32; ++i) {
    request.ranges.push_back({"linkage.links[" + std::to_string(i) + "].mass_kg", 0.8, 1.2});
  }
  return request;
}

// Observations of a contact in space whose W has rank two: each row is searched for along an integrated path.
AuditBatchRequest DeficientRows() {
  AuditBatchRequest request;
  request.scene.system =
      SpatialContact{.w_per_kg = {1.0, 0.0, 0.5, 1.0, 0.0, 0.25}, .tangential_m_s = {-1.0, 0.0}, .normal_m_s = -0.5};
  request.scene.friction.kinetic_coefficient = 0.3;
  request.columns.tangential_after_m_s.assign(8192, 0.3);
  request.columns.tangential_2_after_m_s.assign(8192, 0.1);
  request.columns.normal_after_m_s.assign(8192, 0.4);
  return request;
}

absl::Status Sweep(const Scene& scene, const CallOptions& options) {
  const Axis axis = {.path = "friction.kinetic_coefficient", .values = Linspace{0.1, 0.4, 1'000'000'000}};
  absl::Status last;
  for (const absl::StatusOr<SweepChunk>& chunk :
       LocalSolver().Sweep({.grid = {.scene = scene, .axes = {axis}}, .columns = {"energy_change_j"}}, options)) {
    last = chunk.status();
  }
  return last;
}

struct DearCall {
  std::string name;
  std::function<absl::Status(const CallOptions&)> run;
};

void PrintTo(const DearCall& call, std::ostream* out) { *out << call.name; }

std::vector<DearCall> ExpensiveCalls() {
  const LocalSolver solver;
  return {
      {"CertifiedChain",
       [solver](const CallOptions& options) {
         return solver.Solve({.scene = ChainScene(400), .certified_digits = 1000}, options).status();
       }},
      {"ForcesOfAStiffContact",
       [solver](const CallOptions& options) {
         return solver.Solve({.scene = StiffContact(), .force_intervals = 65'535}, options).status();
       }},
      {"EnclosureOfAChain",
       [solver](const CallOptions& options) { return solver.Bounds(WideBounds(), options).status(); }},
      {"AuditOfManyRowsInSpace",
       [solver](const CallOptions& options) { return solver.AuditBatch(DeficientRows(), options).status(); }},
      {"SweepOfAStiffContact", [](const CallOptions& options) { return Sweep(StiffContact(), options); }},
      {"SweepOfAChain", [](const CallOptions& options) { return Sweep(ChainScene(64), options); }},
      {"ManyStatesOfABoxInSpace",
       [solver](const CallOptions& options) {
         const MultiContactState state = {.velocity = {0.4, 0.1, -1.0, 0.3, -0.2, 0.0}};
         return solver
             .MultiContact({.scene = SpatialBox(), .states = std::vector<MultiContactState>(4096, state)}, options)
             .status();
       }},
      {"StudyOfCost",
       [solver](const CallOptions& options) {
         absl::Status last;
         for (const absl::StatusOr<CostChunk>& chunk :
              solver.Cost({.scene = ChainScene(64), .time_limit_s = kMostCostTimeLimitS, .samples = 1001}, options)) {
           last = chunk.status();
         }
         return last;
       }},
  };
}

class StopTest : public testing::TestWithParam<DearCall> {};

TEST_P(StopTest, EndsADearCallSoon) {
  std::stop_source source;
  steady_clock::time_point asked;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(milliseconds(100));
    asked = steady_clock::now();
    source.request_stop();
  });
  const absl::Status status = GetParam().run({.stop = source.get_token()});
  const steady_clock::time_point ended = steady_clock::now();
  stopper.join();
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled) << status;
  const double late_ms = std::chrono::duration<double, std::milli>(ended - asked).count();
  std::printf("%s ended %.1f ms after it was asked to\n", GetParam().name.c_str(), late_ms);
  EXPECT_LT(late_ms, 5000.0);
}

TEST_P(StopTest, EndsADearCallAtItsDeadline) {
  const steady_clock::time_point deadline = steady_clock::now() + milliseconds(100);
  const absl::Status status = GetParam().run({.deadline = deadline});
  const double late_ms = std::chrono::duration<double, std::milli>(steady_clock::now() - deadline).count();
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded) << status;
  std::printf("%s ended %.1f ms after its deadline\n", GetParam().name.c_str(), late_ms);
  EXPECT_LT(late_ms, 5000.0);
}

INSTANTIATE_TEST_SUITE_P(Expensive, StopTest, testing::ValuesIn(ExpensiveCalls()),
                         [](const auto& tested) { return tested.param.name; });

// --- A stop at any question ---

// Work that asks whether to stop.
struct AskingWork {
  std::string name;
  std::function<absl::Status(absl::FunctionRef<bool()>)> run;
};

void PrintTo(const AskingWork& work, std::ostream* out) { *out << work.name; }

Scene SpaceScene() {
  return {
      .system = ContactInSpace(), .friction = {.kinetic_coefficient = 0.5}, .restitution = EnergeticCoefficient{0.5}};
}

// A contact on springs, so that an impact takes time.
Scene SprungContact() {
  Scene scene = {
      .system = Contact(), .friction = {.kinetic_coefficient = 0.4}, .restitution = EnergeticCoefficient{0.5}};
  scene.compliance = Compliance{.tangential_ratio_squared = 0.7, .normal = LinearSpring{1e4}};
  scene.finite_forces = ContactAcceleration{.tangential_m_s2 = 0.0, .normal_m_s2 = -9.81};
  return scene;
}

const DerivativePaths kDerivatives = {
    .of = {"contact_velocity_after.normal_m_s"}, .by = {"friction.kinetic_coefficient"}, .find_thresholds = true};

std::vector<AskingWork> AskingWorks() {
  return {
      {"ImpactInTime",
       [](absl::FunctionRef<bool()> stopped) {
         std::optional<SceneContact> contact;
         Outcome outcome;
         return SolveScene(SprungContact(), contact, {.required = {Effect::kFiniteDuration}}, {}, stopped, outcome);
       }},
      {"Certificate",
       [](absl::FunctionRef<bool()> stopped) {
         return CertifySolve(ChainScene(3), {.digits = 100}, stopped).status();
       }},
      {"CertificateOfBounds",
       [](absl::FunctionRef<bool()> stopped) {
         return CertifyBounds(ChainScene(3), {.digits = 100}, stopped).status();
       }},
      {"BoundsInSpace",
       [](absl::FunctionRef<bool()> stopped) { return SolveSceneBounds(SpaceScene(), {}, stopped).status(); }},
      {"Enclosure",
       [](absl::FunctionRef<bool()> stopped) {
         const std::vector<FieldRange> ranges = {{"linkage.links[0].mass_kg", 0.8, 1.2}};
         return EncloseScene(ChainScene(2), ranges, 300, stopped).status();
       }},
      {"DerivativesInSpace",
       [](absl::FunctionRef<bool()> stopped) {
         return DerivativesOf(SpaceScene(), {}, kDerivatives, stopped).status();
       }},
      {"DerivativesInTime",
       [](absl::FunctionRef<bool()> stopped) {
         return DerivativesOf(SprungContact(), {}, kDerivatives, stopped).status();
       }},
      {"SeveralContacts",
       [](absl::FunctionRef<bool()> stopped) {
         const MultiContactRequest request = {
             .scene = FallingBlock(1.0, 0.5),
             .stiffness_range = StiffnessRange{.contact = 2, .low = 0.1, .high = 10.0}};
         return SolveMultiContact(request, Reduce(request.scene), stopped).status();
       }},
      {"SeveralContactsInSpace",
       [](absl::FunctionRef<bool()> stopped) {
         const MultiContactRequest request = {.scene = SpatialBox()};
         return SolveMultiContact(request, Reduce(request.scene), stopped).status();
       }},
      {"Fit",
       [](absl::FunctionRef<bool()> stopped) {
         const FitRequest request = {
             .scene = {.system = Contact(),
                       .friction = {.kinetic_coefficient = 0.2},
                       .restitution = NewtonCoefficient{}},
             .unknowns = {{.path = "restitution.newton", .start = 0.4}},
             .inputs = {{.path = "planar_contact.normal_m_s", .values = {-1.0, -2.0, -3.0}}},
             .measured = {{.path = "contact_velocity_after.normal_m_s", .values = {0.5, 1.1, 1.4}, .sigma = {0.1}}},
             .starts = 3};
         return fit::Fit(request, stopped).status();
       }},
  };
}

class QuestionTest : public testing::TestWithParam<AskingWork> {};

TEST_P(QuestionTest, MayBeAnsweredWithAStop) {
  int asked = 0;
  const absl::Status whole = GetParam().run([&asked] { return ++asked < 0; });
  ASSERT_TRUE(whole.ok()) << whole;
  ASSERT_GT(asked, 0);
  const int all = asked;
  for (int stop = 1; stop <= all; stop += 1 + stop / 10) {
    asked = 0;
    const absl::Status stopped = GetParam().run([&] { return ++asked >= stop; });
    EXPECT_EQ(stopped.code(), absl::StatusCode::kCancelled) << "at question " << stop << " of " << all;
  }
}

INSTANTIATE_TEST_SUITE_P(All, QuestionTest, testing::ValuesIn(AskingWorks()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Chunks, OfDearPointsAreCutByTime) {
  const Axis axis = {.path = "friction.kinetic_coefficient", .values = Linspace{0.2, 0.4, 100'000}};
  int chunks = 0;
  int64_t points = 0;
  for (const absl::StatusOr<SweepChunk>& chunk :
       LocalSolver().Sweep({.grid = {.scene = StiffContact(), .axes = {axis}}, .columns = {"energy_change_j"}})) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    EXPECT_EQ(chunk->first_index, points);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(chunk->count));
    points += chunk->count;
    if (++chunks == 3) break;
  }
  EXPECT_EQ(chunks, 3);
  EXPECT_LT(points, 100'000) << "so many of these points take minutes";
}

}  // namespace
}  // namespace ricochet
