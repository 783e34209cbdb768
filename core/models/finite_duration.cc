#include "core/models/finite_duration.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/models/finite_duration_motion.h"
#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

// Both for one integration.
constexpr int64_t kStepBudget = 50'000;
constexpr int64_t kTurnBudget = 200;

// CVODE, for one contact: Adams' formulas of variable order, step by step, with the roots of the guards.
class Integrator {
 public:
  explicit Integrator(const Contact& contact)
      : contact_(contact),
        y_(N_VNew_Serial(kParts, context_)),
        absolute_(N_VNew_Serial(kParts, context_)),
        errors_(N_VNew_Serial(kParts, context_)),
        memory_(CVodeCreate(CV_ADAMS, context_)) {
    N_VConst(0.0, y_);
    N_VConst(1.0, absolute_);
    fixed_point_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    Require(CVodeInit(memory_, Rates, 0.0, y_));
    Require(CVodeSVtolerances(memory_, 1.0, absolute_));
    Require(CVodeSetUserData(memory_, this));
    Require(CVodeSetNonlinearSolver(memory_, fixed_point_));
    Require(CVodeRootInit(memory_, kGuards, Roots));
    std::array<int, kGuards> directions = {};
    std::fill_n(directions.begin(), static_cast<size_t>(kModeGuards), -1);
    Require(CVodeSetRootDirection(memory_, directions.data()));
    Require(CVodeSetNoInactiveRootWarn(memory_));
    Require(CVodeSetErrHandlerFn(memory_, Silent, nullptr));
  }
  ~Integrator() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(fixed_point_);
    N_VDestroy(errors_);
    N_VDestroy(absolute_);
    N_VDestroy(y_);
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // From s = 0 anew, in `mode`.
  void Begin(const Mode& mode, const Motion& y, double tolerance) {
    Count();
    mode_ = mode;
    StateOf(y_) = y;
    Motion& absolute = StateOf(absolute_);
    const double slip = std::max(1.0, std::fabs(contact_.u0));
    absolute.fill(tolerance);
    absolute[kU] *= slip;
    absolute[kTangentWork] *= slip;
    absolute[kFrictionLoss] *= slip;
    absolute[kV] *= Pace(contact_, mode);
    Require(CVodeReInit(memory_, 0.0, y_));
    Require(CVodeSVtolerances(memory_, tolerance, absolute_));
    s_ = previous_s_ = 0.0;
    counted_ = {0, 0};
    judged_ = 0;
  }

  enum class Progress {
    kStep,
    kCrowded,  // A guard is 0 where the last root was and just after it: begin anew from there.
    kFailed
  };

  // To the end of a step or the next root. `fallen`: guards that it found at 0.
  Progress Step(std::array<bool, kModeGuards>& fallen) {
    // All that CVODE makes of it is the direction and the size of the first step.
    constexpr double kAhead = 1.0;
    fallen.fill(false);
    previous_s_ = s_;
    const int flag = CVode(memory_, s_ + kAhead, y_, &s_, CV_ONE_STEP);
    if (flag == CV_ILL_INPUT) return Progress::kCrowded;
    if (flag < 0) return Progress::kFailed;
    AddLocalErrors();
    if (flag != CV_ROOT_RETURN) return Progress::kStep;
    std::array<int, kGuards> found;
    Require(CVodeGetRootInfo(memory_, found.data()));
    for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = found[i] != 0;
    return Progress::kStep;
  }

  const Motion& y() const { return StateOf(y_); }
  double s() const { return s_; }
  double previous_s() const { return previous_s_; }

  // The motion anywhere in the last step.
  Motion Between(double s) {
    const Motion now = y();
    Require(CVodeGetDky(memory_, s, 0, y_));
    const Motion between = y();
    StateOf(y_) = now;
    return between;
  }

  // For each part, the sum of the sizes of its local errors since the last call, as CVODE estimates them.
  Motion TakeLocalErrors() { return std::exchange(local_errors_, Motion{}); }

  // Since the last call.
  std::pair<int64_t, int64_t> TakeCosts() {
    Count();
    return {std::exchange(steps_, 0), std::exchange(right_hand_sides_, 0)};
  }

