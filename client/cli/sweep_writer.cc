#include "client/cli/sweep_writer.h"

#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/axis_cursor.h"
#include "client/cli/csv_table.h"
#include "client/cli/invalid_points.h"
#include "client/cli/json/json_text.h"
#include "client/cli/npy_writer.h"
#include "client/cli/plan_report.h"
#include "client/cli/sweep_head.h"
#include "client/cli/table.h"
#include "core/numerics/decimal.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

// Appends a text, in quotes if it has a comma or a quote.
void AppendCsv(const std::string& words, std::string& text) {
  if (words.find_first_of(",\"\n") == std::string::npos) {
    text += words;
  } else {
    text += CsvQuoted(words);
  }
}

double ValueAt(const SweepChunk& chunk, size_t column, int64_t i) {
  return chunk.values[column * static_cast<size_t>(chunk.count) + static_cast<size_t>(i)];
}

// The points of chunks, cell by cell.
class Points {
 public:
  explicit Points(const SweepRequest& request)
      : request_(std::make_shared<SweepRequest>(request)), cursor_(request_->grid), invalid_(request_->grid) {}

  const SweepRequest& request() const { return *request_; }

  std::vector<std::string> Names() const {
    std::vector<std::string> names = {"index"};
    for (const Axis& axis : request_->grid.axes) names.push_back(axis.path);
    names.insert(names.end(), request_->columns.begin(), request_->columns.end());
    if (request_->with_regime) names.insert(names.end(), {"regime", "status"});
    return names;
  }

  // Gives the cells of point `i` of the chunk, in the order of Names(), to a cell writer.
  template <typename Cells>
  void Visit(const SweepChunk& chunk, int64_t i, Cells& cells) {
    const int64_t index = chunk.first_index + i;
    cells.Index(index);
    for (const double value : cursor_.At(index)) cells.Number(value);
    for (size_t c = 0; c < request_->columns.size(); ++c) cells.Number(ValueAt(chunk, c, i));
    if (!request_->with_regime) return;
    const Regime regime = chunk.regimes[static_cast<size_t>(i)];
    cells.Kind(regime);
    const RowStatus status = chunk.statuses[static_cast<size_t>(i)];
    const bool has_numbers = regime != Regime::kInvalid;
    if constexpr (Cells::kHasReasons) {
      cells.Words(has_numbers ? StatusName(status) : absl::StrCat(StatusName(status), ": ", invalid_.Reason(index)));
    } else {
      cells.Words(StatusName(status));
    }
  }

 private:
  std::shared_ptr<const SweepRequest> request_;  // Shared, because writers are copied and the cursor points to it.
  AxisCursor cursor_;
  InvalidPoints invalid_;
};

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
    if (format == Format::kJson || format == Format::kJsonLines) return Json(ToProto(*chunk.summary));
    return format == Format::kCsv ? SummaryCsv(*chunk.summary) : SummaryText(*chunk.summary);
  };
}

// --- Points ---

// Makes cells of a table, for which the reasons of invalid points are too long. They are told once, below it.
struct TextCells {
  static constexpr bool kHasReasons = false;
  std::vector<std::string> row;
  void Index(int64_t index) { row.push_back(absl::StrCat(index)); }
  void Number(double value) { row.push_back(Rounded(value)); }
  void Kind(Regime regime) { row.push_back(RegimeText(regime)); }
  void Words(const std::string& words) { row.push_back(words); }
};

// Makes a line of CSV, or a list of JSON.
struct LineCells {
  static constexpr bool kHasReasons = true;
  Format format;
  std::string* text;
  bool is_first = true;

  void Separate() {
    if (!is_first) text->push_back(',');
    is_first = false;
  }
  void Index(int64_t index) {
    Separate();
    AppendDecimal(index, *text);
  }
  void Number(double value) {
    Separate();
    format == Format::kCsv ? AppendDecimal(value, *text) : AppendJson(value, *text);
  }
  void Kind(Regime regime) { Words(RegimeName(regime)); }
  void Words(const std::string& words) {
    Separate();
    format == Format::kCsv ? AppendCsv(words, *text) : AppendJson(words, *text);
  }
};

