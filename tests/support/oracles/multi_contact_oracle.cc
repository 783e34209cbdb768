#include "tests/support/oracles/multi_contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/certified/flint.h"

namespace ricochet::multi {
namespace {

// A number of 128 bits, each operation rounded to nearest.
class Real {
 public:
  Real() { arf_init(value_); }
  Real(double x) {  // NOLINT(google-explicit-constructor)
    arf_init(value_);
    arf_set_d(value_, x);
  }
  Real(const Real& other) {
    arf_init(value_);
    arf_set(value_, other.value_);
  }
  Real& operator=(const Real& other) {
    arf_set(value_, other.value_);
    return *this;
  }
  ~Real() { arf_clear(value_); }

  friend Real operator+(const Real& x, const Real& y) { return Apply(arf_add, x, y); }
  friend Real operator-(const Real& x, const Real& y) { return Apply(arf_sub, x, y); }
  friend Real operator*(const Real& x, const Real& y) { return Apply(arf_mul_rnd_any, x, y); }
  friend Real operator/(const Real& x, const Real& y) { return Apply(arf_div, x, y); }
  friend Real operator-(const Real& x) { return Real(0.0) - x; }
  Real& operator+=(const Real& x) { return *this = *this + x; }
  Real& operator-=(const Real& x) { return *this = *this - x; }
  friend Real Sqrt(const Real& x) {
    Real root;
    arf_sqrt(root.value_, x.value_, kBits, ARF_RND_NEAR);
    return root;
  }
  friend Real Abs(const Real& x) { return x < Real(0.0) ? -x : x; }
  friend bool operator<(const Real& x, const Real& y) { return arf_cmp(x.value_, y.value_) < 0; }
  friend bool operator>(const Real& x, const Real& y) { return y < x; }
  double Rounded() const { return arf_get_d(value_, ARF_RND_NEAR); }

 private:
  static constexpr slong kBits = 128;

  template <typename Operation>
  static Real Apply(Operation operation, const Real& x, const Real& y) {
    Real result;
    operation(result.value_, x.value_, y.value_, kBits, ARF_RND_NEAR);
    return result;
  }

  arf_t value_;
};

using Reals = std::vector<Real>;
using Matrix = std::vector<Reals>;

// Sums of terms of size 1 that are no larger than this count as 0.
const double kTiny = 1e-25;

size_t At(int i) { return static_cast<size_t>(i); }

// The state that both simulations keep.
struct Motion {
  explicit Motion(const Problem& problem) : k(problem.k), w(At(2 * k), Reals(At(2 * k))), v(At(2 * k)), p(At(2 * k)) {
    for (int i = 0; i < 2 * k; ++i) {
      v[At(i)] = problem.v(i);
      for (int j = 0; j < 2 * k; ++j) w[At(i)][At(j)] = problem.w(i, j);
    }
    for (auto* const works : {&compression, &restitution, &friction}) works->resize(At(k));
  }

  ExactOutcome Outcome() const {
    ExactOutcome outcome;
    const auto round = [](const Reals& reals) {
      std::vector<double> rounded;
      for (const Real& real : reals) rounded.push_back(real.Rounded());
      return rounded;
    };
    outcome.order = order;
    outcome.v = round(v);
    outcome.p = round(p);
    outcome.compression = round(compression);
    outcome.restitution = round(restitution);
    outcome.friction = round(friction);
    return outcome;
  }