 private:
  static Motion& StateOf(N_Vector vector) { return *reinterpret_cast<Motion*>(NV_DATA_S(vector)); }

  // For calls that fail only where this program is wrong.
  static void Require([[maybe_unused]] int flag) { assert(flag >= 0); }

  static void Silent(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*message*/,
                     void* /*data*/) {}

  static int Rates(realtype /*s*/, N_Vector y, N_Vector rates, void* data) {
    const Integrator& self = *static_cast<const Integrator*>(data);
    StateOf(rates) = RatesAt(self.contact_, self.mode_, StateOf(y));
    return 0;
  }

  static int Roots(realtype /*s*/, N_Vector y, realtype* values, void* data) {
    const Integrator& self = *static_cast<const Integrator*>(data);
    const Guards guards = GuardsAt(self.contact_, self.mode_, StateOf(y));
    std::copy(guards.begin(), guards.end(), values);
    return 0;
  }

  void AddLocalErrors() {
    long steps = 0;
    Require(CVodeGetNumSteps(memory_, &steps));
    if (steps == judged_) return;
    judged_ = steps;
    Require(CVodeGetEstLocalErrors(memory_, errors_));
    for (size_t i = 0; i < kParts; ++i) local_errors_[i] += std::fabs(StateOf(errors_)[i]);
  }

  void Count() {
    long steps = 0;
    long right_hand_sides = 0;
    Require(CVodeGetNumSteps(memory_, &steps));
    Require(CVodeGetNumRhsEvals(memory_, &right_hand_sides));
    steps_ += steps - counted_.first;
    right_hand_sides_ += right_hand_sides - counted_.second;
    counted_ = {steps, right_hand_sides};
  }

  const Contact& contact_;
  Mode mode_;
  sundials::Context context_;
  N_Vector y_;
  N_Vector absolute_;
  N_Vector errors_;
  void* memory_;
  SUNNonlinearSolver fixed_point_;
  double s_ = 0.0;
  double previous_s_ = 0.0;
  int64_t steps_ = 0;
  int64_t right_hand_sides_ = 0;
  std::pair<long, long> counted_ = {0, 0};  // Of those, since the integrator last began.
  long judged_ = 0;                         // The step whose local errors were taken last.
  Motion local_errors_ = {};
};

struct Instant {
  EventKind kind = EventKind::kUnspecified;
  Motion y = {};
};

struct Works {
  double normal = 0.0, tangential = 0.0;
};

// Where slip stopped for the first time, or the particle stuck.
enum class Stop { kNever, kInCompression, kInRestitution };

struct Path {
  Motion end = {};
  Motion compression = {};  // At the last end of compression.
  Works compression_works;
  std::vector<Instant> events;
  Stop stop = Stop::kNever;
  bool first_stop_sticks = false;
  bool ever_sticks = false;
  bool held = false;    // Ended at rest, where friction and the spring keep it.
  bool parted = false;  // Or ended where compression does, because eta = 0 or it is held.
  double peak_normal = 0.0, peak_tangential = 0.0, indentation = 0.0;
  double largest_place = 0.0;
  double fastest = 0.0;       // Of restitution, along n.
  double spring_force = 0.0;  // Of the tangential spring at the end.
  Motion local_errors = {};
  int64_t steps = 0, right_hand_sides = 0;
};

// Forces at equal steps of time, in natural units.
struct History {
  int64_t intervals = 0;
  double duration = 0.0;
  std::vector<ForceSample> samples;
};

ForceSample SampleOf(const Contact& contact, const Mode& mode, const Motion& y, double time) {
  const Forces forces = ForcesAt(contact, mode, y);
  return {time, forces.tangential, forces.normal, Indentation(contact, mode, y), y[kU], y[kV]};
}

// One integration, mode by mode.
class Follower {
 public:
  Follower(const Contact& contact, Integrator& integrator, double tolerance, History* history)
      : contact_(contact), integrator_(integrator), tolerance_(tolerance), history_(history) {}

