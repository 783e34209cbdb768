#include "client/cli/sweep_writer.h"

#include <array>
#include <charconv>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/axis_cursor.h"
#include "client/cli/plan_report.h"
#include "client/cli/table.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/outcome.h"
#include "proto/wire/sweep.h"
#include "ricochet/cli/sweep_line.pb.h"

namespace ricochet::cli {
namespace {

constexpr int64_t kTextPoints = 40;

template <typename Number>
void AppendNumber(Number number, std::string& text) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  text.append(buffer.data(), result.ptr);
}

double ValueAt(const SweepChunk& chunk, size_t column, int64_t i) {
  return chunk.values[column * static_cast<size_t>(chunk.count) + static_cast<size_t>(i)];
}

std::vector<std::string> Header(const SweepRequest& request) {
  std::vector<std::string> header = {"index"};
  for (const Axis& axis : request.grid.axes) header.push_back(axis.path);
  header.insert(header.end(), request.columns.begin(), request.columns.end());
  if (request.with_regime) header.emplace_back("regime");
  return header;
}

// --- Summary ---

struct Count {
  std::string name;
  Tally tally;
};

// Returns the regimes that occurred, the inadmissible points, and the models that solved points, named by `name` and
// `model_name`.
template <typename Name, typename NameOfModel>
std::vector<Count> Counts(const SweepSummary& summary, Name name, NameOfModel model_name) {
  std::vector<Count> counts;
  for (size_t i = 0; i < summary.by_regime.size(); ++i) {
    if (summary.by_regime[i].count > 0) {
      counts.push_back({name(static_cast<Regime>(i)), summary.by_regime[i]});
    }
  }
  counts.push_back({"inadmissible", summary.inadmissible});
  for (size_t i = 0; i < summary.by_model.size(); ++i) {
    if (summary.by_model[i].count > 0) counts.push_back({model_name(static_cast<Model>(i)), summary.by_model[i]});
  }
  return counts;
}

std::string SummaryText(const SweepSummary& summary) {
  std::string text = absl::StrCat(summary.points, summary.points == 1 ? " point" : " points");
  if (summary.elapsed_s.has_value()) absl::StrAppend(&text, " in ", Rounded(*summary.elapsed_s), " s");
  const auto by_model = [](Model model) { return absl::StrCat("by model ", ModelText(model)); };
  Table table;
  table.Add({"", "points", "first at index"});
  for (const Count& count : Counts(summary, RegimeText, by_model)) {
    table.Add({count.name, absl::StrCat(count.tally.count),
               count.tally.count > 0 ? absl::StrCat(count.tally.first_index) : "-"});
  }
  return absl::StrCat(text, "\n", table.Render(2));
}

std::string SummaryCsv(const SweepSummary& summary) {
  const auto by_model = [](Model model) { return absl::StrCat("MODEL_", ModelName(model)); };
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
    if (format == Format::kJson) return Json(ToProto(*chunk.summary));
    return format == Format::kCsv ? SummaryCsv(*chunk.summary) : SummaryText(*chunk.summary);
  };
}

// --- Points ---

class TextWriter {
 public:
  explicit TextWriter(const SweepRequest& request)
      : request_(std::make_shared<SweepRequest>(request)), cursor_(request_->grid) {
    table_.Add(Header(request));
  }

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    for (int64_t i = 0; i < chunk.count && shown_ < kTextPoints; ++i, ++shown_) table_.Add(Row(chunk, i));
    if (!chunk.summary.has_value()) return std::string();
    const int64_t left_out = chunk.points_total - shown_;
    std::string text = table_.Render(0);
    if (left_out > 0) {
      absl::StrAppend(&text, "... and ", left_out, " more points; --format csv has them all\n");
    }
    return absl::StrCat(text, "\n", SummaryText(*chunk.summary));
  }

 private:
  std::vector<std::string> Row(const SweepChunk& chunk, int64_t i) {
    const int64_t index = chunk.first_index + i;
    std::vector<std::string> row = {absl::StrCat(index)};
    for (const double value : cursor_.At(index)) row.push_back(Rounded(value));
    for (size_t c = 0; c < request_->columns.size(); ++c) row.push_back(Rounded(ValueAt(chunk, c, i)));
    if (request_->with_regime) row.push_back(RegimeText(chunk.regimes[static_cast<size_t>(i)]));
    return row;
  }

  std::shared_ptr<const SweepRequest> request_;  // Shared, because the writer is copied and the cursor points to it.
  AxisCursor cursor_;
  Table table_;
  int64_t shown_ = 0;
};

class CsvWriter {
 public:
  explicit CsvWriter(const SweepRequest& request)
      : request_(std::make_shared<SweepRequest>(request)), cursor_(request_->grid) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    std::string text;
    if (chunk.first_index == request_->first_index) text = absl::StrCat(absl::StrJoin(Header(*request_), ","), "\n");
    for (int64_t i = 0; i < chunk.count; ++i) AppendRow(chunk, i, text);
    return text;
  }

 private:
  void AppendRow(const SweepChunk& chunk, int64_t i, std::string& text) {
    const int64_t index = chunk.first_index + i;
    AppendNumber(index, text);
    for (const double value : cursor_.At(index)) {
      text.push_back(',');
      AppendNumber(value, text);
    }
    for (size_t c = 0; c < request_->columns.size(); ++c) {
      text.push_back(',');
      AppendNumber(ValueAt(chunk, c, i), text);
    }
    if (request_->with_regime) {
      text.push_back(',');
      text.append(RegimeName(chunk.regimes[static_cast<size_t>(i)]));
    }
    text.push_back('\n');
  }

  std::shared_ptr<const SweepRequest> request_;  // Shared, as in TextWriter.
  AxisCursor cursor_;
};

// `sealed` is the chunk as a message.
void SetLine(const SweepChunk& chunk, const v1::SweepResponse& sealed, SweepLine& line) {
  line.set_first_index(chunk.first_index);
  line.set_count(chunk.count);
  line.mutable_values()->Assign(chunk.values.begin(), chunk.values.end());
  line.clear_regimes();
  for (const Regime regime : chunk.regimes) line.add_regimes(ToProto(regime));
  line.set_points_done(chunk.points_done);
  line.set_points_total(chunk.points_total);
  line.clear_summary();
  if (sealed.has_summary()) *line.mutable_summary() = sealed.summary();
  *line.mutable_engine() = sealed.engine();
  line.set_crc32c(sealed.crc32c());
  line.set_grid_fingerprint(sealed.grid_fingerprint());
}

SweepWriter JsonWriter(const SweepRequest& request) {
  return [seal = ChunkSeal(request), proto = v1::SweepResponse(), line = SweepLine()](const SweepChunk& chunk) mutable {
    ToProto(chunk, proto);
    seal.Put(proto);
    SetLine(chunk, proto, line);
    return Json(line);
  };
}

}  // namespace

SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only) {
  if (summary_only) return SummaryWriter(format);
  switch (format) {
    case Format::kText:
      return TextWriter(request);
    case Format::kJson:
      return JsonWriter(request);
    case Format::kCsv:
      break;
  }
  return CsvWriter(request);
}

}  // namespace ricochet::cli