  int k;
  Matrix w;
  Reals v, p;
  Reals compression, restitution, friction;
  std::vector<int> order;
};

// --- One impact after the other ---

// One impact of contact i: pieces of constant slope, each to the first event.
void Strike(const Problem& problem, int i, Motion& motion) {
  const size_t t = At(2 * i), n = t + 1;
  const Real wtt = motion.w[t][t], wtn = motion.w[t][n], wnn = motion.w[n][n];
  const Real mu = problem.laws[At(i)].mu, e = problem.laws[At(i)].e;
  Real u = motion.v[t], v = motion.v[n], tau, f;
  Real left;  // The restitution's work that is still to come.
  Real compressed;
  bool compresses = true;
  for (int piece = 0; piece < 8; ++piece) {
    Real slope;
    const bool stopped = !(Abs(u) > Real(kTiny));
    if (stopped && wtt > Real(0.0)) {
      slope = -(wtn / wtt);
      if (Abs(slope) > mu) slope = wtn > Real(0.0) ? -mu : mu;
    } else if (!stopped) {
      slope = u > Real(0.0) ? -mu : mu;
    }
    const Real du = wtt * slope + wtn, dv = wtn * slope + wnn;
    const bool sticks = stopped && !(Abs(du) > Real(kTiny));
    Real wait(1e30);
    enum { kNone, kStop, kTurn, kEnd } event = kNone;
    if (!sticks && !stopped && (u > Real(0.0)) != (du > Real(0.0)) && Abs(du) > Real(0.0)) {
      wait = -(u / du);
      event = kStop;
    }
    if (compresses && dv > Real(0.0)) {
      const Real turn = -(v / dv);
      if (turn < wait) wait = turn, event = kTurn;
    }
    if (!compresses && dv > Real(0.0)) {
      // v x + dv x^2/2 = left
      const Real end = Real(2.0) * left / (v + Sqrt(v * v + Real(2.0) * dv * left));
      if (!(wait < end)) wait = end, event = kEnd;
    }
    const Real normal = v * wait + dv * wait * wait / Real(2.0);
    motion.friction[At(i)] += slope * (u * wait + du * wait * wait / Real(2.0));
    if (compresses) compressed += normal;
    if (!compresses) left -= normal;
    (compresses ? motion.compression : motion.restitution)[At(i)] += normal;
    tau += wait;
    f += slope * wait;
    u += du * wait;
    v += dv * wait;
    if (event == kStop || sticks) u = 0.0;
    if (event == kEnd) break;
    if (event == kTurn) {
      v = 0.0;
      compresses = false;
      left = -(e * e * compressed);
      if (!(left > Real(0.0))) break;
    }
  }
  motion.p[t] += f;
  motion.p[n] += tau;
  for (size_t row = 0; row < motion.v.size(); ++row) {
    motion.v[row] += motion.w[row][t] * f + motion.w[row][n] * tau;
  }
  motion.v[t] = u;
  motion.v[n] = v;
  motion.order.push_back(i);
}

// --- Springs ---

constexpr int kOrder = 28;
constexpr int kSamples = 12;

struct Mode {
  enum Normal { kOpen, kLoading, kUnloading } normal = kOpen;
  int slip = 0;
};

// Solves a x = b by elimination; false if a is singular.
bool Eliminate(Matrix a, Matrix b, Matrix& x) {
  const size_t n = a.size();
  for (size_t c = 0; c < n; ++c) {
    size_t pivot = c;
    for (size_t r = c; r < n; ++r) {
      if (Abs(a[r][c]) > Abs(a[pivot][c])) pivot = r;
    }
    if (!(Abs(a[pivot][c]) > Real(kTiny))) return false;
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const Real factor = a[r][c] / a[c][c];
      for (size_t j = c; j < n; ++j) a[r][j] -= factor * a[c][j];
      for (size_t j = 0; j < b[r].size(); ++j) b[r][j] -= factor * b[c][j];
    }
  }
  for (size_t r = 0; r < n; ++r) {
    for (Real& value : b[r]) value = value / a[r][r];
  }
  x = b;
  return true;
}

class Springs {
 public:
  explicit Springs(const Problem& problem) : problem_(problem), motion_(problem), k_(problem.k) {
    f_.resize(At(k_));
    g_.resize(At(k_));
    modes_.resize(At(k_));
  }

