#include "core/cost/cost.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/invariant.h"
#include "core/cost/cost_methods.h"
#include "core/cost/cost_summary.h"
#include "core/cost/machine.h"
#include "core/cost/methods_by_model.h"
#include "core/cost/stopwatch.h"
#include "core/scene/validate.h"
#include "core/scene/validate_multi.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

constexpr char kOutOfTimeNote[] = "The time limit was used up before this method.";
constexpr char kSlowNote[] = "The method had no answer within its part of the time limit.";
constexpr char kNoScaleNote[] =
    "The velocity before the impact is below the least double, so that no error is a fraction of it.";
constexpr char kNoReferenceNote[] = "No reference was found, so that the error is not known.";
constexpr char kNoReference[] = "none is known";
constexpr char kManyOutcomes[] = "there is none, because rigid bodies alone do not decide between the outcomes";
constexpr char kLongBatchNote[] = "A batch would take more than 2 % of the time limit.";
constexpr char kOneSampleNote[] = "There was time for one solve only.";
constexpr char kOverflowNote[] = "The answer exceeds the largest double.";

// A batch that takes a larger share of the time limit is left out.
constexpr double kMostOfBatch = 0.02;

// Parts of a batch take about so long: much longer than reading the clock, and much shorter than the time after which a
// busy machine turns to another program.
constexpr double kBatchPartS = 50e-6;

std::vector<Violation> CheckOptions(const CostRequest& request) {
  std::vector<Violation> violations;
  const double limit = request.time_limit_s.value_or(kDefaultCostTimeLimitS);
  if (!(limit >= kLeastCostTimeLimitS && limit <= kMostCostTimeLimitS)) {
    violations.push_back(MakeViolation("time_limit_s", limit,
                                       absl::StrCat("be in [", kLeastCostTimeLimitS, ", ", kMostCostTimeLimitS, "]")));
  }
  const int32_t samples = request.samples.value_or(kDefaultCostSamples);
  if (samples < 1 || samples > kMostCostSamples) {
    violations.push_back(MakeViolation("samples", samples, absl::StrCat("be in [1, ", kMostCostSamples, "]")));
  }
  return violations;
}

ContactVelocity ToContactVelocity(const Velocity3& velocity, size_t directions) {
  if (directions == 0) return {};
  ContactVelocity result = {.tangential_m_s = {velocity[0]}, .normal_m_s = velocity[2]};
  if (directions == 2) result.tangential_m_s.push_back(velocity[1]);
  return result;
}

bool IsFinite(const Velocity3& velocity) {
  return std::all_of(velocity.begin(), velocity.end(), [](double value) { return std::isfinite(value); });
}

void AddNote(const std::string& sentence, CostRow& row) {
  if (sentence.empty()) return;
  absl::StrAppend(&row.note, row.note.empty() ? "" : " ", sentence);
}

}  // namespace

class CostStudy::Impl {
 public:
  Impl(const CostRequest& request, std::optional<SceneContact> contact, StudiedScene study)
      : scene_(request.scene),
        contact_(std::move(contact)),
        study_(std::move(study)),
        limit_s_(request.time_limit_s.value_or(kDefaultCostTimeLimitS)),
        samples_(request.samples.value_or(kDefaultCostSamples)) {}

  bool ended() const { return ended_; }

  absl::StatusOr<CostChunk> NextChunk(Stopped stopped) {
    CheckInvariant(!ended_, "a study of cost is not asked for a part after its last");
    if (stopped()) return Cancelled();
    watch_.Restart();
    CostChunk chunk = {.first_row = static_cast<int64_t>(rows_.size()),
                       .rows_total = static_cast<int64_t>(study_.methods.size())};
    if (begun_) {
      rows_.push_back(Study(study_.methods[rows_.size()], stopped));
      if (stopped()) return Cancelled();
      chunk.rows = {rows_.back()};
    }
    begun_ = true;
    chunk.rows_done = static_cast<int64_t>(rows_.size());
    if (chunk.rows_done == chunk.rows_total) {
      chunk.summary = Summarise(stopped);
      ended_ = true;
    }
    spent_before_s_ += watch_.elapsed_s();
    return chunk;
  }