  Path Follow() {
    y_ = StartOf(contact_);
    mode_.grip = GripAtStart(contact_);
    path_.ever_sticks = mode_.grip == Grip::kStick;
    if (contact_.u0 == 0.0 && !contact_.compliant && path_.ever_sticks) NoteStop();
    if (contact_.compliant && path_.ever_sticks) NoteStop();
    AddEvent(EventKind::kStart);
    if (history_ != nullptr) history_->samples.push_back(SampleOf(contact_, mode_, y_, 0.0));
    while (!path_.parted && !path_.held && FollowMode()) {
    }
    path_.end = y_;
    if (contact_.compliant) path_.spring_force = ForcesAt(contact_, mode_, y_).tangential;
    if (history_ != nullptr) history_->samples.push_back(SampleOf(contact_, mode_, y_, y_[kTime]));
    if (mode_.line == Line::kLoading && !compression_ended_) EndCompression();
    path_.local_errors = integrator_.TakeLocalErrors();
    std::tie(path_.steps, path_.right_hand_sides) = integrator_.TakeCosts();
    return std::move(path_);
  }

 private:
  // False if a budget runs out.
  bool FollowMode() {
    if (stays_ || NeverTurns(contact_, mode_, y_)) return false;
    integrator_.Begin(mode_, y_, tolerance_);
    changed_ = false;
    while (!changed_) {
      std::array<bool, kModeGuards> fallen;
      if (steps_++ == kStepBudget) return false;
      const Integrator::Progress progress = integrator_.Step(fallen);
      if (progress == Integrator::Progress::kFailed) return false;
      if (progress == Integrator::Progress::kCrowded) return integrator_.s() > 0.0;
      y_ = integrator_.y();
      if (history_ != nullptr) TakeSamples();
      NotePeaks();
      // A guard that starts at 0 and falls is no root: it is below 0 at the end of a step.
      const Guards guards = GuardsAt(contact_, mode_, y_);
      for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = fallen[i] || guards[i] < 0.0;
      if (fallen[kUpper]) LeaveGrip(kUpper);
      if (fallen[kLower]) LeaveGrip(kLower);
      if (fallen[kLineEnd]) EndLine();
      if (fallen[kTension]) Part();
      if (fallen[kTurn] && !path_.parted && turns_++ == kTurnBudget) return false;
      if (fallen[kTurn] && !path_.parted) Turn();
      NotePeaks();
    }
    return true;
  }

  void AddEvent(EventKind kind) { path_.events.push_back({kind, y_}); }

  void NotePeaks() {
    const Forces forces = ForcesAt(contact_, mode_, y_);
    path_.peak_normal = std::max(path_.peak_normal, forces.normal);
    path_.peak_tangential = std::max(path_.peak_tangential, std::fabs(forces.tangential));
    path_.largest_place = std::max(path_.largest_place, y_[kPlace]);
    if (mode_.line == Line::kUnloading) path_.fastest = std::max(path_.fastest, y_[kV]);
    path_.indentation = std::max(path_.indentation, Indentation(contact_, mode_, y_));
  }

  void NoteStop() {
    if (path_.stop != Stop::kNever) return;
    path_.stop = y_[kV] < 0.0 && !compression_ended_ ? Stop::kInCompression : Stop::kInRestitution;
    path_.first_stop_sticks = mode_.grip == Grip::kStick;
  }

  void Grasp(Grip grip) {
    changed_ = true;
    const bool stuck = mode_.grip == Grip::kStick;
    if (contact_.compliant && !stuck) y_[kSpringForce] = ForcesAt(contact_, mode_, y_).tangential;
    mode_.grip = grip;
    const bool sticks = grip == Grip::kStick;
    path_.ever_sticks = path_.ever_sticks || sticks;
    if (!stuck) NoteStop();
    AddEvent(stuck                          ? EventKind::kSlipStarts
             : sticks && contact_.compliant ? EventKind::kStickStarts
                                            : EventKind::kSlipStops);
  }

  void LeaveGrip(Guard fallen) {
    const bool slid = mode_.grip != Grip::kStick;
    const Grip next = GripAfter(contact_, mode_, y_, fallen);
    if (next == mode_.grip) return;
    if (slid && !contact_.compliant) y_[kU] = 0.0;
    Grasp(next);
  }

  void Part() {
    changed_ = true;
    path_.parted = true;
    AddEvent(EventKind::kRestitutionEnds);
  }