  std::optional<ExactOutcome> Run(int budget) {
    if (!FindModes()) return std::nullopt;
    for (int events = 0; events < budget;) {
      if (HasEnded()) return motion_.Outcome();
      if (!StepToEvent(events)) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  bool Closed(int i) const { return modes_[At(i)].normal != Mode::kOpen; }
  double Mu(int i) const { return problem_.laws[At(i)].mu; }

  Real Stiffness(int i) const {
    const ContactLaw& law = problem_.laws[At(i)];
    const Real stiffness(law.stiffness);
    return modes_[At(i)].normal == Mode::kUnloading ? stiffness / (Real(law.e) * Real(law.e)) : stiffness;
  }

  bool HasEnded() const {
    for (int i = 0; i < k_; ++i) {
      if (Closed(i) || motion_.v[At(2 * i + 1)] < Real(-kTiny)) return false;
    }
    return true;
  }

  // Tangential forces by normal ones. False if the contacts that stick are held more than once.
  bool SetFriction() {
    friction_.assign(At(k_), Reals(At(k_)));
    std::vector<int> sticking;
    for (int i = 0; i < k_; ++i) {
      if (!Closed(i) || Mu(i) == 0.0) continue;
      if (modes_[At(i)].slip != 0) friction_[At(i)][At(i)] = -Mu(i) * modes_[At(i)].slip;
      if (modes_[At(i)].slip == 0) sticking.push_back(i);
    }
    Matrix a, b, x;
    for (const int i : sticking) {
      Reals& row = a.emplace_back();
      for (const int j : sticking) row.push_back(motion_.w[At(2 * i)][At(2 * j)]);
      Reals& right = b.emplace_back(At(k_));
      for (int j = 0; j < k_; ++j) {
        if (!Closed(j)) continue;
        right[At(j)] =
            -(motion_.w[At(2 * i)][At(2 * j + 1)] + motion_.w[At(2 * i)][At(2 * j)] * friction_[At(j)][At(j)]);
      }
    }
    if (sticking.empty()) return true;
    if (!Eliminate(a, b, x)) return false;
    for (size_t r = 0; r < sticking.size(); ++r) friction_[At(sticking[r])] = x[r];
    return true;
  }

  // Derivatives over factorials, for a unit of time h.
  void Expand(const Real& h, int order) {
    vs_.assign(At(2 * k_), Reals(At(order + 1)));
    fs_.assign(At(k_), Reals(At(order + 1)));
    gs_ = fs_;
    taus_ = fs_;
    for (size_t row = 0; row < vs_.size(); ++row) vs_[row][0] = motion_.v[row];
    for (size_t i = 0; i < fs_.size(); ++i) {
      fs_[i][0] = f_[i];
      gs_[i][0] = g_[i];
    }
    for (int m = 0; m <= order; ++m) {
      for (int i = 0; i < k_; ++i) {
        if (!Closed(i)) continue;
        for (int j = 0; j < k_; ++j) {
          if (Closed(j)) taus_[At(i)][At(m)] += friction_[At(i)][At(j)] * fs_[At(j)][At(m)];
        }
      }
      if (m == order) break;
      const Real step = h / Real(static_cast<double>(m + 1));
      for (int row = 0; row < 2 * k_; ++row) {
        Real sum;
        for (int j = 0; j < k_; ++j) {
          if (!Closed(j)) continue;
          sum += motion_.w[At(row)][At(2 * j + 1)] * fs_[At(j)][At(m)];
          sum += motion_.w[At(row)][At(2 * j)] * taus_[At(j)][At(m)];
        }
        vs_[At(row)][At(m + 1)] = step * sum;
      }
      for (int i = 0; i < k_; ++i) {
        const Real& normal = vs_[At(2 * i + 1)][At(m)];
        if (Closed(i)) fs_[At(i)][At(m + 1)] = -(step * Stiffness(i) * normal);
        if (!Closed(i)) gs_[At(i)][At(m + 1)] = step * normal;
      }
    }
  }

  // The series that must stay >= 0.
  std::vector<Reals> Conditions() const {
    std::vector<Reals> conditions;
    const auto scaled = [](Reals series, double factor) {
      for (Real& c : series) c = Real(factor) * c;
      return series;
    };
    for (int i = 0; i < k_; ++i) {
      const Mode& mode = modes_[At(i)];
      if (mode.normal == Mode::kOpen) {
        conditions.push_back(gs_[At(i)]);
        continue;
      }
      conditions.push_back(scaled(vs_[At(2 * i + 1)], mode.normal == Mode::kLoading ? -1.0 : 1.0));
      conditions.push_back(fs_[At(i)]);
      if (Mu(i) == 0.0) continue;
      if (mode.slip != 0) {
        conditions.push_back(scaled(vs_[At(2 * i)], mode.slip));
        continue;
      }
      for (const double side : {-1.0, 1.0}) {
        Reals cone = scaled(fs_[At(i)], Mu(i));
        for (size_t m = 0; m < cone.size(); ++m) cone[m] += Real(side) * taus_[At(i)][m];
        conditions.push_back(cone);
      }
    }
    return conditions;
  }

  static bool StartsRight(const Reals& series) {
    for (const Real& c : series) {
      if (c > Real(kTiny)) return true;
      if (c < Real(-kTiny)) return false;
    }
    return true;
  }

  // A bound on the rate of the motion.
  double Rate() const {
    double most = 0.0;
    for (int i = 0; i < k_; ++i) {
      double row = 0.0;
      for (int j = 0; j < k_; ++j) {
        if (!Closed(i) || !Closed(j)) continue;
        Real by = motion_.w[At(2 * i + 1)][At(2 * j + 1)];
        for (int l = 0; l < k_; ++l) by += motion_.w[At(2 * i + 1)][At(2 * l)] * friction_[At(l)][At(j)];
        row += std::abs(by.Rounded()) * std::sqrt((Stiffness(i) * Stiffness(j)).Rounded());
      }
      most = std::max(most, row);
    }
    return std::sqrt(most);
  }

  // Tries all modes that the signs allow.
  bool FindModes() {
    std::vector<std::vector<Mode>> options(At(k_));
    for (int i = 0; i < k_; ++i) {
      const Real& v = motion_.v[At(2 * i + 1)];
      const Real& u = motion_.v[At(2 * i)];
      const bool pressed = f_[At(i)] > Real(0.0), apart = g_[At(i)] > Real(0.0);
      const bool falls = !(v > Real(kTiny)), rises = !(v < Real(-kTiny));
      std::vector<int> slips = {0, 1, -1};
      if (u > Real(kTiny)) slips = {1};
      if (u < Real(-kTiny)) slips = {-1};
      if (Mu(i) == 0.0) slips = {0};
      for (const int slip : slips) {
        if (falls && !apart) options[At(i)].push_back({Mode::kLoading, slip});
        if (rises && pressed) options[At(i)].push_back({Mode::kUnloading, slip});
      }
      if (!pressed && (rises || apart)) options[At(i)].push_back({Mode::kOpen, 0});
    }
    const std::function<bool(int)> choose = [&](int i) {
      if (i == k_) {
        if (!SetFriction()) return false;
        Expand(Real(1.0), 8);
        const std::vector<Reals> conditions = Conditions();
        return std::all_of(conditions.begin(), conditions.end(), StartsRight);
      }
      for (const Mode& mode : options[At(i)]) {
        modes_[At(i)] = mode;
        if (choose(i + 1)) return true;
      }
      return false;
    };
    return choose(0);
  }

  static Real Value(const Reals& series, const Real& s) {
    Real value;
    for (size_t m = series.size(); m-- > 0;) value = value * s + series[m];
    return value;
  }

  // The first time in (0, end] at which a condition becomes negative: between two samples, by bisection. 2 if none
  // does.
  static Real FirstFailure(const Reals& series, const Real& end) {
    Reals rest = series;
    while (!rest.empty() && !(Abs(rest.front()) > Real(kTiny))) rest.erase(rest.begin());
    if (rest.empty()) return Real(2.0);
    Real below(0.0);
    for (int sample = 1; sample <= kSamples; ++sample) {
      Real above = end * Real(sample) / Real(kSamples);
      if (!(Value(rest, above) < Real(0.0))) {
        below = above;
        continue;
      }
      for (int half = 0; half < 110; ++half) {
        const Real middle = (below + above) / Real(2.0);
        (Value(rest, middle) < Real(0.0) ? above : below) = middle;
      }
      return above;
    }
    return Real(2.0);
  }

  bool StepToEvent(int& events) {
    SetFriction();
    double h = Rate() > 0.0 ? 0.5 / Rate() : 0.0;
    for (int i = 0; h == 0.0 && i < k_; ++i) {
      const double v = motion_.v[At(2 * i + 1)].Rounded();
      if (v < 0.0) step_ = std::min(step_, 2.0 * g_[At(i)].Rounded() / -v);
    }
    if (h == 0.0) h = step_;
    step_ = 1e30;
    Expand(Real(h), kOrder);
    Real s(1.0);
    bool is_event = false;
    // Beyond the first failure a series means nothing, and may return between two samples. So samples are taken anew,
    // up to there.
    for (int pass = 0; pass < 3; ++pass) {
      const Real end = s;
      for (const Reals& condition : Conditions()) {
        const Real failure = FirstFailure(condition, end);
        if (failure < s || !(s < failure)) s = failure, is_event = true;
      }
    }
    Advance(Real(h), s);
    if (!is_event) return ++steps_ < 100'000;
    ++events;
    return FindModes();
  }

  void Advance(const Real& h, const Real& s) {
    for (int i = 0; i < k_; ++i) {
      const Real force = Value(fs_[At(i)], s);
      if (Closed(i)) {
        Real normal, tangential, slid, power(s);
        for (size_t m = 0; m <= kOrder; ++m) {
          normal += fs_[At(i)][m] * power / Real(static_cast<double>(m + 1));
          tangential += taus_[At(i)][m] * power / Real(static_cast<double>(m + 1));
          power = power * s;
        }
        for (int a = 0; a <= kOrder && modes_[At(i)].slip != 0; ++a) {
          Real inner, ps(1.0);
          for (int b = 0; b <= kOrder; ++b) {
            inner += vs_[At(2 * i)][At(b)] * ps / Real(static_cast<double>(a + b + 1));
            ps = ps * s;
          }
          Real pa(s);
          for (int m = 0; m < a; ++m) pa = pa * s;
          slid += taus_[At(i)][At(a)] * inner * pa;
        }
        motion_.p[At(2 * i + 1)] += h * normal;
        motion_.p[At(2 * i)] += h * tangential;
        motion_.friction[At(i)] += h * slid;
        const Real stored = (force * force - f_[At(i)] * f_[At(i)]) / (Real(2.0) * Stiffness(i));
        (modes_[At(i)].normal == Mode::kLoading ? motion_.compression : motion_.restitution)[At(i)] -= stored;
        f_[At(i)] = Abs(force) > Real(kTiny) ? force : Real(0.0);
        if (!(f_[At(i)] > Real(0.0))) modes_[At(i)].normal = Mode::kOpen;
      } else {
        const Real gap = Value(gs_[At(i)], s);
        g_[At(i)] = gap > Real(kTiny) ? gap : Real(0.0);
      }
    }
    for (size_t row = 0; row < motion_.v.size(); ++row) motion_.v[row] = Value(vs_[row], s);
  }

  const Problem& problem_;
  Motion motion_;
  const int k_;
  Reals f_, g_;
  std::vector<Mode> modes_;
  Matrix friction_, vs_, fs_, gs_, taus_;
  double step_ = 1e30;
  int steps_ = 0;
};

}  // namespace

std::optional<std::vector<ExactOutcome>> OrdersExactly(const Problem& problem, int budget) {
  std::vector<ExactOutcome> outcomes;
  std::vector<Motion> open = {Motion(problem)};
  while (!open.empty()) {
    const Motion motion = open.back();
    open.pop_back();
    bool ends = true;
    for (int i = problem.k - 1; i >= 0; --i) {
      if (!(motion.v[At(2 * i + 1)] < Real(-kTiny))) continue;
      ends = false;
      if (budget-- <= 0) return std::nullopt;
      Strike(problem, i, open.emplace_back(motion));
    }
    if (ends) outcomes.push_back(motion.Outcome());
  }
  return outcomes;
}

std::optional<ExactOutcome> SpringsExactly(const Problem& problem, int budget) { return Springs(problem).Run(budget); }

}  // namespace ricochet::multi
