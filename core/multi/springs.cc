#include "core/multi/springs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/multi/single_impact.h"
#include "core/multi/spring_conditions.h"
#include "core/multi/spring_flow.h"
#include "core/multi/spring_tail.h"
#include "core/numerics/elementary.h"

namespace ricochet::multi {
namespace {

// Rounding of v- + W p, in units of eps of the terms' magnitudes.
constexpr double kVelocityRounding = 64.0;
// After fewer events than these a motion is not one without end.
constexpr int64_t kLeastOfEndless = 12;
// If the error exceeds this part of the velocities' scale, it is estimated by a second, perturbed motion.
constexpr double kLargeError = 1e-9;
// A motion that repeats this many steps without any change is ended, because it would go on for ever.
constexpr int kMostRepeated = 4;
// A coefficient below this gives a rebound that the rounding of velocities hides: the contact is plastic.
constexpr double kLeastCoefficient = 0x1p-40;
// At most this many combinations of modes are tried if changing one mode after the other does not settle.
constexpr int64_t kMostModes = 6561;

class Motion {
 public:
  // Perturbs the velocities by `push` times the bound on their rounding; the sign alternates from step to step.
  Motion(const Problem& problem, const std::optional<Mirror>& mirror, absl::FunctionRef<bool()> stopped,
         double push = 0.0)
      : problem_(problem),
        mirror_(mirror),
        stopped_(stopped),
        push_(push),
        k_(problem.k),
        rows_(2 * problem.k),
        result_(StartOf(problem)) {
    state_.p = before_.p = tail_ = Vector::Zero(rows_);
    roots_ = problem.w.diagonal().cwiseMax(0.0).cwiseSqrt();
    for (int i = 0; i < k_; ++i) modes_[At(i)].normal = NormalMode::kOpen;
  }

  // Returns the sum of the errors that steps and events have made, without any growth afterwards.
  double made() const { return made_; }
  int64_t steps() const { return steps_; }
  // True if the force of a plastic contact has fallen, and if friction changed its mode while it fell.
  bool has_fallen() const { return has_fallen_; }
  bool friction_changed() const { return friction_changed_; }

  Attained Run(int64_t budget) {
    Refresh();
    result_.end = MultiContactEnd::kBudgetUsedUp;
    Settle();
    while (result_.end == MultiContactEnd::kBudgetUsedUp && result_.events < budget && steps_++ < 8 * budget) {
      if (stopped_() || HasEnded() || TailIsRounding() || HasStalled()) break;
      Step();
    }
    return Finish();
  }

 private:
  // --- The state ---

  double Normal(int i) const { return v_(problem_.N(i)); }
  bool IsClosed(int i) const { return modes_[At(i)].normal != NormalMode::kOpen; }
  bool HasFriction(int i) const { return problem_.laws[At(i)].mu > 0.0; }
  // True if a contact with friction slips by more than rounding.
  bool Slides(int i) const { return HasFriction(i) && std::abs(v_(problem_.T(i))) > noise_(problem_.T(i)); }
  int8_t SlipSign(int i) const { return static_cast<int8_t>(v_(problem_.T(i)) > 0.0 ? 1 : -1); }

  // Computes the velocities anew from the impulses, so that their rounding does not add up.
  void Refresh() {
    if (mirror_.has_value()) {
      mirror_->Average(state_.p);
      mirror_->Average(state_.f);
      mirror_->Average(state_.g);
    }
    v_.resize(rows_);
    noise_.resize(rows_);
    push_ = -push_;
    for (int row = 0; row < rows_; ++row) {
      double sum = problem_.v(row), size = std::abs(sum);
      for (int j = 0; j < rows_; ++j) {
        const double term = problem_.w(row, j) * state_.p(j);
        sum += term;
        size += std::abs(term);
      }
      noise_(row) = kVelocityRounding * kEpsilon * size;
      v_(row) = sum + push_ * noise_(row);
    }
  }

  // --- Modes ---

