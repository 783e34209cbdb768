#include "core/multi/orders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "core/multi/endless_pair.h"
#include "core/multi/single_impact.h"

namespace ricochet::multi {
namespace {

// Speeds of approach below this part of the first speeds may be rounding.
constexpr double kRoundingSpeed = 64.0 * kEpsilon;
// A sequence whose impacts have come down to this part of the first speeds counts as one without end.
constexpr double kEndlessSpeed = 1e-12;
// Fewer impacts than these are no sequence without end.
constexpr size_t kLeastOfEndless = 6;

class Search {
 public:
  Search(const Problem& problem, bool shares, absl::FunctionRef<bool()> stopped)
      : problem_(problem), shares_(shares), stopped_(stopped) {
    roots_ = problem.w.diagonal().cwiseMax(0.0).cwiseSqrt();
    scale_ = problem.v.cwiseAbs().maxCoeff();
    coupled_.resize(Place(problem.k, 0));
    for (int i = 0; i < problem.k; ++i) {
      for (int j = 0; j < problem.k; ++j) coupled_[Place(i, j)] = problem.AreCoupled(i, j);
    }
  }

  // Returns false if a sequence exceeds its budget or the allowed depth of the recursion.
  bool Run(int64_t budget) {
    Follow(StartOf(problem_), -1, 0.0, budget);
    return !ran_out_;
  }
  Orders orders() && { return std::move(orders_); }

 private:
  size_t Place(int i, int j) const {
    return static_cast<size_t>(i) * static_cast<size_t>(problem_.k) + static_cast<size_t>(j);
  }

  // Carries the error of the impulses over an impact of contact i: an error of the velocity before changes the impulse
  // by D times it, and the impulse has an error of its own.
  void AddError(int i, const SingleImpact& impact, Attained& state) const {
    const int d = problem_.d;
    const int t = problem_.T(i);
    const auto rows = problem_.w.middleRows(t, d);
    if (state.error_terms == 0.0) state.error_squares = Eigen::MatrixXd::Zero(state.p.size(), state.p.size());
    Eigen::MatrixXd& squares = state.error_squares;
    const Eigen::MatrixXd by_impulses = impact.derivative * rows;
    const Eigen::MatrixXd across = by_impulses * squares;
    squares.middleRows(t, d) += across;
    squares.middleCols(t, d) += across.transpose();
    squares.block(t, t, d, d) += across * by_impulses.transpose();
    // The two halves of the matrix must stay equal, because a difference by rounding would grow.
    squares.triangularView<Eigen::StrictlyLower>() = squares.transpose();
    ContactVector own = impact.derivative.cwiseAbs() * state.slack.segment(t, d);
    for (int a = 0; a < d; ++a) {
      own(a) += (a == d - 1 ? impact.normal_error : impact.tangential_error) + kEpsilon * std::abs(state.p(t + a));
      squares(t + a, t + a) += own(a) * own(a);
      state.work_error += 4.0 * std::abs(impact.impulse(a)) * state.ErrorOf(problem_, t + a);
    }
    if (!impact.impulse_is_known) state.normal_impulse_error(i) = std::numeric_limits<double>::infinity();
    state.error_terms += d;
    state.work_error += impact.work_error;
  }