 private:
  static absl::Status Cancelled() { return absl::CancelledError("the study was stopped by its caller"); }

  double spent_s() const { return spent_before_s_ + watch_.elapsed_s(); }

  // V is 0 if nothing moves, and then all errors are 0.
  double Relative(double distance) const { return distance == 0.0 ? 0.0 : distance / study_.speed; }

  CostRow Study(const StudiedMethod& method, Stopped stopped) {
    CostRow row = {.name = method.name, .method = method.method, .note = method.note};
    row.claimed = {.total = kNotKnown, .numerical = kNotKnown, .modelling = kNotKnown};  // Until there is an answer.
    if (!method.unavailable.empty()) {
      row.status = CostStatus::kUnavailable;
      AddNote(method.unavailable, row);
      return row;
    }
    const double left_s = limit_s_ - spent_s();
    if (left_s <= 0.0) {
      row.status = CostStatus::kOutOfTime;
      AddNote(kOutOfTimeNote, row);
      return row;
    }
    const double share_s = left_s / static_cast<double>(study_.methods.size() - rows_.size());
    const double last_s = spent_s() + std::max(share_s, 0.25 * left_s);
    const auto late = [&] { return stopped() || spent_s() > last_s; };
    const Stopwatch first;
    const KernelAnswer answer = method.kernel.answer(late);
    const double first_s = first.elapsed_s();
    if (answer.stopped) {
      row.status = CostStatus::kOutOfTime;
      AddNote(kSlowNote, row);
      return row;
    }
    SetAnswer(answer, method, row);
    if (row.status == CostStatus::kMeasured) SetErrors(answer, method, late, row);
    if (first_s > share_s) {
      row.solve = CostTime{first_s, first_s, first_s, /*samples=*/1, /*per_sample=*/1};
      AddNote(kOneSampleNote, row);
    } else {
      SetTimes(method.kernel, share_s, stopped, row);
    }
    return row;
  }

  void SetAnswer(const KernelAnswer& answer, const StudiedMethod& method, CostRow& row) const {
    row.steps = answer.steps;
    row.right_hand_sides = answer.right_hand_sides;
    const bool finite = IsFinite(answer.velocity);
    row.status = answer.failure.empty() && finite ? CostStatus::kMeasured : CostStatus::kFailed;
    AddNote(answer.note, row);
    AddNote(answer.failure.empty() && !finite ? kOverflowNote : answer.failure, row);
    if (row.status == CostStatus::kFailed) return;
    if (study_.directions > 0) row.velocity_after = ToContactVelocity(answer.velocity, study_.directions);
    row.claimed.numerical = answer.claimed + method.claimed_reduction;
    const double left_out = method.claimed_modelling;
    const bool is_known = std::isfinite(left_out);
    row.claimed.modelling = (is_known ? Relative(left_out * std::fabs(study_.v0)) : left_out) + answer.modelling;
    row.claimed.total = row.claimed.numerical + row.claimed.modelling;
  }

  void SetErrors(const KernelAnswer& answer, const StudiedMethod& method, Stopped stopped, CostRow& row) {
    if (study_.truth == nullptr || method.exact == nullptr) return;
    const ReferenceVelocity* const exact = method.exact->Get(stopped);
    const ReferenceVelocity* const truth = study_.truth->Get(stopped);
    if (exact == nullptr || truth == nullptr) return AddNote(kNoReferenceNote, row);
    CostError achieved = {.total = Relative(Distance(answer.velocity, *truth)),
                          .numerical = Relative(Distance(answer.velocity, *exact)),
                          .modelling = Relative(Distance(*exact, *truth))};
    row.reference_error = exact == truth ? truth->error : truth->error + exact->error;
    // The velocities of certified answers are rounded to doubles, so their error is taken from the decimals instead.
    if (answer.numerical_error.has_value()) {
      achieved.numerical = *answer.numerical_error;
      if (exact == truth) {
        achieved.total = achieved.numerical;
        row.reference_error = 0.0;
      } else {
        achieved.total = achieved.modelling;
      }
    }
    if (!std::isfinite(achieved.total)) return AddNote(kNoScaleNote, row);
    row.achieved = achieved;
  }