  // Returns the modes of contact i that the signs of the state allow, its present mode first.
  std::vector<ContactMode> OptionsOf(int i) const {
    const double force = state_.f[At(i)];
    std::vector<NormalMode> normals;
    const double v = Normal(i);
    const double noise = noise_(problem_.N(i));
    if (force > 0.0) {
      if (v <= noise) normals.push_back(NormalMode::kLoading);
      if (v >= -noise && problem_.laws[At(i)].e > 0.0) normals.push_back(NormalMode::kUnloading);
      if (normals.empty()) normals.push_back(NormalMode::kLoading);
    } else {
      if (state_.g[At(i)] > 0.0 || v >= -noise) normals.push_back(NormalMode::kOpen);
      if (state_.g[At(i)] == 0.0 && v <= noise) normals.push_back(NormalMode::kLoading);
    }
    const bool slides = Slides(i);
    std::vector<ContactMode> options;
    for (const NormalMode normal : normals) {
      for (const int8_t slip : {int8_t{0}, int8_t{1}, int8_t{-1}}) {
        const bool may = slides ? slip == SlipSign(i) : HasFriction(i) || slip == 0;
        if (may) options.push_back({normal, slip});
      }
    }
    return options;
  }

  void MakeFlow() {
    flow_.emplace(problem_, modes_, state_, v_, noise_);
    conditions_ = ConditionsOf(problem_, modes_, *flow_, event_);
  }

  // Finds the modes in which every condition has the right sign, and the flow in them.
  void FindModes() {
    for (int i = 0; i < k_; ++i) {
      if (Slides(i) && !StopsWithOthers(i)) modes_[At(i)].slip = SlipSign(i);
    }
    const int most_changes = 8 * k_ + 8;
    for (int change = 0; change < most_changes; ++change) {
      MakeFlow();
      const Condition* const broken = Broken(conditions_, problem_, state_);
      if (broken == nullptr) return;
      Change(*broken, state_.f[At(broken->contact)], modes_[At(broken->contact)]);
    }
    TryAllModes();
  }

  void TryAllModes() {
    std::vector<std::vector<ContactMode>> options;
    int64_t count = 1;
    for (int i = 0; i < k_; ++i) {
      options.push_back(OptionsOf(i));
      count = std::min(count * static_cast<int64_t>(options.back().size()), kMostModes);
    }
    Modes best = modes_;
    int best_lead = -1;
    for (int64_t number = 0; number < count; ++number) {
      int64_t rest = number;
      for (int i = 0; i < k_; ++i) {
        const auto size = static_cast<int64_t>(options[At(i)].size());
        modes_[At(i)] = options[At(i)][At(rest % size)];
        rest /= size;
      }
      MakeFlow();
      const Condition* const broken = Broken(conditions_, problem_, state_);
      if (broken == nullptr) return;
      if (broken->lead > best_lead) best_lead = broken->lead, best = modes_;
    }
    modes_ = best;
    MakeFlow();
    result_.error_is_proved = false;
  }

  // --- Plastic contacts ---

  // Finds the modes, and lets the forces of plastic contacts that stop approaching fall.
  void Settle() {
    FindModes();
    for (int fall = 0; fall < 4 * k_; ++fall) {
      std::vector<int> falling;
      for (const Condition& condition : conditions_) {
        const bool is_broken = condition.lead <= kSeriesOrder && condition.series.c[At(condition.lead)] < 0.0;
        if (is_broken && Falls(condition, problem_, state_)) falling.push_back(condition.contact);
      }
      if (falling.empty()) return;
      if (MayFall(falling)) {
        Fall(falling);
      } else if (ComesToRest(falling)) {
        for (const int i : falling) Open(i);
        ++result_.events;
      } else {
        result_.end = MultiContactEnd::kUndetermined;
        return;
      }
      event_.reset();
      Refresh();
      FindModes();
    }
  }

  // Several may fall at once if none affects another, or if they are images of each other; else the limit depends on
  // the ratios of their coefficients.
  bool MayFall(std::vector<int>& falling) const {
    if (falling.size() == 1) return true;
    if (mirror_.has_value() && falling.size() == 2 && mirror_->image[At(falling[0])] == falling[1]) return true;
    for (const int i : falling) {
      for (const int j : falling) {
        if (i != j && flow_->NormalByForce(i, j) != 0.0) return false;
      }
    }
    falling.resize(1);
    return true;
  }

  // Adds the closed contacts on which those of `falling` act or that act on them. True if all of these are plastic and
  // at rest: they give nothing back, whatever the ratios of their coefficients are.
  bool ComesToRest(std::vector<int>& falling) const {
    for (size_t n = 0; n < falling.size(); ++n) {
      const int i = falling[n];
      if (problem_.laws[At(i)].e > 0.0 || Slides(i) || std::abs(Normal(i)) > noise_(problem_.N(i))) return false;
      for (int j = 0; j < k_; ++j) {
        const bool acts = flow_->NormalByForce(i, j) != 0.0 || flow_->NormalByForce(j, i) != 0.0;
        if (IsClosed(j) && acts && std::find(falling.begin(), falling.end(), j) == falling.end()) falling.push_back(j);
      }
    }
    return true;
  }

