// The bits of all answers are the same everywhere: 10^5 scenes give the hashes in tests/data/golden/bits.txt, 10^4
// pendulums those in pendulum_bits.txt, and sweeps with every column of every system those in columns.txt, whatever the
// build, the SIMD target, the threads and the order are. RICOCHET_UPDATE_GOLDEN=1 writes the files anew.
//
// The scenes cover every system, law and effect. They are made of sums and products of random bits, so that they are
// the same everywhere, too.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/stable_hash.h"
#include "core/engine/sweep_run.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "core/rows/column.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "hwy/targets.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/support/only_target.h"
#include "tests/support/paths.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr size_t kScenes = 100'000;

// Nothing here depends on the standard library's distributions.
class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}
  double Uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  uint64_t Below(uint64_t bound) { return bits_() % bound; }

 private:
  std::mt19937_64 bits_;
};

std::vector<System> AllSystems() {
  std::vector<System> systems = Systems();
  systems.push_back(Pendulum{2.0, 0.3, 1.0, -1.0});
  Linkage chain = Chain();
  chain.links.push_back({0.7, 0.5, 0.3, 0.05, -0.4, -1.5});
  chain.links.push_back({0.9, 0.3, 0.4, 0.02, 0.8, -0.5});
  systems.push_back(chain);
  return systems;
}

bool IsPlanar(const System& system) { return TangentialDirections(system) == 1; }

Restitution AnyRestitution(Random& random) {
  const double value = random.Below(8) == 0 ? 1.0 : random.Uniform(0.0, 1.0);
  switch (random.Below(3)) {
    case 0:
      return NewtonCoefficient{value};
    case 1:
      return PoissonCoefficient{value};
    default:
      return EnergeticCoefficient{value};
  }
}

ImpactLaw AnyImpactLaw(Random& random) {
  const double e = random.Uniform(0.0, 1.0);
  switch (random.Below(4)) {
    case 0:
      return WhittakerLaw{e};
    case 1:
      return KaneLevinsonLaw{e};
    case 2:
      return BrachLaw{e, random.Uniform(-0.5, 0.5)};
    default:
      return ChatterjeeRuinaLaw{e, random.Uniform(-1.0, 1.0)};
  }
}

// Adds effects to the scene, each to a part of the scenes only.
void AddEffects(Random& random, Scene& scene) {
  const bool planar = IsPlanar(scene.system);
  if (random.Below(4) == 0) scene.friction.static_coefficient = scene.friction.kinetic_coefficient * 1.25;
  if (random.Below(8) == 0) scene.friction.by_speed = PowerLaw{random.Uniform(0.0, 0.1), random.Uniform(0.0, 1.0)};
  if (random.Below(8) == 0) scene.restitution_by_speed = PowerLaw{random.Uniform(0.0, 0.1), random.Uniform(0.0, 1.0)};
  if (planar && random.Below(6) == 0) {
    scene.restitution = std::monostate();
    scene.restitution_by_speed.reset();
    scene.impact_law = AnyImpactLaw(random);
  } else if (planar && random.Below(6) == 0) {
    scene.restitution = EnergeticCoefficient{random.Uniform(0.1, 1.0)};
    scene.friction.static_coefficient.reset();
    scene.compliance = Compliance{.tangential_ratio_squared = random.Uniform(0.5, 1.5)};
  }
}

// One of the systems, with each number changed by up to `spread` of its size; the result is valid.
Scene AnyScene(Random& random, const System& system) {
  while (true) {
    Scene scene = {.system = system};
    const double spread = random.Below(4) == 0 ? 0.0 : random.Uniform(0.0, 0.5);
    VisitNumbers(scene, [&](const NumberPath&, double& number, NumberRule) {
      number += number * random.Uniform(-spread, spread);
    });
    scene.friction.kinetic_coefficient = random.Below(8) == 0 ? 0.0 : random.Uniform(0.0, 1.5);
    scene.restitution = AnyRestitution(random);
    AddEffects(random, scene);
    if (Validate(scene).empty()) return scene;
  }
}

struct Question {
  Scene scene;
  DemandFields demand;
};

