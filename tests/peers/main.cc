// ricochet_peers IMPACTS.json FILE.csv [ENGINE]: lets every engine of this build, or the one named, strike the five
// cases of conformance/impacts.json with all its settings, prints a table and writes all measurements to FILE.csv.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "tests/benchmark/measure.h"
#include "tests/peers/exact.h"
#include "tests/peers/peer.h"

namespace ricochet::peers {
namespace {

constexpr int kRounds = 11;
constexpr double kSecondsARound = 3e-3;
constexpr int kMostRunsARound = 500;

struct Measurement {
  Setup setup;
  PendulumCase pendulum;
  AfterImpact after;
  long double error_newton = 0.0L;
  long double error_poisson = 0.0L;
  long double error_energetic = 0.0L;
  double energy_gained_j = 0.0;  // Negative if energy was lost.
  double ns = 0.0;               // Time of one impact: the median of the rounds.
  double times_ours = 0.0;       // Median of the rounds' ratios to LocalSolver::Solve.
};

// Seconds that this thread has worked.
double WorkedSeconds() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Runs longer than this, in s, are timed by the thread's clock, as other programs interrupt most of them. For shorter
// runs that clock is too slow to read.
constexpr double kShortRun = 1e-4;

double SecondsOfRun(Peer& peer) {
  peer.Reset();
  const double start = WorkedSeconds();
  const double seconds = bench::Seconds([&] { peer.Run(); });
  return seconds > kShortRun ? WorkedSeconds() - start : seconds;
}

// Time that the clock itself adds to a measurement.
double SecondsOfClock() {
  std::vector<double> seconds(1001);
  for (double& s : seconds) s = bench::Seconds([] {});
  return bench::Median(seconds);
}

// Time of one impact: the median of a round of `runs`, because other programs interrupt some of them.
double SecondsAnImpact(Peer& peer, int runs, double clock) {
  std::vector<double> seconds(static_cast<size_t>(runs));
  for (double& s : seconds) s = SecondsOfRun(peer) - clock;
  return bench::Median(seconds) / peer.impacts_per_run();
}

int RunsARound(Peer& peer) {
  const double once = std::min({SecondsOfRun(peer), SecondsOfRun(peer), SecondsOfRun(peer)});
  return std::clamp(static_cast<int>(kSecondsARound / once), 1, kMostRunsARound);
}

// The impacts of `peer` and of `ours` are timed in turn, so that a machine whose speed changes changes both.
void Time(Peer& peer, Peer& ours, Measurement& measurement) {
  const double clock = SecondsOfClock();
  const int runs = RunsARound(peer);
  const int our_runs = RunsARound(ours);
  std::vector<double> seconds;
  std::vector<double> ratios;
  for (int i = 0; i < kRounds; ++i) {
    seconds.push_back(SecondsAnImpact(peer, runs, clock));
    ratios.push_back(seconds.back() / SecondsAnImpact(ours, our_runs, clock));
  }
  measurement.ns = 1e9 * bench::Median(seconds);
  measurement.times_ours = bench::Median(ratios);
}

Measurement Measure(Peer& peer, Peer& ours, const PendulumCase& c) {
  peer.Prepare(c);
  ours.Prepare(c);
  Measurement measurement{.setup = peer.setup(), .pendulum = c};
  Time(peer, ours, measurement);
  measurement.after = peer.After();
  const Exact exact = ExactAnswers(c);
  const long double omega = measurement.after.omega;
  const auto error = [&](long double answer) { return std::fabs(omega - answer) / std::fabs(kOmegaBefore); };
  measurement.error_newton = error(exact.newton);
  measurement.error_poisson = error(exact.poisson);
  measurement.error_energetic = error(exact.energetic);
  measurement.energy_gained_j = measurement.after.energy_j - 0.5 * kInertiaAboutPin * kOmegaBefore * kOmegaBefore;
  return measurement;
}

// All peers of this build, or those of one engine.
Peers AllPeers(const std::string& engine) {
  Peers all;
  const auto add = [&](Peers peers) {
    for (auto& peer : peers) {
      if (engine.empty() || peer->setup().engine == engine) all.push_back(std::move(peer));
    }
  };
  add(RicochetPeers());
#ifdef RICOCHET_PEER_BULLET
  add(BulletPeers());
#endif
#ifdef RICOCHET_PEER_BOX2D
  add(Box2dPeers());
#endif
#ifdef RICOCHET_PEER_CHIPMUNK
  add(ChipmunkPeers());
#endif
#ifdef RICOCHET_PEER_DART
  add(DartPeers());
#endif
#ifdef RICOCHET_PEER_MUJOCO
  add(MujocoPeers());
#endif
#ifdef RICOCHET_PEER_ODE
  add(OdePeers());
#endif
#ifdef RICOCHET_PEER_SICONOS
  add(SiconosPeers());
#endif
#ifdef RICOCHET_PEER_SIMBODY
  add(SimbodyPeers());
#endif
  return all;
}

std::string Name(const Setup& setup) {
  std::string name = setup.engine + ", " + setup.method;
  if (setup.step_s > 0) name += absl::StrFormat(", dt %.3g", setup.step_s);
  if (setup.iterations > 0) name += absl::StrFormat(", %d it.", setup.iterations);
  if (!setup.varied.empty()) name += ", " + setup.varied;
  return name;
}

// Kinetic energy may rise by this much, in J, through rounding, single precision included.
constexpr double kEnergyRounding = 1e-5;

void PrintRow(const std::vector<Measurement>& cases) {
  std::string row = absl::StrFormat("%-80s", Name(cases[0].setup));
  std::vector<double> ns;
  std::vector<double> times_ours;
  for (const Measurement& m : cases) {
    absl::StrAppendFormat(&row, " %10.6f%c", m.after.omega, m.energy_gained_j > kEnergyRounding ? '*' : ' ');
    ns.push_back(m.ns);
    times_ours.push_back(m.times_ours);
  }
  std::printf("%s %12.4g %10.3g\n", row.c_str(), bench::Median(ns), bench::Median(times_ours));
  std::fflush(stdout);
}

void PrintHead(const std::vector<PendulumCase>& pendulums) {
  std::printf("omega+ in rad/s after an impact with omega- = -1 rad/s; * means that kinetic energy rose\n%-80s", "");
  for (const PendulumCase& c : pendulums) std::printf(" %10s ", absl::StrFormat("case %d", c.number).c_str());
  std::printf(" %12s %10s\n", "ns", "ns/ours");
  const auto exact = [&](const char* law, long double Exact::*omega) {
    std::printf("%-80s", law);
    for (const PendulumCase& c : pendulums) std::printf(" %10.6Lf ", ExactAnswers(c).*omega);
    std::printf("\n");
  };
  exact("exact, Newton", &Exact::newton);
  exact("exact, Poisson", &Exact::poisson);
  exact("exact, energetic", &Exact::energetic);
}

void WriteCsvRow(const Measurement& m, std::ostream& out) {
  const Setup& s = m.setup;
  out << absl::StrFormat("%s,%s,\"%s\",%.9g,%d,\"%s\",\"%s\",%d,%d,%.17g,%.6Lg,%.6Lg,%.6Lg,%.6g,%.6g,%.6g\n", s.engine,
                         s.law, s.method, s.step_s, s.iterations, s.varied, s.fixed, s.in_table ? 1 : 0,
                         m.pendulum.number, m.after.omega, m.error_newton, m.error_poisson, m.error_energetic,
                         m.energy_gained_j, m.ns, m.times_ours);
}

int Main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: ricochet_peers IMPACTS.json FILE.csv [ENGINE]\n";
    return 2;
  }
  const std::vector<PendulumCase> pendulums = ReadPendulumCases(argv[1]);
  std::ofstream csv(argv[2]);
  csv << "engine,law,method,step_s,iterations,varied,fixed,in_table,case,omega_plus,error_newton,error_poisson,"
         "error_energetic,energy_gained_j,ns_per_impact,times_ours\n";
  PrintHead(pendulums);
  const Peers ours = RicochetPeers();
  for (const auto& peer : AllPeers(argc == 4 ? argv[3] : "")) {
    std::vector<Measurement> cases;
    for (const PendulumCase& c : pendulums) cases.push_back(Measure(*peer, *ours.back(), c));
    for (const Measurement& m : cases) WriteCsvRow(m, csv);
    PrintRow(cases);
  }
  csv.close();
  if (!csv) {
    std::cerr << "ricochet_peers: cannot write " << argv[2] << '\n';
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace ricochet::peers

int main(int argc, char** argv) { return ricochet::peers::Main(argc, argv); }