  // Returns how far the forces of `falling` may fall until friction changes its mode, by the slopes of the flow.
  double FallUntilFrictionChanges(const std::vector<int>& falling) const {
    double most = state_.f[At(falling[0])];
    for (int l = 0; l < k_; ++l) {
      if (!IsClosed(l) || !HasFriction(l)) continue;
      const double mu = problem_.laws[At(l)].mu;
      const bool is_falling = std::find(falling.begin(), falling.end(), l) != falling.end();
      double tau = 0.0, tau_slope = 0.0, u_slope = 0.0, acceleration = 0.0;
      for (int j = 0; j < k_; ++j) {
        const bool falls = std::find(falling.begin(), falling.end(), j) != falling.end();
        tau += flow_->FrictionByForce(l, j) * state_.f[At(j)];
        acceleration += flow_->TangentialByForce(l, j) * state_.f[At(j)];
        if (falls) tau_slope -= flow_->FrictionByForce(l, j);
        if (falls) u_slope -= flow_->TangentialByForce(l, j);
      }
      const double limit = mu * state_.f[At(l)];
      const double limit_slope = is_falling ? -mu : 0.0;
      const auto shorten = [&](double value, double slope) {
        if (slope < 0.0 && value > 0.0) most = std::min(most, value / -slope);
      };
      if (modes_[At(l)].slip == 0) {
        shorten(limit - tau, limit_slope - tau_slope);
        shorten(limit + tau, limit_slope + tau_slope);
      } else if (std::abs(v_(problem_.T(l))) <= noise_(problem_.T(l))) {
        shorten(modes_[At(l)].slip * acceleration, modes_[At(l)].slip * u_slope);
      }
    }
    return most;
  }

  // Returns the error that an error of one unit adds by moving the instant of a fall: until both paths have fallen, the
  // force acts on in one of them, and the acceleration that says how far it falls changes. Errors are in the metric of
  // energy.
  double ErrorOfDelay(const std::vector<int>& falling) const {
    const int first = falling[0];
    const Series& normal = flow_->velocity(problem_.N(first));
    const double h = flow_->h(), acceleration = std::max(normal.c[1], 0.0) / h;
    double mobility = 0.0, push = 0.0;
    for (const int i : falling) {
      mobility += flow_->NormalByForce(first, i);
      push += roots_(problem_.N(i));
      for (int l = 0; l < k_; ++l) push += std::abs(flow_->FrictionByForce(l, i)) * roots_(problem_.T(l));
    }
    double fall = state_.f[At(first)];
    if (mobility > 0.0) fall = std::min(fall, 2.0 * acceleration / mobility);
    const double change = 4.0 * std::abs(normal.c[2] / mobility) / (h * h);
    return (push * fall + change / std::sqrt(problem_.laws[At(first)].stiffness)) * roots_(problem_.N(first)) /
           acceleration;
  }

  // Lets the forces fall, all by as much, until the integral of the normal acceleration over the fall is 0, or to 0.
  void Fall(const std::vector<int>& falling) {
    has_fallen_ = true;
    const int first = falling[0];
    const double delayed = ErrorOfDelay(falling);
    double ratio = 0.0;
    double integral = 0.0;
    for (int piece = 0; piece < 8 * k_; ++piece) {
      double acceleration = 0.0, slope = 0.0;
      for (int j = 0; j < k_; ++j) acceleration += flow_->NormalByForce(first, j) * state_.f[At(j)];
      for (const int j : falling) slope -= flow_->NormalByForce(first, j);
      for (int j = 0; j < k_; ++j) {
        if (!IsClosed(j)) continue;
        ratio = std::max(ratio, std::abs(flow_->NormalByForce(first, j) / slope) *
                                    std::sqrt(flow_->stiffness(j) / problem_.laws[At(first)].stiffness));
      }
      const double reach = FallUntilFrictionChanges(falling);
      // integral + acceleration x + slope x^2/2 = 0
      const double square = acceleration * acceleration - 2.0 * slope * integral;
      double x = std::numeric_limits<double>::infinity();
      if (slope < 0.0 && square >= 0.0) x = (acceleration + std::sqrt(square)) / -slope;
      const bool ends = x <= reach;
      x = std::min(x, reach);
      integral += x * (acceleration + 0.5 * slope * x);
      for (const int i : falling) {
        state_.f[At(i)] -= x;
        if (state_.f[At(i)] <= 4.0 * kEpsilon * x) state_.f[At(i)] = 0.0;
      }
      if (ends || state_.f[At(first)] == 0.0) break;
      friction_changed_ = true;
      // The forces move just beyond the change of friction, so that FindModes finds the modes after it.
      const double beyond = 0x1p-40 * state_.f[At(first)];
      for (const int i : falling) state_.f[At(i)] -= beyond;
      FindModes();
    }
    for (const int i : falling) {
      if (state_.f[At(i)] == 0.0) modes_[At(i)].normal = NormalMode::kOpen;
    }
    ++result_.events;
    result_.error *= 2.0 + 2.0 * ratio * std::sqrt(static_cast<double>(k_)) + delayed;
  }