  // Applies the impact of contact i to the state.
  void Strike(int i, Attained& state) {
    const int d = problem_.d;
    const int t = problem_.T(i);
    const ContactVector x = state.v.segment(t, d);
    const SingleImpact impact = SolveSingleImpact(problem_, i, x);
    state.order.push_back(i);
    ++state.events;
    if (!impact.ended) {
      state.end = MultiContactEnd::kWedged;
      return;
    }
    AddError(i, impact, state);
    state.error_is_proved = state.error_is_proved && impact.error_is_proved;
    for (int j = 0; j < problem_.k; ++j) {
      if (j == i || !coupled_[Place(i, j)]) continue;
      for (int row = problem_.T(j); row < problem_.T(j) + d; ++row) {
        double moved = 0.0, size = 0.0;
        for (int a = 0; a < d; ++a) {
          const double term = problem_.w(row, t + a) * impact.impulse(a);
          moved += term;
          size += std::abs(term);
        }
        state.v(row) += moved;
        state.slack(row) += kEpsilon * (static_cast<double>(d) * size + 0.5 * std::abs(state.v(row)));
      }
    }
    state.v.segment(t, d) = impact.velocity;
    state.slack.segment(t, d).array() += impact.velocity_error;
    state.p.segment(t, d) += impact.impulse;
    ContactWorks& works = state.works[At(i)];
    works.compression += impact.works.compression;
    works.restitution += impact.works.restitution;
    works.friction += impact.works.friction;
    works.compression_impulse += impact.works.compression_impulse;
  }

  // What the approach of contact i would still do, on the scale of Attained::error.
  double LeftOut(int i, const Attained& state) const {
    return (1.0 + problem_.laws[At(i)].e) * -state.v(problem_.N(i)) / roots_(problem_.N(i));
  }

  // Returns the contacts that approach by more than rounding. Adds to `left_out` what the others would still do.
  std::vector<int> Approaching(const Attained& state, double& left_out) const {
    std::vector<int> contacts;
    for (int i = 0; i < problem_.k; ++i) {
      const double v = state.v(problem_.N(i));
      if (!(v < 0.0)) continue;
      if (v < -std::min(state.ErrorOf(problem_, problem_.N(i)), kRoundingSpeed * scale_)) {
        contacts.push_back(i);
      } else {
        left_out += LeftOut(i, state);
      }
    }
    return contacts;
  }

  // Follows all sequences that go on from `state`, after an impact of contact `last` with the speed `approach`, with at
  // most `budget` impacts. Returns the impacts that it took.
  int64_t Follow(Attained state, int last, double approach, int64_t budget) {
    const size_t branched = branched_.size();
    const absl::Cleanup close = [&] {
      for (size_t i = branched; i < branched_.size(); ++i) branched_[i].is_open = false;
    };
    int64_t taken = 0;
    double before_last = approach, before_that = approach;  // The speeds of the impacts before the last one.
    for (;;) {
      if (stopped_()) return taken;
      double left_out = 0.0;
      std::vector<int> next = Approaching(state, left_out);
      if (next.empty()) {
        const bool fell = state.order.size() >= kLeastOfEndless && approach <= kEndlessSpeed * scale_;
        state.end = fell ? MultiContactEnd::kEndlessEstimate : MultiContactEnd::kSeparated;
        // The rest of a sequence without end falls geometrically from one impact to the next but one, as the contacts
        // of a pair may differ.
        const double ratio = std::min(approach / before_that, 1.0 - 1e-6);
        const double of_two = 1.0 + std::max(approach / before_last, before_last / before_that);
        state.error += fell ? left_out * of_two / (1.0 - ratio) : left_out;
        state.error_is_proved = state.error_is_proved && !fell;
        if (fell) FoldPair(state);
        Keep(std::move(state));
        return taken;
      }
      if (next.size() == 1 && last >= 0 && CloseEndlessPair(problem_, last, next[0], approach, state)) {
        state.repeats_from = static_cast<int>(state.order.size());
        state.order.insert(state.order.end(), {next[0], last});
        Keep(std::move(state));
        return taken;
      }
      if (taken >= budget || (!shares_ && depth_ > kMostNested)) {
        ran_out_ = true;
        if (!shares_) return taken;
        state.end = MultiContactEnd::kBudgetUsedUp;
        Keep(std::move(state));
        return taken;
      }
      // If two impacts do not affect each other, the contact with the smaller number is struck first. Where branches
      // are left out, that order may be among them.
      const auto others =
          std::stable_partition(next.begin(), next.end(), [&](int i) { return i > last || coupled_[Place(i, last)]; });
      if (others == next.begin() && !shares_) return taken;
      if (others != next.begin()) next.erase(others, next.end());
      if (next.size() > 1) {
        const Met met = Meet(state);
        if (met == Met::kOnTheWay && EndWhereItCameBack(next, state)) {
          Keep(std::move(state));
          return taken;
        }
        if (met != Met::kNever) return taken;
      }
      if (shares_) LeaveOutBranches(budget - taken, state.events, next);
      for (size_t i = 0; i + 1 < next.size(); ++i) {
        const int64_t share = (budget - taken) / (shares_ ? static_cast<int64_t>(next.size() - i) : 1);
        Attained child = state;
        const double speed = -child.v(problem_.N(next[i]));
        Strike(next[i], child);
        taken += 1;
        if (child.end == MultiContactEnd::kWedged) {
          Keep(std::move(child));
        } else {
          ++depth_;
          taken += Follow(std::move(child), next[i], speed, share - 1);
          --depth_;
          if (ran_out_ && !shares_) return taken;
        }
      }
      last = next.back();
      before_that = std::exchange(before_last, approach);
      approach = -state.v(problem_.N(last));
      Strike(last, state);
      ++taken;
      if (state.end == MultiContactEnd::kWedged) {
        Keep(std::move(state));
        return taken;
      }
    }
  }