  void EndLine() {
    if (mode_.line == Line::kUnloading) {
      y_[kPlace] = 0.0;
      Part();
      return;
    }
    changed_ = true;
    y_[kPlace] = mode_.largest;
    mode_.line = Line::kLoading;
    loading_start_ = {y_[kNormalWork], y_[kTangentWork]};
  }

  void EndCompression() {
    compression_ended_ = true;
    mode_.largest = y_[kPlace];
    path_.compression = y_;
    Works& works = path_.compression_works;
    if (contact_.damped) {
      works = {y_[kNormalWork], y_[kTangentWork]};
    } else {
      works.normal += y_[kNormalWork] - loading_start_.normal;
      works.tangential += y_[kTangentWork] - loading_start_.tangential;
    }
  }

  // v = 0.
  void Turn() {
    if (contact_.coupled && !contact_.compliant) StopWithNormal();
    const Forces forces = ForcesAt(contact_, mode_, y_);
    const double rate = AccelerationAt(contact_, mode_, forces).v;
    const bool held = mode_.grip == Grip::kStick && !contact_.compliant && rate == 0.0;
    const bool opens = mode_.line != Line::kUnloading;
    // What has but touched 0 goes on.
    if (!held && (opens ? rate <= 0.0 : rate >= 0.0)) return;
    changed_ = true;
    y_[kV] = 0.0;
    // At rest in restitution it neither parts nor moves.
    if (held && mode_.line != Line::kLoading) stays_ = true;
    path_.held = held && !stays_;
    if (mode_.line == Line::kLoading && (!contact_.damped || y_[kPlace] >= mode_.largest)) {
      EndCompression();
      AddEvent(EventKind::kCompressionEnds);
      if (contact_.eta == 0.0 && !held) return Part();
    }
    const Line closing = contact_.damped ? Line::kLoading : Line::kReloading;
    mode_.line = opens ? Line::kUnloading : closing;
  }

  void StopWithNormal() {
    const Grip next = GripAtRest(contact_, ForcesAt(contact_, mode_, y_).normal);
    if (next == mode_.grip) return;
    y_[kU] = 0.0;
    y_[kV] = 0.0;
    Grasp(next);
  }

  // The motion at `time`, which lies in the last step.
  Motion At(double time) {
    double low = integrator_.previous_s();
    double high = integrator_.s();
    double guess = 0.5 * (low + high);
    Motion y = integrator_.Between(guess);
    // Newton's steps, halvings where they leave the bracket; 60 halvings have it to the last bit.
    for (int i = 0; i < 60; ++i) {
      const double miss = y[kTime] - time;
      (miss > 0.0 ? high : low) = guess;
      const double next = guess - miss / RatesAt(contact_, mode_, y)[kTime];
      const double clipped = next > low && next < high ? next : 0.5 * (low + high);
      if (clipped == guess || !(high > low)) break;
      guess = clipped;
      y = integrator_.Between(guess);
    }
    return y;
  }

  void TakeSamples() {
    const auto intervals = static_cast<double>(history_->intervals);
    while (static_cast<int64_t>(history_->samples.size()) < history_->intervals) {
      const double time = history_->duration * (static_cast<double>(history_->samples.size()) / intervals);
      if (time > y_[kTime]) return;
      history_->samples.push_back(SampleOf(contact_, mode_, At(time), time));
    }
  }

  const Contact& contact_;
  Integrator& integrator_;
  double tolerance_;
  History* history_;
  Motion y_ = {};
  Mode mode_;
  Path path_;
  bool changed_ = false;
  bool compression_ended_ = false;
  bool stays_ = false;
  Works loading_start_;
  int64_t steps_ = 0;
  int64_t turns_ = 0;
};