  // --- Steps ---

  // Steps to the first event, or as far as the series reach.
  void Step() {
    const Condition* first = nullptr;
    double s = 1.0;
    for (const Condition& condition : conditions_) {
      if (condition.lead > kSeriesOrder) continue;
      const double root = FirstRoot(condition.series, condition.lead);
      if (root > s || (root == s && first != nullptr)) continue;
      s = root;
      first = &condition;
    }
    // A contact that sticks reaches its cone at the latest when its force vanishes, and then it opens.
    for (const Condition& condition : conditions_) {
      if (first == nullptr || condition.keeps != Keeps::kPressed || condition.contact != first->contact) continue;
      if (FirstRoot(condition.series, condition.lead) <= s * (1.0 + 0x1p-36)) first = &condition;
    }
    if (first == nullptr && IsStill()) {
      if (HoldsItself()) {
        result_.end = MultiContactEnd::kWedged;
      } else {
        EndInTail(BoundTail());
      }
      return;
    }
    Advance(s);
    event_.reset();
    if (first != nullptr) {
      ++result_.events;
      event_ = Event{.contacts = ContactsOf(*first, s), .keeps = first->keeps, .has_tie = s <= kZeroOfEvent};
      for (int i = 0; i < k_; ++i) {
        if (StopsWithOthers(i)) modes_[At(i)].slip = 0;
      }
      AddEventError(*first, s);
      // Where contacts hold each other, one that reaches its cone stays on it while the others take the rest. If they
      // divided friction anew, they would reach their cones again and again.
      if (flow_->split_is_free() && IsCone(first->keeps)) {
        Change(*first, state_.f[At(first->contact)], modes_[At(first->contact)]);
      }
      if (first->keeps == Keeps::kPressed) Open(first->contact);
      if (first->keeps == Keeps::kGap) {
        state_.g[At(first->contact)] = 0.0;
        modes_[At(first->contact)].normal = NormalMode::kLoading;
        modes_[At(first->contact)].slip = 0;
      }
    }
    Refresh();
    const Modes before = modes_;
    Settle();
    AddReloadError(before);
  }

  // The contacts of the event at s: the one of `first`, and those whose slip stops with it.
  std::bitset<kMostContacts> ContactsOf(const Condition& first, double s) const {
    std::bitset<kMostContacts> contacts;
    contacts.set(At(first.contact));
    if (first.keeps != Keeps::kSlip) return contacts;
    for (const Condition& condition : conditions_) {
      if (condition.keeps != Keeps::kSlip || condition.lead > kSeriesOrder) continue;
      if (FirstRoot(condition.series, condition.lead) <= s * (1.0 + 0x1p-36)) contacts.set(At(condition.contact));
    }
    return contacts;
  }

  // True if the contact has just stopped slipping at the same instant as another. These may hold each other, and are
  // tried as stuck together: if one were left to slip, the others would only hold against its friction.
  bool StopsWithOthers(int i) const {
    return event_.has_value() && event_->contacts.count() > 1 && event_->contacts[At(i)];
  }

  void Open(int i) {
    state_.f[At(i)] = state_.g[At(i)] = state_.largest_f[At(i)] = 0.0;
    modes_[At(i)].normal = NormalMode::kOpen;
  }

  // True if forces stay and nothing moves.
  bool IsStill() const {
    bool presses = false;
    for (int i = 0; i < k_; ++i) {
      if (!IsClosed(i)) {
        if (Normal(i) < -noise_(problem_.N(i))) return false;  // Its gap will close.
        continue;
      }
      presses = true;
      if (flow_->velocity(problem_.N(i)).Lead() <= kSeriesOrder || flow_->velocity(problem_.T(i)).Lead() == 1)
        return false;
    }
    return presses;
  }

