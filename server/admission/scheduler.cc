#include "server/admission/scheduler.h"

#include <limits>
#include <memory>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

using Clock = std::chrono::steady_clock;

// The kernel gives a thread of nice value 0 three times the time of one of 5, and nine times that of one of 10. It is
// enough that cheap calls go first; more would starve expensive ones beside other programs.
constexpr int kDearIsNicer = 5;
constexpr int kStreamsAreNicer = 10;

// A cheap call may be shorter than the switch from one thread to the next. With several slots for each core, the others
// go on while the kernel has set a thread aside that holds one; with one slot the server answers half as many calls.
constexpr int kCheapSlotsPerCore = 8;

constexpr size_t kUnlimited = std::numeric_limits<size_t>::max();

}  // namespace

class Scheduler::SweepHelpers final : public Helpers {
 public:
  SweepHelpers(Scheduler& scheduler, std::string peer) : scheduler_(scheduler), peer_(std::move(peer)) {}

  int most() const override { return static_cast<int>(scheduler_.threads_) - 1; }
  bool Start(Help help) override { return scheduler_.StartHelp(peer_, std::move(help)); }

 private:
  Scheduler& scheduler_;
  const std::string peer_;
};

Scheduler::Scheduler(int threads, int most_waiting, std::stop_token drain)
    : threads_(static_cast<size_t>(threads)),
      cheap_(kCheapSlotsPerCore * threads, kUnlimited),
      expensive_(threads, static_cast<size_t>(most_waiting)),
      streams_(threads, kUnlimited),
      expensive_threads_(threads, kDearIsNicer),
      stream_threads_(threads, kStreamsAreNicer),
      close_(std::move(drain), [this] {
        cheap_.Close();
        expensive_.Close();
        streams_.Close();
      }) {}

absl::Status Scheduler::Compute(const ComputeRequest& request, absl::FunctionRef<void()> work) {
  const bool is_stream = !request.cost.has_value();
  const bool is_cheap = !is_stream && request.cost->is_cheap();
  SlotQueue& queue = is_stream ? streams_ : is_cheap ? cheap_ : expensive_;
  SlotQueue::Waiter waiter;
  waiter.peer = request.peer;
  // Parts of streams take turns: if their deadlines decided, one stream would keep out the others of its peer to its
  // end.
  if (!is_stream) waiter.deadline = request.deadline.value_or(SlotQueue::Time::max());
  if (!is_stream) waiter.expected_s = times_.Expected(*request.cost);
  if (absl::Status refused = queue.Enter(waiter, request.is_gone); !refused.ok()) return refused;
  bool has_computed = false;
  const absl::Cleanup leave = [&] {
    const double computed_s = queue.Leave(waiter);
    if (!has_computed || !request.cost.has_value()) return;
    times_.Learn(*request.cost, computed_s, Clock::now() >= waiter.deadline);
  };
  const char* const when = is_stream ? "" : " before the call began";
  if (request.deadline.has_value() && Clock::now() >= *request.deadline) {
    return absl::DeadlineExceededError(absl::StrCat("the deadline passed", when));
  }
  if (request.is_gone()) return absl::CancelledError(absl::StrCat("the caller gave up", when));
  has_computed = true;
  if (is_cheap) {
    work();
  } else {
    (is_stream ? stream_threads_ : expensive_threads_).Run(work);
  }
  return absl::OkStatus();
}

std::shared_ptr<Helpers> Scheduler::HelpersFor(std::string peer) {
  return std::make_shared<SweepHelpers>(*this, std::move(peer));
}

bool Scheduler::IsFull(size_t helpers) const {
  if (expensive_.waiting() + streams_.waiting() > 0) return true;
  return expensive_.computing() + streams_.computing() + 1 > threads_ + helpers;
}

bool Scheduler::StartHelp(const std::string& peer, Helpers::Help help) {
  if (IsFull(0)) return false;
  struct Visit {
    SlotQueue::Waiter waiter;
    Helpers::Help help;
  };
  const auto visit = std::make_shared<Visit>();
  visit->waiter.peer = peer;
  visit->help = std::move(help);
  if (!streams_.TryEnter(visit->waiter)) return false;
  stream_threads_.Start([this, visit] {
    visit->help([this] { return IsFull(1); });
    streams_.Leave(visit->waiter);
  });
  return true;
}

}  // namespace ricochet::server