// How far the velocities at the end of a path are from the truth, over max(|u0|, |v0|). Local errors add up at worst in
// size. They grow where restitution slows down, as it is v^2 that carries over, and shift the end, up to which a_t acts.
// The safety is for all other growth; without forces, damping and springs along t each piece of the path is straight.
double ErrorOf(const Contact& contact, const Path& path) {
  const bool straight = contact.at == 0.0 && contact.an == 0.0 && !contact.damped && !contact.compliant;
  const double safety = straight ? 2.0 : 4.0;
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const Motion& end = path.end;
  const Motion& local = path.local_errors;
  const double growth = end[kV] > 0.0 ? path.fastest / end[kV] : 1.0;
  // A force that is wrong by a part of itself changes the velocities by that part.
  const double normal = std::max(local[kPlace] / std::max(1.0, path.largest_place), local[kV]);
  const double shift = std::fabs(contact.at) * end[kTime] * normal;
  const double error = std::max(growth * normal, local[kU]) + shift;
  double terms = std::fabs(contact.u0) + 1.0 + (std::fabs(contact.at) + std::fabs(contact.an)) * end[kTime];
  // Springs along t and n work against each other where W is close to rank one.
  if (contact.compliant) terms += (1.0 + (contact.wtt + std::fabs(contact.wtn)) * contact.mu) * end[kNormal];
  return (safety * error + kRounding * terms) / std::max(1.0, std::fabs(contact.u0));
}

struct Estimated {
  Path path;
  double tolerance = 0.0;  // Of the integration.
  double error = 0.0;
  int64_t steps = 0, right_hand_sides = 0;
};

// Integrates until the estimated error is within `tolerance`, or rounding forbids any better.
Estimated FollowWithin(const Contact& contact, Integrator& integrator, double tolerance) {
  constexpr double kFirst = 0.1;
  constexpr double kTighter = 0.1;
  constexpr double kFinest = 4e-15;
  constexpr double kCoarsest = 1e-6;
  Estimated result;
  result.tolerance = std::clamp(kFirst * tolerance, kFinest, kCoarsest);
  for (;;) {
    result.path = Follower(contact, integrator, result.tolerance, nullptr).Follow();
    const Path& path = result.path;
    result.steps += path.steps;
    result.right_hand_sides += path.right_hand_sides;
    result.error = std::numeric_limits<double>::infinity();
    if (!(path.parted || path.held)) return result;
    result.error = ErrorOf(contact, path);
    if (result.error <= tolerance || result.tolerance == kFinest) return result;
    const double missing = 0.5 * tolerance / result.error;
    result.tolerance = std::max(kFinest, result.tolerance * std::min(missing, kTighter));
  }
}

Impact Separating(const Problem& problem) {
  Impact impact;
  impact.regime = Regime::kSeparating;
  impact.w_rank = RankOf(problem);
  impact.energetic_excess = -1.0;
  impact.u1 = problem.u0;
  impact.v1 = problem.v0;
  return impact;
}