  // True if there are forces and they cancel. Forces that plastic contacts keep only by rounding do not cancel.
  bool HoldsItself() const {
    constexpr double kLeft = 0x1p-20;
    bool presses = false;
    for (int i = 0; i < k_; ++i) {
      if (!IsClosed(i)) continue;
      presses = presses || state_.f[At(i)] > 0.0;
      double acceleration = 0.0, size = 0.0;
      for (int j = 0; j < k_; ++j) {
        acceleration += flow_->NormalByForce(i, j) * state_.f[At(j)];
        size += flow_->SizeOfNormalByForce(i, j) * state_.f[At(j)];
      }
      if (std::abs(acceleration) > kLeft * size) return false;
    }
    return presses;
  }

  bool HasEnded() {
    for (int i = 0; i < k_; ++i) {
      if (IsClosed(i) || Normal(i) < -noise_(problem_.N(i))) return false;
    }
    result_.end = MultiContactEnd::kSeparated;
    return true;
  }

  void Advance(double s) {
    const double h = flow_->h();
    double added = 0.0;
    result_.error *= Exp(flow_->growth_rate() * h * s);
    for (int i = 0; i < k_; ++i) {
      const ContactLaw& law = problem_.laws[At(i)];
      if (!IsClosed(i)) {
        gap_error_[At(i)] += roots_(problem_.N(i)) * result_.error * h * s;
        // A gap that is 0 opens if its first coefficient says so, though the velocity may still be 0.
        const bool is_open = state_.g[At(i)] > 0.0 || Normal(i) > 0.0 || flow_->gap(i).Lead() <= kSeriesOrder;
        if (is_open) state_.g[At(i)] = std::max(flow_->gap(i).At(s), 0.0);
        continue;
      }
      ContactWorks& works = result_.works[At(i)];
      const double stiffness = flow_->stiffness(i);
      const double before = state_.f[At(i)];
      const double after = std::max(flow_->force(i).At(s), 0.0);
      const double normal = h * flow_->force(i).Integral(s);
      const double stored = 0.5 * (after - before) * ((after + before) / stiffness);
      if (modes_[At(i)].normal == NormalMode::kLoading) {
        works.compression -= stored;
        works.compression_impulse += normal;
      } else {
        works.restitution -= stored;
      }
      state_.f[At(i)] = after;
      state_.largest_f[At(i)] = std::max({state_.largest_f[At(i)], before, after});
      state_.p(problem_.N(i)) += normal;
      const double largest = std::max(before, after);
      const double force_error = std::sqrt(stiffness) * result_.error;
      added += kEpsilon * (16.0 * largest / std::sqrt(stiffness) +
                           roots_(problem_.N(i)) * (2.0 * std::abs(state_.p(problem_.N(i))) + 8.0 * normal));
      result_.normal_impulse_error(i) += force_error * h * s + 8.0 * kEpsilon * normal;
      result_.work_error += largest * force_error / stiffness;
      if (law.mu == 0.0) continue;
      const Series tau = flow_->Friction(i);
      const double tangential = h * tau.Integral(s);
      state_.p(problem_.T(i)) += tangential;
      added += 64.0 * kEpsilon * roots_(problem_.T(i)) * (std::abs(tangential) + std::abs(state_.p(problem_.T(i))));
      if (modes_[At(i)].slip == 0) continue;
      works.friction += h * IntegralOfProduct(tau, flow_->velocity(problem_.T(i)), s);
      result_.work_error +=
          h * s * law.mu *
          (largest * roots_(problem_.T(i)) * result_.error + std::abs(v_(problem_.T(i))) * force_error);
    }
    AddError(added);
    if (flow_->split_is_free() || HoldsMoreThanOnce()) result_.split_is_unique = false;
  }

  // True if contacts that do not slip hold each other with one of them on its cone, so that others may take from it.
  bool HoldsMoreThanOnce() const {
    std::vector<int> held;
    bool is_on_cone = false;
    for (int i = 0; i < k_; ++i) {
      if (!IsClosed(i) || !HasFriction(i) || flow_->velocity(problem_.T(i)).Lead() <= kSeriesOrder) continue;
      held.push_back(problem_.T(i));
      is_on_cone = is_on_cone || modes_[At(i)].slip != 0;
    }
    if (!is_on_cone) return false;
    const Square w = problem_.w(held, held);
    return !IsRegular(Eigen::LLT<Square>(w), w);
  }

