// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/mechanism_lanes.cc"
#include "core/contact/mechanism_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/contact/mechanism.h"
#include "core/contact/reduction.h"

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/numerics/compensated_sum-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// A matrix whose entries have a number for each lane.
template <typename V>
class LaneMatrix {
 public:
  LaneMatrix(size_t rows, size_t columns) : columns_(columns), numbers_(rows * columns * Lanes<V>::Count()) {}

  HWY_INLINE double* At(size_t i, size_t k) { return numbers_.data() + (i * columns_ + k) * Lanes<V>::Count(); }
  HWY_INLINE V Get(size_t i, size_t k) { return Lanes<V>::Load(At(i, k)); }
  HWY_INLINE void Set(size_t i, size_t k, V value) { Lanes<V>::Store(value, At(i, k)); }

 private:
  size_t columns_;
  std::vector<double> numbers_;
};

template <typename V>
class MechanismLanes {
  static constexpr size_t kDirections = 3;

 public:
  MechanismLanes(size_t n, absl::Span<const size_t> free)
      : n_(n),
        free_(free),
        scales_(free.size(), 1),
        mass_(free.size(), free.size()),
        factor_(free.size(), free.size()),
        jt_(free.size(), kDirections),
        x_(free.size(), kDirections),
        residual_(free.size(), kDirections),
        jacobian_(kDirections, n),
        rates_(n, 1),
        answer_(kAnswers, 1) {}

  // At most as many states as there are lanes. The lanes that are left repeat the last one.
  void Reduce(absl::Span<MechanismState> states) {
    for (size_t lane = 0; lane < Lanes<V>::Count(); ++lane) {
      MechanismState& state = states[std::min(lane, states.size() - 1)];
      state.is_reduced = Load(state, lane);
    }
    // The factor of M less a multiple of 1 proves that all eigenvalues are above it, as ScaledMass does.
    answer_.Set(kDefinite, 0, Factor(Shift()));
    Factor(Lanes<V>::Fill(0.0));
    Solve();
    SetAnswer();
    for (size_t lane = 0; lane < states.size(); ++lane) Store(lane, states[lane]);
  }

 private:
  // The rows of the answer: W, then the velocity, then 1 where M is surely definite and -1 where it may not be.
  static constexpr size_t kVelocity = 6, kDefinite = 9, kAnswers = 10;

  // Returns false if M is not symmetric or a diagonal entry is not a positive normal number.
  bool Load(const MechanismState& state, size_t lane) {
    bool is_regular = true;
    for (size_t i = 0; i < free_.size(); ++i) {
      const double diagonal = state.mass[free_[i] * n_ + free_[i]];
      const bool is_normal = diagonal >= std::numeric_limits<double>::min() && std::isfinite(diagonal);
      is_regular &= is_normal;
      scales_.At(i, 0)[lane] = is_normal ? MassScale(diagonal) : 1.0;
    }
    for (size_t i = 0; i < free_.size(); ++i) {
      const double scale = scales_.At(i, 0)[lane];
      for (size_t k = 0; k < free_.size(); ++k) {
        const double entry = state.mass[free_[i] * n_ + free_[k]];
        is_regular &= entry == state.mass[free_[k] * n_ + free_[i]];
        mass_.At(i, k)[lane] = scale * entry * scales_.At(k, 0)[lane];
      }
      for (size_t j = 0; j < kDirections; ++j) jt_.At(i, j)[lane] = scale * state.jacobian[j * n_ + free_[i]];
    }
    for (size_t k = 0; k < n_; ++k) {
      for (size_t j = 0; j < kDirections; ++j) jacobian_.At(j, k)[lane] = state.jacobian[j * n_ + k];
      rates_.At(k, 0)[lane] = state.rates[k];
    }
    return is_regular;
  }

  // The least eigenvalue that counts as positive, and what the rounding of a factor can hide.
  V Shift() {
    V trace = Lanes<V>::Fill(0.0);
    for (size_t i = 0; i < free_.size(); ++i) trace = trace + mass_.Get(i, i);
    const size_t n = free_.size();
    return Fma(Lanes<V>::Fill(static_cast<double>(n + 4) * 0x1p-53), trace, Lanes<V>::Fill(LeastEigenvalue(n)));
  }

  // Sets the Cholesky factor of M less `shift` times 1, with the inverses of its diagonal. Returns 1 in the lanes where
  // there is one, else -1.
  V Factor(V shift) {
    V exists = Lanes<V>::Fill(1.0);
    for (size_t j = 0; j < free_.size(); ++j) {
      V pivot = mass_.Get(j, j) - shift;
      for (size_t k = 0; k < j; ++k) pivot = NegativeFma(factor_.Get(j, k), factor_.Get(j, k), pivot);
      exists = Select(Lanes<V>::Fill(0.0) < pivot, exists, Lanes<V>::Fill(-1.0));
      const V inverse = Lanes<V>::Fill(1.0) / SquareRoot(pivot);
      factor_.Set(j, j, inverse);
      for (size_t i = j + 1; i < free_.size(); ++i) {
        V entry = mass_.Get(i, j);
        for (size_t k = 0; k < j; ++k) entry = NegativeFma(factor_.Get(i, k), factor_.Get(j, k), entry);
        factor_.Set(i, j, entry * inverse);
      }
    }
    return exists;
  }