std::vector<Question> Questions() {
  constexpr std::array kTolerances = {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1};
  const std::vector<System> systems = AllSystems();
  std::vector<Question> questions;
  for (size_t i = 0; i < kScenes; ++i) {
    Random random(i);
    questions.push_back({.scene = AnyScene(random, systems[i % systems.size()]),
                         .demand = {.relative_tolerance = kTolerances[random.Below(kTolerances.size())]}});
  }
  // Only a caller who excludes the higher orders of a pendulum gets its form of first order.
  for (size_t i = 0; i < 500; ++i) {
    Random random(kScenes + i);
    Scene scene = With(Pendulum{1.0, random.Uniform(0.5, 1.5), random.Uniform(0.1, 0.3), random.Uniform(-2.0, -0.5)});
    scene.friction.kinetic_coefficient = random.Uniform(0.1, 0.5);
    questions.push_back({.scene = scene, .demand = {.relative_tolerance = 0.0, .excluded = {Effect::kHigherOrder}}});
  }
  // Impacts that take time.
  for (size_t i = 0; i < 1000; ++i) {
    Random random(2 * kScenes + i);
    Scene scene = With(Flat());
    scene.friction.kinetic_coefficient = random.Uniform(0.0, 1.0);
    scene.restitution = EnergeticCoefficient{random.Uniform(0.1, 1.0)};
    scene.compliance = Compliance{.normal = LinearSpring{1e5 * random.Uniform(0.5, 2.0)}};
    if (i % 4 == 1) scene.compliance->normal = HertzSpring{1e7 * random.Uniform(0.5, 2.0)};
    if (i % 4 == 2) scene.compliance->tangential_ratio_squared = random.Uniform(0.5, 1.5);
    if (i % 4 == 3) {
      scene.restitution = std::monostate();
      scene.compliance->normal = HuntCrossleySpring{1e6, random.Uniform(1.0, 4.0), random.Uniform(0.0, 0.5)};
    }
    if (random.Below(2) == 0) scene.finite_forces = Gravity{0.0, -9.81};
    questions.push_back(
        {.scene = scene, .demand = {.relative_tolerance = 1e-9, .required = {Effect::kFiniteDuration}}});
  }
  return questions;
}

void Add(const State& state, StableHash& hash) {
  hash.Add(state.normal_impulse_n_s);
  for (const double f : state.tangential_impulse_n_s) hash.Add(f);
  for (const double u : state.contact_velocity.tangential_m_s) hash.Add(u);
  hash.Add(state.contact_velocity.normal_m_s);
  for (const double rate : state.rates_rad_s) hash.Add(rate);
}

struct Answer {
  uint64_t hash = 0;
  Model model = Model::kUnspecified;
  friend bool operator==(const Answer&, const Answer&) = default;
};

// A number that is unset has the bits of 0: one of a phase under an impact law, and one of a contact that takes no
// time.
Outcome WithEveryNumber(Outcome outcome) {
  for (auto* number :
       {&outcome.coefficients.poisson, &outcome.coefficients.energetic, &outcome.impulse.normal_compression_n_s,
        &outcome.work.normal_compression_j, &outcome.work.normal_restitution_j, &outcome.work.tangential_compression_j,
        &outcome.work.tangential_restitution_j}) {
    *number = number->value_or(0.0);
  }
  if (!outcome.contact.has_value()) outcome.contact.emplace();
  outcome.effective.restitution = outcome.effective.restitution.value_or(0.0);
  return outcome;
}

Answer AnswerTo(const Question& question) {
  const auto response = LocalSolver().Solve({.scene = question.scene, .demand = question.demand});
  StableHash hash;
  if (!response.ok()) {
    hash.Add(static_cast<uint64_t>(response.status().code()));
    return {hash.value(), Model::kUnspecified};
  }
  const Outcome outcome = WithEveryNumber(response->outcome);
  hash.Add(static_cast<uint64_t>(outcome.regime));
  hash.Add(static_cast<uint64_t>(outcome.w_rank));
  VisitOutcomeNumbers(outcome, [&hash](const NumberPath& path, double number) {
    if (std::string_view(path.prefix) != "errors") hash.Add(number);
  });
  hash.Add(outcome.work.residual_j);
  hash.Add(static_cast<uint64_t>(outcome.accuracy.right_hand_sides));
  for (const BrokenLimit& limit : outcome.broken_limits) hash.Add(limit.excess);
  for (const Event& event : outcome.timeline) {
    hash.Add(static_cast<uint64_t>(event.kind));
    Add(event.state, hash);
  }
  hash.Add(outcome.plan.neglected);
  for (const PlannedEffect& effect : outcome.plan.effects.List()) hash.Add(effect.size);
  return {hash.value(), outcome.plan.model};
}