  static double IntegralOfProduct(const Series& x, const Series& y, double s) {
    std::array<double, 2 * kSeriesOrder + 1> product{};
    for (size_t i = 0; i <= kSeriesOrder; ++i) {
      for (size_t j = 0; j <= kSeriesOrder; ++j) product[i + j] += x.c[i] * y.c[j];
    }
    double value = 0.0;
    for (size_t m = product.size(); m-- > 0;) value = value * s + product[m] / static_cast<double>(m + 1);
    return value * s;
  }

  // --- Errors ---

  // Adds an error that one step or event makes.
  void AddError(double error) {
    result_.error += error;
    made_ += error;
  }

  // An error of the state and the rounding of its velocities may change an event so much: during the time between
  // the event and that of a path within the error, the modes of the two differ.
  void AddEventError(const Condition& event, double s) {
    const int i = event.contact;
    const double error = result_.error;
    const double normal_error = roots_(problem_.N(i)) * error;
    const double stiffness = problem_.laws[At(i)].stiffness;
    const double v = flow_->velocity(problem_.N(i)).At(s);
    double added = 0.0;
    bool grazes = false;
    switch (event.keeps) {
      case Keeps::kApproaching:
      case Keeps::kParting: {
        // A plastic contact whose force has fallen is loaded again.
        const double e = problem_.laws[At(i)].e > 0.0 ? problem_.laws[At(i)].e : 1.0;
        double acceleration = 0.0;
        for (int j = 0; j < k_; ++j) acceleration += flow_->NormalByForce(i, j) * flow_->force(j).At(s);
        added = 0.5 * std::sqrt(stiffness) / e * normal_error * normal_error / std::abs(acceleration);
        grazes = !(added <= error);
        break;
      }
      case Keeps::kPressed:
        added = 0.5 * normal_error * error / v;
        grazes = !(normal_error < 0.5 * v);
        gap_error_[At(i)] = error / std::sqrt(flow_->stiffness(i));
        break;
      case Keeps::kGap:
        added = std::sqrt(stiffness) * (gap_error_[At(i)] + kEpsilon * std::abs(v) * flow_->h());
        grazes = !(normal_error < -0.5 * v);
        break;
      case Keeps::kSlip:
      case Keeps::kConeAbove:
      case Keeps::kConeBelow:
        break;
    }
    if (grazes) result_.error_is_proved = false;
    result_.error += grazes ? std::min(added, error) : added;
    for (const int row : {problem_.T(i), problem_.N(i)}) {
      if (roots_(row) > 0.0) AddError(noise_(row) / roots_(row));
    }
  }

  // A contact that is loaded again keeps the error of its force, which weighs 1/e more.
  void AddReloadError(const Modes& before) {
    for (int i = 0; i < k_; ++i) {
      const bool reloads = before[At(i)].normal == NormalMode::kUnloading &&
                           modes_[At(i)].normal == NormalMode::kLoading && state_.f[At(i)] > 0.0;
      if (reloads) result_.error /= problem_.laws[At(i)].e;
    }
  }

  double SpeedOfApproach() const {
    double speed = 0.0;
    for (int i = 0; i < k_; ++i) speed = std::max(speed, -Normal(i));
    return speed;
  }

  double StoredEnergy() const {
    double stored = 0.0;
    for (int i = 0; i < k_; ++i) {
      if (IsClosed(i)) stored += 0.5 * state_.f[At(i)] * state_.f[At(i)] / flow_->stiffness(i);
    }
    return stored;
  }

  // Sets the most that each velocity can still change. Returns false if nothing bounds that.
  bool BoundTail() {
    if (!beta_.has_value()) beta_ = BetaOf(problem_);
    if (!(*beta_ > 0.0)) return false;
    const double impulse = ImpulseToCome(*beta_, SpeedOfApproach(), StoredEnergy());
    for (int row = 0; row < rows_; ++row) {
      double mobility = 0.0;
      for (int i = 0; i < k_; ++i) {
        mobility = std::max(mobility, std::abs(problem_.w(row, problem_.N(i))) +
                                          problem_.laws[At(i)].mu * std::abs(problem_.w(row, problem_.T(i))));
      }
      tail_(row) = impulse * mobility;
    }
    return true;
  }

