// StepColumns: the numbers that a step reads and writes, column by column, with one entry for each SIMD lane.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#endif

#include <array>
#include <cstddef>
#include <limits>

#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/step-inl.h"

#if RICOCHET_SIMD
HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

inline constexpr size_t kLanes = hwy::HWY_NAMESPACE::MaxLanes(hwy::HWY_NAMESPACE::ScalableTag<double>());

// One number for each lane.
struct alignas(kLanes * sizeof(double)) Column {
  std::array<double, kLanes> of = {};

  HWY_INLINE LaneNumber Load() const { return LaneNumber(hwy::HWY_NAMESPACE::Load(Tag(), of.data())); }
  // True where the number is not 0.
  HWY_INLINE MaskOf<LaneNumber> LoadMask() const { return LaneNumber{0} < Load(); }
  HWY_INLINE void Store(LaneNumber numbers) { hwy::HWY_NAMESPACE::Store(numbers.value, Tag(), of.data()); }
  HWY_INLINE void Store(MaskOf<LaneNumber> mask) { Store(Select(mask, LaneNumber{1}, LaneNumber{0})); }

 private:
  using Tag = hwy::HWY_NAMESPACE::ScalableTag<double>;
};

class StepColumns {
 public:
  // Sets a lane to an impact whose first step is to be taken.
  void Set(size_t lane, const Solver<double>& solver);
  // Sets a lane to another place on the path of the same impact.
  void SetPath(size_t lane, const Solver<double>& solver);
  // Leaves a lane without an impact: none of its numbers is one, so that it never comes to a goal.
  void Rest(size_t lane);

  // Takes the steps of all lanes. Each lane is then set to its next step, unless it needs attention.
  void Take(int order);

  // True if something other than another step may follow, or if every step is to be accepted.
  bool NeedsAttention(size_t lane) const {
    return pauses_.of[lane] != 0.0 || reaches_goal_.of[lane] != 0.0 || may_turn_.of[lane] != 0.0;
  }
  // The end of a lane's step.
  StepEnd<double> EndOf(size_t lane) const;
  // True if the impact would do something other than to take another step, also if it has not ended its phase.
  bool Pauses(size_t lane) const { return pauses_.of[lane] != 0.0; }

 private:
  Contact<LaneNumber> LoadContact() const;
  Way<LaneNumber> LoadWay() const;
  StepErrors<LaneNumber> LoadErrors() const;
  void Store(const StepEnd<LaneNumber>& end);

  // The impact and its phase.
  Column w11_, w12_, w13_, w22_, w23_, w33_;
  Column mu_, velocity_, approach_, rate_, largest_root_, smallest_root_, normal_root_, steepest_;
  Column tolerance_, stopped_;
  Column target_, to_velocity_, to_impulse_, may_turn_, in_restitution_;

  // The path at the end of the last step, and its errors.
  State<Column> state_;
  PathError<Column> known_, doubtful_;
  Column friction_, slip_rounding_, strayed_, v_rounding_, work_;

  // What else is known of that step.
  Direction<Column> e_;
  Column beyond_, reaches_goal_, offset_, pauses_;
};

inline void StepColumns::Set(size_t lane, const Solver<double>& solver) {
  const ScaledProblem<double>& problem = solver.problem();
  const Matrix<double>& w = problem.w;
  w11_.of[lane] = w.w11;
  w12_.of[lane] = w.w12;
  w13_.of[lane] = w.w13;
  w22_.of[lane] = w.w22;
  w23_.of[lane] = w.w23;
  w33_.of[lane] = w.w33;
  mu_.of[lane] = problem.mu;
  velocity_.of[lane] = problem.velocity;
  approach_.of[lane] = problem.approach;
  rate_.of[lane] = problem.rate;
  largest_root_.of[lane] = problem.largest_root;
  smallest_root_.of[lane] = problem.smallest_root;
  normal_root_.of[lane] = problem.normal_root;
  steepest_.of[lane] = problem.steepest;
  tolerance_.of[lane] = solver.tolerance();
  stopped_.of[lane] = solver.StoppedSlip();
  SetPath(lane, solver);
}

inline void StepColumns::SetPath(size_t lane, const Solver<double>& solver) {
  const Way<double> way = solver.path().WayAhead();
  const StepErrors<double>& errors = solver.errors();
  state_.tau.of[lane] = way.from.tau;
  state_.f1.of[lane] = way.from.f1;
  state_.f2.of[lane] = way.from.f2;
  state_.u1.of[lane] = way.from.u1;
  state_.u2.of[lane] = way.from.u2;
  state_.v.of[lane] = way.from.v;
  state_.friction_work.of[lane] = way.from.friction_work;
  state_.normal_work.of[lane] = way.from.normal_work;
  target_.of[lane] = way.target;
  to_velocity_.of[lane] = way.to_velocity ? 1.0 : 0.0;
  to_impulse_.of[lane] = way.to_impulse ? 1.0 : 0.0;
  may_turn_.of[lane] = way.may_turn ? 1.0 : 0.0;
  in_restitution_.of[lane] = way.in_restitution ? 1.0 : 0.0;
  known_.f1.of[lane] = errors.known.f1;
  known_.f2.of[lane] = errors.known.f2;
  known_.work.of[lane] = errors.known.work;
  doubtful_.f1.of[lane] = errors.doubtful.f1;
  doubtful_.f2.of[lane] = errors.doubtful.f2;
  doubtful_.work.of[lane] = errors.doubtful.work;
  friction_.of[lane] = errors.friction;
  slip_rounding_.of[lane] = errors.slip_rounding;
  strayed_.of[lane] = errors.strayed;
  v_rounding_.of[lane] = errors.v_rounding;
  work_.of[lane] = errors.work;
}

