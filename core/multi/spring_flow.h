// SpringFlow: the motion of contacts on springs while each keeps its mode, as power series in time.
//
//   v' = W (n F + t tau),   loading F' = -k v_n,   unloading F' = -(k/e^2) v_n,   open F = 0, g' = v_n
//   slip along s: tau = -mu s F;   stick: tau keeps u where it is
//
// In a set of modes this is x' = A x with a constant A. A step of length h has theta = |A| h <= 2, and series to order
// 24 leave a remainder below theta^25/25! e^theta of the state. Coefficients are those of powers of time over h. Each
// comes with a bound on what rounding may have made of it, so that one that is no larger counts as zero.
// docs/theory/several_contacts.md derives both. Planar contacts only.

#ifndef RICOCHET_CORE_MULTI_SPRING_FLOW_H_
#define RICOCHET_CORE_MULTI_SPRING_FLOW_H_

#include <Eigen/Cholesky>
#include <array>
#include <cstdint>

#include "core/multi/problem.h"

namespace ricochet::multi {

enum class NormalMode : int8_t { kOpen, kLoading, kUnloading };

struct ContactMode {
  NormalMode normal = NormalMode::kOpen;
  int8_t slip = 0;  // The direction of slip, 0 for stick. Meaningless where the contact is open or has no friction.
  friend bool operator==(const ContactMode&, const ContactMode&) = default;
};
using Modes = std::array<ContactMode, kMostContacts>;

struct SpringState {
  Vector p;                                       // Impulses so far.
  std::array<double, kMostContacts> f{};          // Forces, >= 0.
  std::array<double, kMostContacts> g{};          // Gaps, >= 0; 0 where the contact is closed.
  std::array<double, kMostContacts> largest_f{};  // The largest forces since the contacts closed.
};

inline constexpr int kSeriesOrder = 24;

struct Series {
  std::array<double, kSeriesOrder + 1> c;
  std::array<double, kSeriesOrder + 1> noise;

  // Returns the order of the first coefficient that exceeds its noise, or kSeriesOrder + 1 if there is none.
  int Lead() const;
  double At(double s) const;
  // The integral from 0 to s.
  double Integral(double s) const;
};

// The first s in (0, 1] where a series vanishes whose coefficient `lead` is its first and positive; above 1 if it does
// not. It is found from below, and proved to be the first.
double FirstRoot(const Series& series, int lead);

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMostContacts, kMostContacts>;

// False if contacts with this W of their tangential directions hold each other, so that friction divides in many ways.
bool IsRegular(const Eigen::LLT<Square>& cholesky, const Square& w);

class SpringFlow {
 public:
  // `v` = v- + W p, and `v_noise` bounds its rounding. Where no contact is closed, a step reaches beyond the first
  // closing of a gap.
  SpringFlow(const Problem& problem, const Modes& modes, const SpringState& state, const Vector& v,
             const Vector& v_noise);

  double h() const { return h_; }
  // The stiffness of the contact in its mode.
  double stiffness(int i) const { return stiffness_[At(i)]; }
  // True if the tangential forces of contacts that stick are one choice of many.
  bool split_is_free() const { return split_is_free_; }
  // The rate at which friction may let an error of the state grow, in the metric of energy.
  double growth_rate() const { return growth_rate_; }
  // Returns the normal acceleration of contact i for a unit force at contact j.
  double NormalByForce(int i, int j) const { return by_force_(2 * i + 1, j); }
  // Returns the sum of the magnitudes of the terms of NormalByForce.
  double SizeOfNormalByForce(int i, int j) const { return size_(2 * i + 1, j); }
  double TangentialByForce(int i, int j) const { return by_force_(Eigen::Index{2} * i, j); }
  double FrictionByForce(int i, int j) const { return friction_(i, j); }

  const Series& velocity(int row) const { return v_[At(row)]; }
  const Series& force(int i) const { return f_[At(i)]; }
  const Series& gap(int i) const { return g_[At(i)]; }
  Series Friction(int i) const;

 private:
  bool IsClosed(int i) const { return modes_[At(i)].normal != NormalMode::kOpen; }
  void SetFriction(const Problem& problem, const SpringState& state, const Vector& v);
  void SetStick(const Problem& problem, const Vector& weights);
  void SetStep(const Problem& problem, const SpringState& state, const Vector& v);
  void Expand(const SpringState& state, const Vector& v, const Vector& v_noise);

  using Tall =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, 2 * kMostContacts, kMostContacts>;

  int k_;
  Modes modes_;
  Square friction_;  // Tangential by normal forces.
  Tall by_force_;    // Accelerations by normal forces.
  Tall size_;        // The magnitudes of the terms that these entries are sums of.
  std::array<double, kMostContacts> stiffness_{};
  double h_ = 0.0;
  double growth_rate_ = 0.0;
  bool split_is_free_ = false;
  std::array<Series, size_t{2} * kMostContacts> v_;
  std::array<Series, kMostContacts> f_, g_;
};

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_SPRING_FLOW_H_