  void EndInTail(bool is_bounded) {
    if (is_bounded) result_.slack += tail_;
    if (!is_bounded) result_.error_is_proved = false;
    result_.end = is_bounded ? MultiContactEnd::kEndless : MultiContactEnd::kEndlessEstimate;
  }

  bool IsSlow() const { return SpeedOfApproach() <= 1e-9 * problem_.v.cwiseAbs().maxCoeff(); }

  // Ends a motion that goes through the same events again and again without a change, which rounding can cause. If the
  // motion is slow, only rounding is left of it.
  bool HasStalled() {
    const bool is_same =
        modes_ == modes_before_ && state_.p == before_.p && state_.f == before_.f && state_.g == before_.g;
    repeated_ = is_same ? repeated_ + 1 : 0;
    before_ = state_;
    modes_before_ = modes_;
    if (repeated_ < kMostRepeated) return false;
    if (IsSlow()) EndInTail(BoundTail());
    return true;
  }

  // Ends the motion if what is still to come cannot change more than the rounding of the velocities.
  bool TailIsRounding() {
    if (result_.events < kLeastOfEndless) return false;
    if (!IsSlow()) return false;
    const bool is_bounded = BoundTail();
    const double rounding = noise_.maxCoeff();
    const bool is_rounding = is_bounded ? (tail_.array() <= noise_.array()).all()
                                        : SpeedOfApproach() <= 4.0 * rounding &&
                                              std::sqrt(2.0 * StoredEnergy()) * roots_.maxCoeff() <= 4.0 * rounding;
    if (is_rounding) EndInTail(is_bounded);
    return is_rounding;
  }

  Attained Finish() {
    if (mirror_.has_value()) {
      for (const auto number : {&ContactWorks::compression, &ContactWorks::restitution, &ContactWorks::friction,
                                &ContactWorks::compression_impulse}) {
        std::array<double, kMostContacts> numbers;
        for (size_t i = 0; i < kMostContacts; ++i) numbers[i] = result_.works[i].*number;
        mirror_->Average(numbers);
        for (size_t i = 0; i < kMostContacts; ++i) result_.works[i].*number = numbers[i];
      }
      mirror_->Average(v_);
    }
    result_.v = v_;
    result_.p = state_.p;
    result_.slack += noise_;
    result_.error_is_proved = result_.error_is_proved && std::isfinite(result_.error);
    return std::move(result_);
  }