  // Ends a sequence that has come back to its own state. It goes on for ever if one of `next` approaches by more than
  // rounding; if no contact does, it has come to rest. Returns false if others, whose turn comes in another order, do.
  bool EndWhereItCameBack(const std::vector<int>& next, Attained& state) const {
    const auto moves = [&](int i) { return -state.v(problem_.N(i)) > kEndlessSpeed * scale_; };
    if (std::any_of(next.begin(), next.end(), moves)) {
      state.end = MultiContactEnd::kBudgetUsedUp;
      return true;
    }
    for (int i = 0; i < problem_.k; ++i) {
      if (moves(i)) return false;
      if (state.v(problem_.N(i)) < 0.0) state.error += LeftOut(i, state);
    }
    state.end = MultiContactEnd::kEndlessEstimate;
    state.error_is_proved = false;
    return true;
  }

  // Keeps as many branches as the budget follows to their ends, at least one, and not always the same.
  void LeaveOutBranches(int64_t budget, int64_t events, std::vector<int>& next) {
    const auto most = static_cast<size_t>(std::max<int64_t>(budget / kImpactsOfSequence, 1));
    if (next.size() <= most) return;
    orders_.complete = false;
    orders_.sampled = true;
    const auto first = static_cast<std::ptrdiff_t>(static_cast<size_t>(events) % next.size());
    std::rotate(next.begin(), next.begin() + first, next.end());
    next.resize(most);
  }

  // Marks the end of an order in which two contacts strike each other in turn as a part that repeats without end.
  static void FoldPair(Attained& state) {
    std::vector<int>& order = state.order;
    size_t first = order.size() - 2;
    while (first > 0 && order[first - 1] == order[first + 1]) --first;
    if (order.size() - first < kLeastOfEndless) return;
    state.repeats_from = static_cast<int>(first);
    order.resize(first + 2);
  }

  // True if two states differ by no more than both errors, nor by more than `most`.
  bool AreEqual(const Attained& x, const Attained& y, double most = std::numeric_limits<double>::infinity()) const {
    const auto difference = [&](int j) { return std::abs(x.v(j) - y.v(j)); };
    // Errors take far longer to compute than differences, and most states differ by more than rounding.
    for (int j = 0; j < x.v.size(); ++j) {
      if (!(difference(j) <= most)) return false;
    }
    for (int j = 0; j < x.v.size(); ++j) {
      if (!(difference(j) <= x.ErrorOf(problem_, j) + y.ErrorOf(problem_, j))) return false;
    }
    return true;
  }

