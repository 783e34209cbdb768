// StepErrors: the errors to which steps of slip add, and which they carry on. T is a floating type or a LaneNumber.
//
// The error of each step is known to leading order and carried along the path with its sign, and so is its doubt.
// Rounding, and what is no longer carried, counts by the norm of Wtt^-1. core/models/spatial/error_ledger-inl.h says
// what they do to the end of the impact.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STEP_ERRORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STEP_ERRORS_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STEP_ERRORS_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STEP_ERRORS_INL_H_
#endif

#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path_error-inl.h"
#include "core/models/spatial/problem-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// The error of one step to leading order, and one like what that leaves out.
template <typename T>
struct StepError {
  PathError<T> known, remainder;
};

template <typename T>
struct StepErrors {
  // Adds a step with v at its end.
  HWY_INLINE void AddStep(const Contact<T>& contact, const StepError<T>& error, const Stretch<T>& stretch, T v) {
    Carry(contact, stretch);
    AddKnown(contact.w, error);
    CountByNorm(contact.w, stretch.last_slip < T{4} * KnownSlipError(contact.w));
    slip_rounding += SlipRounding(contact, stretch.first_slip);
    Stray(contact, stretch.length, Min(stretch.first_slip, stretch.last_slip));
    AddRounding(contact, contact.steepest * stretch.length, v, stretch.length);
  }

  // Carries the known error over slip.
  HWY_INLINE void Carry(const Contact<T>& contact, const Stretch<T>& stretch) {
    const T zero{0};
    const auto is_known = Not(Both(known.f1 == zero, known.f2 == zero));
    if (InNoLane(is_known)) return;
    const Decay<T> decay = DecayOver(contact.w, contact.mu, stretch, KnownSlipError(contact.w));
    PathError<T> of_known = known;
    PathError<T> of_doubtful = doubtful;
    of_known.CarryOver(contact.w, decay);
    of_doubtful.CarryOver(contact.w, decay);
    known = Select(is_known, of_known, known);
    doubtful = Select(is_known, of_doubtful, doubtful);
  }

  // Doubts add up: they take the sign of the sum so far.
  HWY_INLINE void AddKnown(const Matrix<T>& w, const StepError<T>& error) {
    known.Add(error.known, T{1});
    friction += T{kAnyDirection} * error.known.Norm(w);
    AddDoubt(w, error.known, T{kDoubt});
    AddDoubt(w, error.remainder, T{1});
  }
  HWY_INLINE void AddDoubt(const Matrix<T>& w, const PathError<T>& doubt, T part) {
    const T product = doubtful.f1 * doubt.Velocity1(w) + doubtful.f2 * doubt.Velocity2(w);
    doubtful.Add(doubt, CopySign(part, product));
  }

  // In the lanes `counts`, known errors and their doubts count by their norm from here on and are carried no further.
  HWY_INLINE void CountByNorm(const Matrix<T>& w, MaskOf<T> counts) {
    if (InNoLane(counts)) return;
    const T zero{0};
    friction = Select(counts, friction + (known.Norm(w) + doubtful.Norm(w)), friction);
    known.f1 = Select(counts, zero, known.f1);
    known.f2 = Select(counts, zero, known.f2);
    doubtful.f1 = Select(counts, zero, doubtful.f1);
    doubtful.f2 = Select(counts, zero, doubtful.f2);
  }

  HWY_INLINE void AddRounding(const Contact<T>& contact, T change_of_v, T v, T length) {
    v_rounding += T{kEpsilon<Constant<T>>} * (change_of_v + T{0.5} * Absolute(v));
    work += VelocityError(contact) * length;
  }

  HWY_INLINE T KnownSlipError(const Matrix<T>& w) const {
    const T u1 = known.Velocity1(w);
    const T u2 = known.Velocity2(w);
    return SquareRoot(u1 * u1 + u2 * u2);
  }
  HWY_INLINE T VelocityError(const Contact<T>& contact) const {
    const T coupled = contact.steepest - contact.w.w33;  // mu |wtn|
    return contact.normal_root * friction + Min(contact.normal_root * slip_rounding, coupled * strayed) + v_rounding;
  }
  // Adds a stretch over which friction has a direction that is off by the rounding of slip over slip. Where slip keeps
  // a part that no impulse moves, nothing makes up for the rounding of that: it turns friction for good.
  HWY_INLINE void Stray(const Contact<T>& contact, T length, T slip) {
    const T opposite{2};
    const auto stray = [&](T error) { return length * Select(error < opposite * slip, error / slip, opposite); };
    const T lasting = contact.keeps_part * contact.largest_root;
    const T rounding = contact.largest_root * slip_rounding;
    strayed += stray(rounding + lasting * friction);
    if (InNoLane(T{0} < lasting)) return;
    friction += lasting * contact.mu * stray(rounding);
  }
  // The rounding of slip, in the norm of `friction`.
  HWY_INLINE static T SlipRounding(const Contact<T>& contact, T slip) {
    return T{kEpsilon<Constant<T>>} * slip / contact.smallest_root;
  }

  // The known error is a linear estimate of an error that is not: its doubt is this part of it, and this part of it in
  // addition counts by its norm, as an error of any direction.
  static constexpr double kDoubt = 0.5;
  static constexpr double kAnyDirection = 0.13;

  PathError<T> known, doubtful;
  T friction{0};       // of the friction impulse, in the norm sqrt(df^T Wtt df)
  T slip_rounding{0};  // of slip, in the same norm: it comes without an impulse that would change v, too
  T strayed{0};        // the normal impulse during which friction had the wrong direction, by how much it was wrong
  T v_rounding{0};     // of v
  T work{0};           // of the normal work in this phase
};

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