  const Problem& problem_;
  const std::optional<Mirror> mirror_;
  absl::FunctionRef<bool()> stopped_;
  double push_;         // Changes its sign with each step.
  const int k_, rows_;  // Contacts, and the numbers of all.
  Attained result_;
  SpringState state_;
  Modes modes_{};
  SpringState before_;  // The state and the modes before the last step, and how often in a row they were the same.
  Modes modes_before_{};
  int repeated_ = 0;
  Vector v_, noise_, roots_, tail_;
  std::optional<SpringFlow> flow_;
  std::vector<Condition> conditions_;
  std::optional<Event> event_;  // The condition that is 0 by the event at which the state is.
  std::array<double, kMostContacts> gap_error_{};
  std::optional<double> beta_;
  double made_ = 0.0;  // The errors of all steps and events, none of them grown.
  int64_t steps_ = 0;
  bool has_fallen_ = false, friction_changed_ = false;
};

// Returns the largest component of a velocity over the root of its mobility: its size in the metric of energy.
double SizeOf(const Problem& problem, const Vector& v) {
  double size = 0.0;
  for (int j = 0; j < v.size(); ++j) {
    if (problem.w(j, j) > 0.0) size = std::max(size, std::abs(v(j)) / std::sqrt(problem.w(j, j)));
  }
  return size;
}

// Adds to the errors by how much the result differs from another that has about the same error, or `least` of the size
// of a velocity if that is more.
void AddDifference(const Problem& problem, const Attained& other, double least, Attained& result) {
  constexpr double kMargin = 4.0;
  const auto widen = [](double least_change, double change, double& error) {
    error += kMargin * std::max(least_change, std::abs(change));
  };
  widen(std::sqrt(2.0 * problem.k) * least, std::sqrt(2.0 * problem.k) * SizeOf(problem, other.v - result.v),
        result.error);
  for (int i = 0; i < problem.k; ++i) {
    const int n = problem.N(i);
    const ContactWorks &works = result.works[At(i)], &others = other.works[At(i)];
    widen(least / std::sqrt(problem.w(n, n)), other.p(n) - result.p(n), result.normal_impulse_error(i));
    for (const auto work : {&ContactWorks::compression, &ContactWorks::restitution, &ContactWorks::friction}) {
      widen(least * SizeOf(problem, problem.v), others.*work - works.*work, result.work_error);
    }
  }
  result.error_is_proved = false;
}

// Replaces a bound on the error that has grown too large by an estimate: how far the motion ends beside itself if its
// velocities are pushed to and fro at each step, by a part of the bound on their rounding. What an error becomes
// depends on when it is made: a contact that unloads but is loaded again turns an error of its velocity into one of its
// force that weighs 1/e more, which no error from before can show.
void EstimateError(const Problem& problem, const std::optional<Mirror>& mirror, absl::FunctionRef<bool()> stopped,
                   const Motion& motion, Attained& result) {
  constexpr double kPush = 0.25;  // Twice that still counts as rounding.
  constexpr double kMargin = 4.0;
  const Attained other = Motion(problem, mirror, stopped, kPush).Run(std::max(2 * result.events, motion.steps()));
  const double bound = std::exchange(result.error, 0.0);
  AddDifference(problem, other, kMargin * motion.made(), result);
  if (std::isfinite(bound)) result.error = std::min(result.error, bound);
  if (other.v.allFinite()) return;
  result.error = result.work_error = std::numeric_limits<double>::infinity();
  result.normal_impulse_error.setConstant(result.error);
}

// Compares a plastic impact with two of small coefficients. It is their limit only if friction does not stop and start
// slip while a force falls; where they end elsewhere, theirs is the answer, with an error estimated from the two. If
// `friction_changed`, the impact may end beside the limit by as much as it differs from the smaller of the two.
void CompareWithSmallCoefficients(const Problem& problem, const std::optional<Mirror>& mirror,
                                  absl::FunctionRef<bool()> stopped, int64_t budget, bool friction_changed,
                                  Attained& result) {
  constexpr double kAgree = 1e-5;
  const auto solve = [&](double coefficient) {
    Problem beside = problem;
    for (ContactLaw& law : beside.laws) {
      if (law.e == 0.0) law.e = coefficient;
    }
    return Motion(beside, mirror, stopped).Run(budget);
  };
  Attained small = solve(0x1p-26);
  const double agree = kAgree * SizeOf(problem, problem.v);
  if (SizeOf(problem, small.v - result.v) > agree) {
    result = std::move(small);
    result.error = 0.0;
    AddDifference(problem, solve(0x1p-22), agree, result);
  } else if (friction_changed) {
    AddDifference(problem, small, 0.0, result);
  }
}

// One contact alone does what the model of one contact says.
Attained SolveAlone(const Problem& problem) {
  Attained result = StartOf(problem);
  result.end = MultiContactEnd::kSeparated;
  if (!(problem.v(1) < 0.0)) return result;
  const SingleImpact impact = SolveSingleImpact(problem, 0, problem.v.head(2));
  result.events = 1;
  if (!impact.ended) {
    result.end = MultiContactEnd::kWedged;
    return result;
  }
  // The spring of a contact that is held stays compressed, and presses for ever.
  if (impact.locked) result.end = MultiContactEnd::kWedged;
  result.v = impact.velocity;
  result.p = impact.impulse;
  result.slack.setConstant(impact.velocity_error);
  result.normal_impulse_error(0) = impact.normal_error;
  result.work_error = impact.work_error;
  result.works[0] = impact.works;
  return result;
}

}  // namespace

Attained FindSprings(const Problem& given, const std::optional<Mirror>& mirror, absl::FunctionRef<bool()> stopped,
                     int64_t budget) {
  if (given.k == 1) return SolveAlone(given);
  Problem problem = given;
  double dropped = 0.0;
  for (ContactLaw& law : problem.laws) {
    if (law.e < kLeastCoefficient) dropped = std::max(dropped, std::exchange(law.e, 0.0));
  }
  Motion motion(problem, mirror, stopped);
  Attained result = motion.Run(budget);
  const double large = kLargeError * SizeOf(problem, problem.v);
  if (!result.error_is_proved || result.error > large) EstimateError(problem, mirror, stopped, motion, result);
  if (motion.has_fallen()) {
    CompareWithSmallCoefficients(problem, mirror, stopped, budget, motion.friction_changed(), result);
  }
  if (dropped > 0.0) {
    constexpr double kMargin = 16.0;
    result.error += kMargin * problem.k * dropped * SizeOf(problem, problem.v);
    result.error_is_proved = false;
  }
  return result;
}

}  // namespace ricochet::multi