  enum class Met { kNever, kElsewhere, kOnTheWay };

  // Remembers a state in which several contacts approach, and says whether such a state was met before, by another
  // sequence or by this one. The last contact makes no difference, because it does not approach.
  Met Meet(const Attained& state) {
    // States that differ by more than rounding may lead to outcomes that differ by more than their errors.
    const double rounding = 4.0 * kEpsilon * scale_;
    const auto is_same = [&](const Branched& other) { return AreEqual(state, other.state, rounding); };
    const auto found = std::find_if(branched_.begin(), branched_.end(), is_same);
    if (found == branched_.end()) {
      if (branched_.size() < kMostBranched) branched_.push_back({state});
      return Met::kNever;
    }
    return found->is_open ? Met::kOnTheWay : Met::kElsewhere;
  }

  static bool IsEnd(const Attained& state) {
    return state.end != MultiContactEnd::kBudgetUsedUp && state.end != MultiContactEnd::kWedged;
  }

  // If there are too many outcomes, those that have not ended are left out first, then those after more impacts.
  static bool IsLonger(const Attained& x, const Attained& y) {
    return IsEnd(x) == IsEnd(y) ? x.events > y.events : IsEnd(y);
  }

  void Keep(Attained end) {
    const bool is_end = IsEnd(end);
    orders_.complete = orders_.complete && is_end;
    auto same = std::find_if(orders_.outcomes.begin(), orders_.outcomes.end(), [&](const DistinctOutcome& other) {
      return (other.attained.end == end.end || (is_end && IsEnd(other.attained))) && AreEqual(other.attained, end);
    });
    if (same == orders_.outcomes.end() && orders_.outcomes.size() >= kMostOutcomes) {
      orders_.complete = false;
      orders_.left_out = true;
      const auto longest = std::max_element(
          orders_.outcomes.begin(), orders_.outcomes.end(),
          [](const DistinctOutcome& x, const DistinctOutcome& y) { return IsLonger(y.attained, x.attained); });
      if (!IsLonger(longest->attained, end)) return;
      *longest = {};
      same = longest;
    }
    DistinctOutcome& outcome = same == orders_.outcomes.end() ? orders_.outcomes.emplace_back() : *same;
    ++outcome.order_count;
    if (outcome.orders.size() < static_cast<size_t>(kMostOrdersListed)) {
      outcome.orders.push_back(end.order);
      outcome.repeats_from.push_back(end.repeats_from);
    }
    if (outcome.order_count == 1) outcome.attained = std::move(end);
  }

  static constexpr size_t kMostBranched = 1024;
  // Most sequences end within this number of impacts.
  static constexpr int64_t kImpactsOfSequence = 128;
  static constexpr int kMostNested = 64;

  const Problem& problem_;
  const bool shares_;  // Branches share the budget.
  absl::FunctionRef<bool()> stopped_;
  Vector roots_;  // sqrt(W_jj)
  double scale_ = 0.0;
  std::vector<bool> coupled_;
  bool ran_out_ = false;
  int depth_ = 0;  // Branches within branches. Those that share the budget are some ten at most.
  // A state in which several contacts approach; open as long as the sequences that go on from it are followed.
  struct Branched {
    Attained state;
    bool is_open = true;
  };
  std::vector<Branched> branched_;
  Orders orders_;
};

}  // namespace

Orders FindOrders(const Problem& problem, absl::FunctionRef<bool()> stopped, int64_t budget) {
  // A tree that the budget holds is followed whole. Of any other as many sequences are followed to their ends as the
  // budget has room for; the branches share it, so that they come from all of them.
  Search whole(problem, /*shares=*/false, stopped);
  if (whole.Run(budget)) return std::move(whole).orders();
  Search parts(problem, /*shares=*/true, stopped);
  parts.Run(budget);
  return std::move(parts).orders();
}

}  // namespace ricochet::multi
