// Ricochet itself: the closed form as a kernel, one impact after another and in SIMD lanes, and LocalSolver::Solve with
// all that an answer holds. Each run solves many impacts, because the clock is coarser than one.

#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"
#include "tests/peers/exact.h"
#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

using pendulum::Output;
using pendulum::Problem;

class KernelPeer final : public Peer {
 public:
  enum class How { kLanes, kPlain, kDoubleDouble };
  KernelPeer(Setup setup, How how) : Peer(std::move(setup)), how_(how) {}

  void Prepare(const PendulumCase& c) override {
    problems_.assign(kImpacts, {.inertia = kInertiaAboutPin,
                                .a = c.a,
                                .b = c.b,
                                .omega_minus = kOmegaBefore,
                                .mu = c.friction,
                                .mu_static = c.friction,
                                .law = RestitutionLaw::kEnergetic,
                                .coefficient = c.restitution});
    columns_ = pendulum::ProblemColumns(RestitutionLaw::kEnergetic, kImpacts);
    for (size_t i = 0; i < kImpacts; ++i) columns_.Set(i, problems_[i]);
  }
  void Reset() override {}
  void Run() override {
    switch (how_) {
      case How::kLanes:
        SolveInLanes();
        break;
      case How::kPlain:
        for (size_t i = 0; i < kImpacts; ++i) {
          omega_[i] = pendulum::SolvePlain(problems_[i]).impact[Output::kOmegaPlus];
        }
        break;
      case How::kDoubleDouble:
        for (size_t i = 0; i < kImpacts; ++i) omega_[i] = pendulum::Solve(problems_[i])[Output::kOmegaPlus];
        break;
    }
    bench::DoNotOptimize(omega_.back());
  }
  AfterImpact After() const override { return AfterAt(omega_.back()); }
  int impacts_per_run() const override { return kImpacts; }

 private:
  static constexpr int kImpacts = 1000;

  // Tolerance 0 asks for double-double arithmetic.
  void SolveInLanes() {
    const Output outputs[] = {Output::kOmegaPlus};
    double* const places[] = {omega_.data()};
    pendulum::SolveColumns(columns_, 0, kImpacts, /*tolerance=*/0.0,
                           {.outputs = outputs,
                            .columns = places,
                            .regimes = absl::MakeSpan(regimes_),
                            .inadmissible = {inadmissible_.get(), kImpacts}});
  }

  const How how_;
  std::vector<Problem> problems_;
  pendulum::ProblemColumns columns_;
  std::vector<double> omega_ = std::vector<double>(kImpacts);
  std::vector<Regime> regimes_ = std::vector<Regime>(kImpacts);
  std::unique_ptr<bool[]> inadmissible_ = std::make_unique<bool[]>(kImpacts);
};

class SolverPeer final : public Peer {
 public:
  using Peer::Peer;

  void Prepare(const PendulumCase& c) override { request_.scene = SceneOf(c); }
  void Reset() override {}
  void Run() override {
    for (int i = 0; i < kImpacts; ++i) {
      const auto response = solver_.Solve(request_);
      // A refused request leaves a NaN, which no table can overlook.
      omega_ = response.ok() ? response->outcome.rates_after_rad_s[0] : std::numeric_limits<double>::quiet_NaN();
    }
    bench::DoNotOptimize(omega_);
  }
  AfterImpact After() const override { return AfterAt(omega_); }
  int impacts_per_run() const override { return kImpacts; }

 private:
  static constexpr int kImpacts = 100;

  LocalSolver solver_;
  SolveRequest request_;
  double omega_ = 0.0;
};

}  // namespace

Peers RicochetPeers() {
  Peers peers;
  const auto kernel = [&](const char* method, const char* fixed, KernelPeer::How how) {
    peers.push_back(std::make_unique<KernelPeer>(Setup{"Ricochet", "energetic", method, 0, 0, "", fixed, true}, how));
  };
  kernel("closed form in SIMD lanes", "double-double, 1000 impacts a call, omega+ alone", KernelPeer::How::kLanes);
  kernel("closed form in plain doubles", "one impact a call, all outputs", KernelPeer::How::kPlain);
  kernel("closed form in double-double", "one impact a call, all outputs", KernelPeer::How::kDoubleDouble);
  peers.push_back(std::make_unique<SolverPeer>(
      Setup{"Ricochet", "energetic", "LocalSolver::Solve", 0, 0, "", "default demand", true}));
  return peers;
}

}  // namespace ricochet::peers
