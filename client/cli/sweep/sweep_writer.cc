#include "client/cli/sweep/sweep_writer.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/io/row_writer.h"
#include "client/cli/report/invalid_points.h"
#include "client/cli/sweep/sweep_head.h"
#include "client/cli/text/axis_cursor.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/json_text.h"
#include "client/cli/text/table.h"
#include "core/base/counted.h"
#include "proto/wire/plan.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

// --- Summary ---

struct Count {
  std::string name;
  Tally tally;
};

// Returns the regimes that occurred, the points that are inadmissible or did not converge, and the models that solved
// points, named by `name` and `model_name`.
template <typename Name, typename NameOfModel>
std::vector<Count> Counts(const SweepSummary& summary, Name name, NameOfModel model_name) {
  std::vector<Count> counts;
  for (size_t i = 0; i < summary.by_regime.size(); ++i) {
    if (summary.by_regime[i].count > 0) {
      counts.push_back({name(static_cast<Regime>(i)), summary.by_regime[i]});
    }
  }
  counts.push_back({"inadmissible", summary.inadmissible});
  counts.push_back({"not_converged", summary.not_converged});
  for (size_t i = 0; i < summary.by_model.size(); ++i) {
    if (summary.by_model[i].count > 0) counts.push_back({model_name(static_cast<Model>(i)), summary.by_model[i]});
  }
  return counts;
}

std::string SummaryText(const SweepSummary& summary) {
  std::string text = Counted(summary.points, "point");
  if (summary.elapsed_s.has_value()) absl::StrAppend(&text, " in ", Rounded(*summary.elapsed_s), " s");
  const auto by_model = [](Model model) { return absl::StrCat("by model ", ModelText(model)); };
  Table table;
  table.Add({"", "points", "first at index"});
  for (const Count& count : Counts(summary, RegimeText, by_model)) {
    table.Add({absl::StrReplaceAll(count.name, {{"_", " "}}), absl::StrCat(count.tally.count),
               count.tally.count > 0 ? absl::StrCat(count.tally.first_index) : "-"});
  }
  return absl::StrCat(text, "\n", table.Render(2));
}

std::string SummaryCsv(const SweepSummary& summary) {
  const auto by_model = [](Model model) { return absl::StrCat("MODEL_", EnumName(model)); };
  std::string text = absl::StrCat("kind,points,first_index\nall,", summary.points, ",\n");
  for (const Count& count : Counts(summary, RegimeName, by_model)) {
    absl::StrAppend(&text, count.name, ",", count.tally.count, ",",
                    count.tally.count > 0 ? absl::StrCat(count.tally.first_index) : "", "\n");
  }
  return text;
}

SweepWriter SummaryWriter(Format format) {
  return [format](const SweepChunk& chunk) -> absl::StatusOr<std::string> {
    if (!chunk.summary.has_value()) return std::string();
    if (format == Format::kJson || format == Format::kJsonLines) return JsonLineOf(ToProto(*chunk.summary));
    return format == Format::kCsv ? SummaryCsv(*chunk.summary) : SummaryText(*chunk.summary);
  };
}

// --- Points ---

// The names of the cells of a point, in their order.
std::vector<std::string> NamesOf(const SweepRequest& request) {
  std::vector<std::string> names = {"index"};
  for (const Axis& axis : request.grid.axes) names.push_back(axis.path);
  names.insert(names.end(), request.columns.begin(), request.columns.end());
  if (request.with_regime) names.insert(names.end(), {"regime", "status"});
  return names;
}

// Writes a row for each point, and after the last one the summary if the format has room for it.
class PointWriter {
 public:
  // A table has the first `most` points.
  PointWriter(const SweepRequest& request, Format format, int64_t most)
      : request_(std::make_shared<SweepRequest>(request)),
        format_(format),
        most_(most),
        cursor_(request_->grid),
        invalid_(*request_),
        rows_(format, NamesOf(request)) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    std::string text;
    if (chunk.first_index == request_->first_index) {
      if (format_ == Format::kJson) text = SweepHeadJson(*request_, NamesOf(*request_), chunk.engine);
      rows_.Begin(text);
    }
    const int64_t count = format_ == Format::kText ? std::min(chunk.count, most_ - shown_) : chunk.count;
    for (int64_t i = 0; i < count; ++i) {
      rows_.Add(text, [&](RowWriter& row) { Visit(chunk, i, row); });
    }
    shown_ += count;
    if (chunk.summary.has_value()) End(chunk, text);
    return text;
  }

 private:
  // Gives the cells of point `i` of the chunk, in the order of NamesOf.
  void Visit(const SweepChunk& chunk, int64_t i, RowWriter& row) {
    const int64_t index = chunk.first_index + i;
    const auto place = static_cast<size_t>(i);
    row.Integer(index);
    for (const double value : cursor_.At(index)) row.Number(value);
    for (size_t c = 0; c < request_->columns.size(); ++c) {
      row.Number(chunk.values[c * static_cast<size_t>(chunk.count) + place]);
    }
    if (!request_->with_regime) return;
    const Regime regime = chunk.regimes[place];
    const std::string& status = StatusName(chunk.statuses[place]);
    row.Kind(regime);
    // Reasons are too long for a table. They are told once, below it.
    if (format_ == Format::kText || regime != Regime::kInvalid) {
      row.Words(status);
    } else {
      row.Words(absl::StrCat(status, ": ", invalid_.Reason(index)));
    }
  }

  void End(const SweepChunk& chunk, std::string& text) const {
    rows_.End(text);
    if (format_ == Format::kText) {
      const int64_t left_out = chunk.points_total - shown_;
      if (left_out > 0)
        absl::StrAppend(&text, "... and ", Counted(left_out, "more point"), "; --format csv has them all\n");
      absl::StrAppend(&text, "\n", SummaryText(*chunk.summary));
    } else if (format_ == Format::kJson) {
      // The elapsed time would make the file differ from run to run.
      SweepSummary summary = *chunk.summary;
      summary.elapsed_s.reset();
      absl::StrAppend(&text, ",\"summary\":", JsonOf(ToProto(summary)), "}\n");
    }
  }

  std::shared_ptr<const SweepRequest> request_;  // Shared, because writers are copied and the cursor points to it.
  Format format_;
  int64_t most_;
  int64_t shown_ = 0;
  AxisCursor cursor_;
  InvalidPoints invalid_;
  RowWriter rows_;
};

}  // namespace

SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only, int64_t table_points) {
  if (summary_only) return SummaryWriter(format);
  if (format == Format::kNpy) return MakeNpyWriter(request);
  if (format == Format::kNetcdf) return nullptr;
  return PointWriter(request, format, table_points);
}

}  // namespace ricochet::cli