// Answers in `threads` threads, each of which takes every threads-th question.
std::vector<Answer> AnswersTo(const std::vector<Question>& questions, size_t threads) {
  std::vector<Answer> answers(questions.size());
  std::vector<std::thread> workers;
  for (size_t first = 0; first < threads; ++first) {
    workers.emplace_back([&, first] {
      for (size_t i = first; i < questions.size(); i += threads) answers[i] = AnswerTo(questions[i]);
    });
  }
  for (std::thread& worker : workers) worker.join();
  return answers;
}

// One line for each model at tolerance 0, and one at the others: its number, how many scenes it solved, and their hash.
std::string Summary(const std::vector<Question>& questions, const std::vector<Answer>& answers) {
  std::map<std::pair<int, bool>, std::pair<int, StableHash>> by_model;
  for (size_t i = 0; i < answers.size(); ++i) {
    const bool is_within = questions[i].demand.relative_tolerance != 0.0;
    auto& [count, hash] = by_model[{static_cast<int>(answers[i].model), is_within}];
    ++count;
    hash.Add(answers[i].hash);
  }
  std::string text;
  for (const auto& [key, entry] : by_model) {
    absl::StrAppend(&text, "model ", key.first, key.second ? " above tolerance 0: " : " at tolerance 0: ", entry.first,
                    " scenes, ", absl::Hex(entry.second.value(), absl::kZeroPad16), "\n");
  }
  return text;
}

std::string Golden(const std::string& name, const std::string& text) {
  const std::string path = TestDataPath("golden/" + name);
  if (std::getenv("RICOCHET_UPDATE_GOLDEN") != nullptr) std::ofstream(path) << text;
  std::ifstream file(path);
  std::ostringstream golden;
  golden << file.rdbuf();
  return golden.str();
}

TEST(GoldenBitsTest, A100000ScenesHaveTheBitsOfEveryOtherBuildThreadAndTarget) {
  const std::vector<Question> questions = Questions();
  const std::vector<Answer> answers = AnswersTo(questions, 4);
  const std::string summary = Summary(questions, answers);
  EXPECT_EQ(summary, Golden("bits.txt", summary));
  for (int model = static_cast<int>(Model::kNone); model < kModelCount; ++model) {
    EXPECT_NE(summary.find(absl::StrCat("model ", model, " ")), std::string::npos) << model;
  }
  constexpr size_t kEvery = 7;
  std::vector<Question> some;
  std::vector<Answer> expected;
  for (size_t i = 0; i < questions.size(); i += kEvery) {
    some.push_back(questions[i]);
    expected.push_back(answers[i]);
  }
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    EXPECT_TRUE(AnswersTo(some, 1) == expected) << hwy::TargetName(target);
  }
}

// Pendulums of everyday size, some of them close to locking or to a limit, and some that separate.
std::vector<pendulum::Problem> Pendulums() {
  std::vector<pendulum::Problem> problems;
  for (size_t i = 0; i < kScenes / 10; ++i) {
    Random random(i);
    pendulum::Problem problem = {.inertia = random.Uniform(0.1, 5.0),
                                 .a = random.Uniform(0.1, 2.0),
                                 .b = random.Uniform(-1.0, 1.0),
                                 .omega_minus = random.Uniform(-10.0, 0.2),
                                 .law = static_cast<RestitutionLaw>(random.Below(3)),
                                 .coefficient = random.Below(4) == 0 ? 1.0 : random.Uniform(0.0, 1.0)};
    problem.mu = random.Below(4) == 0 ? problem.a * random.Uniform(0.999999, 1.000001) / std::fabs(problem.b)
                                      : random.Uniform(0.0, 1.0);
    problem.mu_static = problem.mu;
    problems.push_back(problem);
  }
  return problems;
}