Regime RegimeOf(const Contact& contact, const Path& path) {
  if (!path.parted && !path.held) return Regime::kWedged;
  if (path.held) return Regime::kLocked;
  if (contact.smooth || (contact.mu == 0.0 && !path.ever_sticks)) return Regime::kFrictionless;
  switch (path.stop) {
    case Stop::kNever:
      return Regime::kSliding;
    case Stop::kInCompression:
      return path.first_stop_sticks ? Regime::kStickInCompression : Regime::kReversalInCompression;
    case Stop::kInRestitution:
      break;
  }
  return path.first_stop_sticks ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

void WriteCoefficients(const Problem& problem, const Contact& contact, const Path& path, Impact& impact) {
  impact.energetic_excess = -1.0;
  impact.tangential = path.end[kNormal] > 0.0 ? path.end[kTangential] / path.end[kNormal] : 0.0;
  if (path.held || contact.eta == 0.0) return;
  impact.newton = path.end[kV];
  impact.poisson = (path.end[kNormal] - path.compression[kNormal]) / path.compression[kNormal];
  if (!contact.damped) {
    impact.energetic = problem.energetic;
    impact.energetic_excess = problem.energetic - 1.0;
    return;
  }
  // Damping and what the spring still holds are lost of the work of compression, without a difference that cancels.
  const double p = contact.exponent + 1.0;
  const double left = Pow(Indentation(contact, {}, path.end), p) / p;
  const double lost = (path.end[kDampingLoss] + left) / -path.compression_works.normal;
  impact.energetic = std::sqrt(std::max(0.0, 1.0 - lost));
  impact.energetic_excess = -lost / (1.0 + impact.energetic);
}

void WriteWorks(const Contact& contact, const Path& path, Impact& impact) {
  const Motion& end = path.end;
  const double unit = contact.Energy();
  const Works& compression = path.compression_works;
  impact.work_normal_compression = unit * compression.normal;
  impact.work_normal_restitution = unit * (end[kNormalWork] - compression.normal);
  impact.work_tangential_compression = unit * compression.tangential;
  impact.work_tangential_restitution = unit * (end[kTangentWork] - compression.tangential);
  const double half_time = 0.5 * end[kTime];
  const double by_velocity = 0.5 * (end[kTangential] * (contact.u0 + end[kU]) + end[kNormal] * (end[kV] - 1.0));
  const double by_force = contact.at * (half_time * end[kTangential] - end[kTangentMoment]) +
                          contact.an * (half_time * end[kNormal] - end[kNormalMoment]);
  impact.energy_change = unit * (by_velocity + by_force);
  impact.friction_dissipation = unit * end[kFrictionLoss];
  impact.spring_energy = unit * 0.5 * contact.ratio_squared * Square(path.spring_force);
}

void WriteEvents(const Contact& contact, const Path& path, Impact& impact) {
  const auto is_end = [](const Instant& instant) { return instant.kind == EventKind::kCompressionEnds; };
  const auto last = std::find_if(path.events.rbegin(), path.events.rend(), is_end);
  for (auto instant = path.events.begin(); instant != path.events.end(); ++instant) {
    if (is_end(*instant) && instant + 1 != last.base()) continue;
    const Motion& y = instant->y;
    Event& event = impact.events.emplace_back();
    event.kind = instant->kind;
    event.state.normal_impulse_n_s = contact.Impulse() * y[kNormal];
    event.state.tangential_impulse_n_s = {contact.Impulse() * y[kTangential]};
    event.state.contact_velocity = {{contact.speed * y[kU]}, contact.speed * y[kV]};
  }
}

void WriteContact(const Contact& contact, const Path& path, const History& history, Impact& impact) {
  ContactDuration& duration = impact.contact;
  duration.duration_s = contact.time * path.end[kTime];
  duration.peak_normal_n = contact.Force() * path.peak_normal;
  duration.peak_tangential_n = contact.Force() * path.peak_tangential;
  duration.indentation_m = contact.Length() * path.indentation;
  for (const ForceSample& sample : history.samples) {
    duration.history.push_back({.time_s = contact.time * sample.time_s,
                                .tangential_n = contact.Force() * sample.tangential_n,
                                .normal_n = contact.Force() * sample.normal_n,
                                .indentation_m = contact.Length() * sample.indentation_m,
                                .tangential_m_s = contact.speed * sample.tangential_m_s,
                                .normal_m_s = contact.speed * sample.normal_m_s});
  }
}

Impact MakeImpact(const Problem& problem, const Contact& contact, const Estimated& found, const History& history) {
  const Path& path = found.path;
  const double impulse = contact.Impulse();
  Impact impact;
  impact.regime = RegimeOf(contact, path);
  impact.w_rank = RankOf(problem);
  impact.u1 = contact.speed * path.end[kU];
  impact.v1 = contact.speed * path.end[kV];
  impact.tau_compression = impulse * path.compression[kNormal];
  impact.tau1 = impulse * path.end[kNormal];
  impact.f_compression = impulse * path.compression[kTangential];
  impact.f1 = impulse * path.end[kTangential];
  WriteCoefficients(problem, contact, path, impact);
  WriteWorks(contact, path, impact);
  impact.error_estimate = found.error;
  impact.converged = path.parted || path.held;
  impact.steps = found.steps;
  impact.right_hand_sides = found.right_hand_sides;
  WriteEvents(contact, path, impact);
  WriteContact(contact, path, history, impact);
  return impact;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) return Separating(problem);
  const Contact contact = MakeContact(problem);
  Integrator integrator(contact);
  Estimated found = FollowWithin(contact, integrator, problem.tolerance);
  History history = {.intervals = problem.intervals, .duration = found.path.end[kTime]};
  if (problem.intervals > 0) {
    const Path path = Follower(contact, integrator, found.tolerance, &history).Follow();
    found.steps += path.steps;
    found.right_hand_sides += path.right_hand_sides;
  }
  return MakeImpact(problem, contact, found, history);
}

}  // namespace ricochet::finite_duration