// Makes an object of JSON.
struct ObjectCells {
  static constexpr bool kHasReasons = true;
  const std::vector<std::string>* keys;  // A name, quoted, and its colon.
  LineCells cells;
  size_t next = 0;

  LineCells& Key() {
    cells.Separate();
    cells.is_first = true;
    *cells.text += (*keys)[next++];
    return cells;
  }
  void Index(int64_t index) { Key().Index(index); }
  void Number(double value) { Key().Number(value); }
  void Kind(Regime regime) { Key().Kind(regime); }
  void Words(const std::string& words) { Key().Words(words); }
};

class TextWriter {
 public:
  TextWriter(const SweepRequest& request, int64_t most) : points_(request), most_(most) { table_.Add(points_.Names()); }

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    for (int64_t i = 0; i < chunk.count && shown_ < most_; ++i, ++shown_) {
      TextCells cells;
      points_.Visit(chunk, i, cells);
      table_.Add(std::move(cells.row));
    }
    if (!chunk.summary.has_value()) return std::string();
    const int64_t left_out = chunk.points_total - shown_;
    std::string text = table_.Render(0);
    if (left_out > 0) {
      absl::StrAppend(&text, "... and ", left_out, " more points; --format csv has them all\n");
    }
    return absl::StrCat(text, "\n", SummaryText(*chunk.summary));
  }

 private:
  Points points_;
  Table table_;
  int64_t most_;
  int64_t shown_ = 0;
};

class CsvWriter {
 public:
  explicit CsvWriter(const SweepRequest& request) : points_(request) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    std::string text;
    if (chunk.first_index == points_.request().first_index) {
      text = absl::StrCat(absl::StrJoin(points_.Names(), ","), "\n");
    }
    for (int64_t i = 0; i < chunk.count; ++i) {
      LineCells cells{.format = Format::kCsv, .text = &text};
      points_.Visit(chunk, i, cells);
      text.push_back('\n');
    }
    return text;
  }

 private:
  Points points_;
};

// An object on a line for each point.
class LinesWriter {
 public:
  explicit LinesWriter(const SweepRequest& request) : points_(request) {
    for (const std::string& name : points_.Names()) {
      AppendJson(name, keys_.emplace_back());
      keys_.back() += ":";
    }
  }

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    std::string text;
    for (int64_t i = 0; i < chunk.count; ++i) {
      ObjectCells cells{.keys = &keys_, .cells = {.format = Format::kJsonLines, .text = &text}};
      text.push_back('{');
      points_.Visit(chunk, i, cells);
      text += "}\n";
    }
    return text;
  }

 private:
  Points points_;
  std::vector<std::string> keys_;
};

// One document: what the sweep is, a list for each point, and the summary.
class DocumentWriter {
 public:
  explicit DocumentWriter(const SweepRequest& request) : points_(request) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    const bool is_start = chunk.first_index == points_.request().first_index;
    std::string text = is_start ? SweepHeadJson(points_.request(), points_.Names(), chunk.engine) : "";
    for (int64_t i = 0; i < chunk.count; ++i) {
      text += is_start && i == 0 ? "\n[" : ",\n[";
      LineCells cells{.format = Format::kJson, .text = &text};
      points_.Visit(chunk, i, cells);
      text.push_back(']');
    }
    if (!chunk.summary.has_value()) return text;
    // A time would make the file of each run another one.
    SweepSummary summary = *chunk.summary;
    summary.elapsed_s.reset();
    return absl::StrCat(text, "\n],\"summary\":", JsonOf(ToProto(summary)), "}\n");
  }

 private:
  Points points_;
};

}  // namespace

SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only, int64_t table_points) {
  if (summary_only) return SummaryWriter(format);
  switch (format) {
    case Format::kText:
      return TextWriter(request, table_points);
    case Format::kJson:
      return DocumentWriter(request);
    case Format::kJsonLines:
      return LinesWriter(request);
    case Format::kCsv:
      return CsvWriter(request);
    case Format::kNpy:
      return NpyWriter(request);
    case Format::kTextproto:
    case Format::kNetcdf:
      break;
  }
  return nullptr;
}

}  // namespace ricochet::cli