inline void StepColumns::Rest(size_t lane) {
  may_turn_.of[lane] = 0.0;
  state_.u1.of[lane] = state_.u2.of[lane] = state_.v.of[lane] = std::numeric_limits<double>::quiet_NaN();
  target_.of[lane] = std::numeric_limits<double>::quiet_NaN();
}

HWY_INLINE Contact<LaneNumber> StepColumns::LoadContact() const {
  Contact<LaneNumber> contact;
  contact.w.w11 = w11_.Load();
  contact.w.w12 = w12_.Load();
  contact.w.w13 = w13_.Load();
  contact.w.w22 = w22_.Load();
  contact.w.w23 = w23_.Load();
  contact.w.w33 = w33_.Load();
  contact.mu = mu_.Load();
  contact.velocity = velocity_.Load();
  contact.approach = approach_.Load();
  contact.rate = rate_.Load();
  contact.largest_root = largest_root_.Load();
  contact.smallest_root = smallest_root_.Load();
  contact.normal_root = normal_root_.Load();
  contact.steepest = steepest_.Load();
  return contact;
}

HWY_INLINE Way<LaneNumber> StepColumns::LoadWay() const {
  return {.from = {.tau = state_.tau.Load(),
                   .f1 = state_.f1.Load(),
                   .f2 = state_.f2.Load(),
                   .u1 = state_.u1.Load(),
                   .u2 = state_.u2.Load(),
                   .v = state_.v.Load(),
                   .friction_work = state_.friction_work.Load(),
                   .normal_work = state_.normal_work.Load()},
          .target = target_.Load(),
          .to_velocity = to_velocity_.LoadMask(),
          .to_impulse = to_impulse_.LoadMask(),
          .may_turn = may_turn_.LoadMask(),
          .in_restitution = in_restitution_.LoadMask()};
}

HWY_INLINE StepErrors<LaneNumber> StepColumns::LoadErrors() const {
  return {.known = {.f1 = known_.f1.Load(), .f2 = known_.f2.Load(), .work = known_.work.Load()},
          .doubtful = {.f1 = doubtful_.f1.Load(), .f2 = doubtful_.f2.Load(), .work = doubtful_.work.Load()},
          .friction = friction_.Load(),
          .slip_rounding = slip_rounding_.Load(),
          .strayed = strayed_.Load(),
          .v_rounding = v_rounding_.Load(),
          .work = work_.Load()};
}

HWY_INLINE void StepColumns::Store(const StepEnd<LaneNumber>& end) {
  state_.tau.Store(end.state.tau);
  state_.f1.Store(end.state.f1);
  state_.f2.Store(end.state.f2);
  state_.u1.Store(end.state.u1);
  state_.u2.Store(end.state.u2);
  state_.v.Store(end.state.v);
  state_.friction_work.Store(end.state.friction_work);
  state_.normal_work.Store(end.state.normal_work);
  known_.f1.Store(end.errors.known.f1);
  known_.f2.Store(end.errors.known.f2);
  known_.work.Store(end.errors.known.work);
  doubtful_.f1.Store(end.errors.doubtful.f1);
  doubtful_.f2.Store(end.errors.doubtful.f2);
  doubtful_.work.Store(end.errors.doubtful.work);
  friction_.Store(end.errors.friction);
  slip_rounding_.Store(end.errors.slip_rounding);
  strayed_.Store(end.errors.strayed);
  v_rounding_.Store(end.errors.v_rounding);
  work_.Store(end.errors.work);
  e_.c.Store(end.e.c);
  e_.s.Store(end.e.s);
  beyond_.Store(end.beyond);
  reaches_goal_.Store(end.reaches_goal);
  offset_.Store(end.offset);
}

inline void StepColumns::Take(int order) {
  const Contact<LaneNumber> contact = LoadContact();
  const Way<LaneNumber> way = LoadWay();
  const LaneNumber tolerance = tolerance_.Load();
  const Heading<LaneNumber> heading(contact, way.from);
  const StepEnd<LaneNumber> end = TakeStep(contact, way, LoadErrors(), heading, tolerance, order);
  Store(end);
  const Heading<LaneNumber> next(contact, end.state);
  pauses_.Store(Solver<double>::Pauses(next, stopped_.Load(), tolerance));
}

inline StepEnd<double> StepColumns::EndOf(size_t lane) const {
  return {.state = {.tau = state_.tau.of[lane],
                    .f1 = state_.f1.of[lane],
                    .f2 = state_.f2.of[lane],
                    .u1 = state_.u1.of[lane],
                    .u2 = state_.u2.of[lane],
                    .v = state_.v.of[lane],
                    .friction_work = state_.friction_work.of[lane],
                    .normal_work = state_.normal_work.of[lane]},
          .e = {e_.c.of[lane], e_.s.of[lane]},
          .errors = {.known = {.f1 = known_.f1.of[lane], .f2 = known_.f2.of[lane], .work = known_.work.of[lane]},
                     .doubtful = {.f1 = doubtful_.f1.of[lane],
                                  .f2 = doubtful_.f2.of[lane],
                                  .work = doubtful_.work.of[lane]},
                     .friction = friction_.of[lane],
                     .slip_rounding = slip_rounding_.of[lane],
                     .strayed = strayed_.of[lane],
                     .v_rounding = v_rounding_.of[lane],
                     .work = work_.of[lane]},
          .beyond = beyond_.of[lane],
          .reaches_goal = reaches_goal_.of[lane] != 0.0,
          .offset = offset_.of[lane]};
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // RICOCHET_SIMD

#endif  // per-target include guard