TEST(GoldenBitsTest, PendulumsHaveTheBitsOfEveryOtherBuildInBothArithmetics) {
  StableHash compensated;
  StableHash plain;
  int proved = 0;
  for (const pendulum::Problem& problem : Pendulums()) {
    for (const double value : pendulum::Solve(problem).values) compensated.Add(value);
    const pendulum::PlainImpact impact = pendulum::SolvePlain(problem);
    if (!impact.proved) continue;
    ++proved;
    plain.Add(impact.relative_error);
    for (const double value : impact.impact.values) plain.Add(value);
  }
  const std::string summary =
      absl::StrCat("compensated: ", absl::Hex(compensated.value(), absl::kZeroPad16), "\nplain: ", proved, " proved, ",
                   absl::Hex(plain.value(), absl::kZeroPad16), "\n");
  EXPECT_EQ(summary, Golden("pendulum_bits.txt", summary));
}

// All values of the points [first, end).
std::vector<uint64_t> BitsOf(SweepRequest request, int64_t first, int64_t end) {
  request.first_index = first;
  request.end_index = end;
  absl::StatusOr<SweepRun> run = SweepRun::Make(request);
  EXPECT_TRUE(run.ok()) << run.status();
  std::vector<std::vector<uint64_t>> columns(request.columns.size());
  while (!run->ended()) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk([] { return false; });
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    for (size_t i = 0; i < chunk->values.size(); ++i) {
      columns[i / static_cast<size_t>(chunk->count)].push_back(std::bit_cast<uint64_t>(chunk->values[i]));
    }
  }
  std::vector<uint64_t> bits;
  for (const auto& column : columns) bits.insert(bits.end(), column.begin(), column.end());
  return bits;
}

std::string HashOf(const std::vector<uint64_t>& bits) {
  StableHash hash;
  for (const uint64_t value : bits) hash.Add(value);
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

TEST(GoldenBitsTest, SweepsOfEverySystemHaveTheBitsOfEveryOtherBuildSubRangeAndTarget) {
  constexpr int64_t kPoints = 600;
  std::string summary;
  for (const System& system : AllSystems()) {
    for (const double tolerance : {1e-12, 1e-3}) {
      const Scene scene = With(system);
      const SweepRequest request = {
          .grid = {.scene = scene, .axes = {{"friction.kinetic_coefficient", Logspace{1e-6, 1.5, kPoints}}}},
          .columns = Columns(scene),
          .demand = {.relative_tolerance = tolerance}};
      const std::vector<uint64_t> whole = BitsOf(request, 0, kPoints);
      absl::StrAppend(&summary, "system ", system.index(), " at tolerance ", tolerance, ": ", request.columns.size(),
                      " columns, ", HashOf(whole), "\n");
      for (const int64_t cut : {1, 7, 333}) {
        const std::vector<uint64_t> low = BitsOf(request, 0, cut);
        const std::vector<uint64_t> high = BitsOf(request, cut, kPoints);
        std::vector<uint64_t> joined;
        for (size_t c = 0; c < request.columns.size(); ++c) {
          const auto part = [c](const std::vector<uint64_t>& bits, int64_t rows) {
            const auto begin = bits.begin() + static_cast<int64_t>(c) * rows;
            return std::vector<uint64_t>(begin, begin + rows);
          };
          for (const uint64_t value : part(low, cut)) joined.push_back(value);
          for (const uint64_t value : part(high, kPoints - cut)) joined.push_back(value);
        }
        ASSERT_TRUE(joined == whole) << "system " << system.index() << ", cut at " << cut;
      }
      for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
        const OnlyTarget only(target);
        ASSERT_TRUE(BitsOf(request, 0, kPoints) == whole) << hwy::TargetName(target);
      }
    }
  }
  EXPECT_EQ(summary, Golden("columns.txt", summary));
}

}  // namespace
}  // namespace ricochet