  // Overwrites the columns of `b` by M^-1 b.
  void SolveFor(LaneMatrix<V>& b) {
    const size_t n = free_.size();
    for (size_t j = 0; j < kDirections; ++j) {
      for (size_t i = 0; i < n; ++i) {
        V entry = b.Get(i, j);
        for (size_t k = 0; k < i; ++k) entry = NegativeFma(factor_.Get(i, k), b.Get(k, j), entry);
        b.Set(i, j, entry * factor_.Get(i, i));
      }
      for (size_t i = n; i-- > 0;) {
        V entry = b.Get(i, j);
        for (size_t k = i + 1; k < n; ++k) entry = NegativeFma(factor_.Get(k, i), b.Get(k, j), entry);
        b.Set(i, j, entry * factor_.Get(i, i));
      }
    }
  }

  void SetResidual() {
    for (size_t j = 0; j < kDirections; ++j) {
      for (size_t i = 0; i < free_.size(); ++i) {
        Sum<V> sum(jt_.Get(i, j));
        for (size_t k = 0; k < free_.size(); ++k) sum.Add(mass_.Get(i, k), Lanes<V>::Fill(0.0) - x_.Get(k, j));
        residual_.Set(i, j, sum.value());
      }
    }
  }

  // Sets X and its residual.
  void Solve() {
    x_ = jt_;
    SolveFor(x_);
    SetResidual();
    SolveFor(residual_);
    for (size_t i = 0; i < free_.size(); ++i) {
      for (size_t j = 0; j < kDirections; ++j) x_.Set(i, j, x_.Get(i, j) + residual_.Get(i, j));
    }
    SetResidual();
  }

  void SetAnswer() {
    size_t entry = 0;
    for (size_t i = 0; i < kDirections; ++i) {
      for (size_t j = i; j < kDirections; ++j) {
        Sum<V> w(Lanes<V>::Fill(0.0));
        for (size_t k = 0; k < free_.size(); ++k) w.Add(jt_.Get(k, i), x_.Get(k, j));
        for (size_t k = 0; k < free_.size(); ++k) w.Add(x_.Get(k, i), residual_.Get(k, j));
        answer_.Set(entry++, 0, w.value());
      }
    }
    for (size_t j = 0; j < kDirections; ++j) {
      Sum<V> velocity(Lanes<V>::Fill(0.0));
      for (size_t k = 0; k < n_; ++k) velocity.Add(jacobian_.Get(j, k), rates_.Get(k, 0));
      answer_.Set(kVelocity + j, 0, velocity.value());
    }
  }

  void Store(size_t lane, MechanismState& state) {
    const auto answer = [&](size_t entry) { return answer_.At(entry, 0)[lane]; };
    for (size_t k = 0; k < state.w.size(); ++k) state.w[k] = answer(k);
    for (size_t j = 0; j < kDirections; ++j) state.velocity[j] = answer(kVelocity + j);
    state.is_reduced &=
        answer(kDefinite) > 0.0 && IsSurelyDefinite(state.w) &&
        std::all_of(state.velocity.begin(), state.velocity.end(), [](double v) { return std::isfinite(v); });
    for (size_t i = 0; i < free_.size(); ++i) {
      double* const row = state.response + free_[i] * kDirections;
      for (size_t j = 0; j < kDirections; ++j) row[j] = scales_.At(i, 0)[lane] * x_.At(i, j)[lane];
    }
  }

  const size_t n_;
  const absl::Span<const size_t> free_;
  LaneMatrix<V> scales_, mass_, factor_, jt_, x_, residual_, jacobian_, rates_, answer_;
};

void ReduceStates(size_t n, absl::Span<const size_t> free, absl::Span<MechanismState> states) {
  MechanismLanes<Vector> lanes(n, free);
  for (size_t first = 0; first < states.size(); first += Lanes<Vector>::Count()) {
    lanes.Reduce(states.subspan(first, Lanes<Vector>::Count()));
  }
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(ReduceStates);

void ReduceInLanes(const Mechanism& form, absl::Span<MechanismState> states) {
  if (form.rates.size() > kMostInLanes) return;
  const std::vector<Eigen::Index> free = FreeCoordinates(form, true);
  HWY_DYNAMIC_DISPATCH(ReduceStates)(form.rates.size(), std::vector<size_t>(free.begin(), free.end()), states);
}

}  // namespace ricochet

#endif  // HWY_ONCE