  void SetTimes(const Kernel& kernel, double share_s, Stopped stopped, CostRow& row) const {
    const auto repeat = [&](int64_t times) { kernel.repeat(times, stopped); };
    const Sampling sampling = {.samples = samples_, .budget_s = 0.5 * share_s};
    row.solve = TimeOf(repeat, sampling, stopped);
    if (!row.solve.has_value() || row.status != CostStatus::kMeasured) return;
    const double one_s = row.solve->median_s;
    if (one_s * static_cast<double>(kCostBatch) > kMostOfBatch * limit_s_) return AddNote(kLongBatchNote, row);
    const auto batch = kernel.make_batch();
    const auto solve = [&](int64_t first, int64_t count) { batch(first, count, stopped); };
    const auto part = static_cast<int64_t>(std::clamp(kBatchPartS / one_s, 1.0, static_cast<double>(kCostBatch)));
    row.batch = TimeOfList(solve, kCostBatch, part, sampling, stopped);
    row.batch_in_lanes = kernel.in_lanes && row.batch.has_value();
  }

  CostSummary Summarise(Stopped stopped) {
    CostSummary summary = {.front = ParetoFront(rows_)};
    const bool has_plan = study_.directions > 0;
    if (has_plan) summary.picks = PicksFor(scene_, contact_, rows_);
    const ReferenceVelocity* const truth = study_.truth == nullptr ? nullptr : study_.truth->Get(stopped);
    if (truth != nullptr) {
      summary.reference = ToContactVelocity(RoundedVelocity(*truth), study_.directions);
      summary.reference_source = truth->source;
      summary.reference_error = truth->error;
    } else {
      summary.reference_source = has_plan ? kNoReference : kManyOutcomes;
    }
    for (const CostRow& row : rows_) {
      if (row.ClaimIsBroken()) ++summary.deceived;
      if (row.status == CostStatus::kOutOfTime) ++summary.out_of_time;
      if (row.status == CostStatus::kFailed) ++summary.failed;
    }
    summary.machine = ThisMachine();
    summary.elapsed_s = spent_s();
    return summary;
  }

  const Scene scene_;
  std::optional<SceneContact> contact_;
  const StudiedScene study_;
  const double limit_s_;
  const int32_t samples_;
  std::vector<CostRow> rows_;
  bool begun_ = false;
  bool ended_ = false;
  Stopwatch watch_;  // Runs while a part is made.
  double spent_before_s_ = 0.0;
};

absl::StatusOr<CostStudy> CostStudy::Make(const CostRequest& request) {
  std::optional<SceneContact> contact;
  std::optional<MultiReduction> reduction;
  std::vector<Violation> violations;
  if (request.multi_contact.has_value()) {
    violations = Validate(MultiContactRequest{.scene = *request.multi_contact}, reduction);
    if (request.scene != Scene()) violations.push_back({"scene", "is set: must be left out beside multi_contact"});
  } else {
    violations = Validate(request.scene, RestitutionIs::kRequired, contact);
  }
  for (Violation& violation : CheckOptions(request)) violations.push_back(std::move(violation));
  if (!violations.empty()) return InvalidRequest(violations);
  absl::StatusOr<StudiedScene> study = reduction.has_value() ? StudyMultiContact(*request.multi_contact, *reduction)
                                                             : StudyScene(request.scene, contact);
  if (!study.ok()) return study.status();
  return CostStudy(std::make_unique<Impl>(request, std::move(contact), *std::move(study)));
}

CostStudy::CostStudy(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CostStudy::CostStudy(CostStudy&&) noexcept = default;
CostStudy& CostStudy::operator=(CostStudy&&) noexcept = default;
CostStudy::~CostStudy() = default;

bool CostStudy::ended() const { return impl_->ended(); }

absl::StatusOr<CostChunk> CostStudy::NextChunk(absl::FunctionRef<bool()> stopped) { return impl_->NextChunk(stopped); }

}  // namespace ricochet
