#include "client/cli/cost_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/csv_table.h"
#include "client/cli/plan_report.h"
#include "client/cli/table.h"
#include "core/numerics/decimal.h"
#include "proto/wire/cost.h"
#include "proto/wire/plan.h"

namespace ricochet::cli {
namespace {

constexpr size_t kWidth = 100;
constexpr size_t kGap = 2;

std::string StatusName(CostStatus status) {
  return std::string(absl::StripPrefix(v1::CostRow::Status_Name(ToProto(status)), "STATUS_"));
}

// Breaks a text into lines of at most kWidth bytes. The first line starts with `indent` spaces, the others with two more.
std::string Wrapped(const std::string& text, size_t indent = 0) {
  std::string lines(indent, ' ');
  size_t width = indent;
  for (const absl::string_view word : absl::StrSplit(text, ' ')) {
    if (width + 1 + word.size() > kWidth) {
      absl::StrAppend(&lines, "\n", std::string(indent + 2, ' '), word);
      width = indent + 2 + word.size();
    } else {
      const bool first = width == indent;
      absl::StrAppend(&lines, first ? "" : " ", word);
      width += word.size() + (first ? 0 : 1);
    }
  }
  return lines + "\n";
}

std::vector<std::string> Cells(const CostRow& row, bool on_front) {
  const auto error = [&row](double CostError::*part) {
    return row.achieved.has_value() ? ErrorText((*row.achieved).*part) : "-";
  };
  return {absl::StrCat(on_front ? "* " : "  ", row.name),
          row.solve.has_value() ? TimeText(row.solve->median_s) : "-",
          row.solve.has_value() ? SpreadText(*row.solve) : "-",
          row.batch.has_value() ? TimeText(row.batch->median_s) : "-",
          row.status == CostStatus::kMeasured ? ErrorText(row.claimed.total) : "-",
          error(&CostError::total),
          error(&CostError::numerical),
          error(&CostError::modelling),
          row.steps > 0 ? absl::StrCat(row.steps) : ""};
}

std::string MethodsText(const CostChunk& study) {
  Table table;
  table.Add({"", "one", "", "of a", "error", "error", "numer-", "model-", ""});
  table.Add({"  method", "solve", "±", "batch", "claimed", "made", "ical", "ling", "steps"});
  const std::vector<bool> front = OnFront(study);
  for (size_t i = 0; i < study.rows.size(); ++i) table.Add(Cells(study.rows[i], front[i]));
  return table.Render(0, kGap);
}

std::string PicksText(const CostChunk& study) {
  std::string text = "Method that the plan picks\n";
  for (const CostPick& pick : study.summary->picks) {
    absl::StrAppendFormat(&text, "  %-16s   %s\n", PickRangeText(pick), PickName(study, pick));
  }
  return text;
}

// A long list is told by its ends, because the same note goes with many rows in a row.
std::string MethodNames(const std::vector<std::string>& names) {
  constexpr size_t kMost = 3;
  if (names.size() <= kMost) return absl::StrJoin(names, "; ");
  return absl::StrCat(names.size(), " methods from ", names.front(), " to ", names.back());
}

std::string NotesText(const CostChunk& study) {
  std::string text;
  for (const CostNote& note : NotesOf(study)) {
    absl::StrAppend(&text, Wrapped(absl::StrCat(MethodNames(note.methods), ": ", note.text), 2));
  }
  return text.empty() ? "" : absl::StrCat("\nNotes\n", text);
}

// The columns of a row: the name and the value of each.
using Columns = std::vector<std::pair<std::string, std::string>>;

void AddTime(const std::string& name, const std::optional<CostTime>& time, Columns& columns) {
  const auto add = [&](const char* field, const std::string& value) {
    columns.emplace_back(absl::StrCat(name, ".", field), time.has_value() ? value : "");
  };
  const CostTime known = time.value_or(CostTime());
  add("median_s", ShortestDecimal(known.median_s));
  add("lower_quartile_s", ShortestDecimal(known.lower_quartile_s));
  add("upper_quartile_s", ShortestDecimal(known.upper_quartile_s));
  add("samples", absl::StrCat(known.samples));
  add("per_sample", absl::StrCat(known.per_sample));
}

void AddError(const std::string& name, const std::optional<CostError>& error, Columns& columns) {
  const auto add = [&](const char* field, double CostError::*part) {
    columns.emplace_back(absl::StrCat(name, ".", field), error.has_value() ? ShortestDecimal((*error).*part) : "");
  };
  add("total", &CostError::total);
  add("numerical", &CostError::numerical);
  add("modelling", &CostError::modelling);
}

Columns ColumnsOf(const CostChunk& study, size_t index, bool on_front) {
  const CostRow& row = study.rows[index];
  Columns columns = {
      {"index", absl::StrCat(index)},
      {"name", CsvQuoted(row.name)},
      {"status", StatusName(row.status)},
      {"method.model", ModelName(row.method.model)},
      {"method.arithmetic", absl::AsciiStrToUpper(ArithmeticText(row.method.arithmetic))},
      {"method.tolerance", row.method.tolerance.has_value() ? ShortestDecimal(*row.method.tolerance) : ""},
      {"method.digits", absl::StrCat(row.method.digits)},
      {"method.stiffness", ShortestDecimal(row.method.stiffness)}};
  AddTime("solve", row.solve, columns);
  AddTime("batch", row.batch, columns);
  columns.emplace_back("batch_in_lanes", row.batch_in_lanes ? "1" : "0");
  AddError("claimed", row.status == CostStatus::kMeasured ? std::optional(row.claimed) : std::nullopt, columns);
  AddError("achieved", row.achieved, columns);
  columns.emplace_back("reference_error", ShortestDecimal(row.reference_error));
  columns.emplace_back("deceived", row.IsDeceived() ? "1" : "0");
  columns.emplace_back("steps", absl::StrCat(row.steps));
  columns.emplace_back("right_hand_sides", absl::StrCat(row.right_hand_sides));
  columns.emplace_back("on_front", on_front ? "1" : "0");
  std::vector<std::string> picked;
  for (const CostPick& pick : study.summary->picks) {
    if (pick.row == static_cast<int64_t>(index)) picked.push_back(PickRangeText(pick));
  }
  columns.emplace_back("picked_for_tolerances", CsvQuoted(absl::StrJoin(picked, "; ")));
  columns.emplace_back("note", CsvQuoted(row.note));
  return columns;
}

}  // namespace

std::string TimeText(double seconds) {
  struct Unit {
    const char* name;
    double seconds;
  };
  constexpr Unit kUnits[] = {{"s", 1.0}, {"ms", 1e-3}, {"µs", 1e-6}, {"ns", 1e-9}};
  for (const Unit& unit : kUnits) {
    const double value = seconds / unit.seconds;
    // 999.6 would be rounded to 1000.
    if (value < 0.9995 && unit.seconds > 1e-9) continue;
    const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return absl::StrFormat("%.*f %s", decimals, value, unit.name);
  }
  return "";
}

std::string SpreadText(const CostTime& time) {
  if (time.samples == 1) return "once";
  const double half = 0.5 * (time.upper_quartile_s - time.lower_quartile_s);
  return absl::StrFormat("%.0f %%", time.median_s > 0.0 ? 100.0 * half / time.median_s : 0.0);
}

std::string ErrorText(double error) {
  if (std::isinf(error)) return "unknown";
  return error == 0.0 ? "0" : absl::StrFormat("%.1e", error);
}

std::string PickRangeText(const CostPick& pick) {
  if (pick.least_tolerance == pick.most_tolerance) return Rounded(pick.least_tolerance);
  return absl::StrCat(Rounded(pick.least_tolerance), " to ", Rounded(pick.most_tolerance));
}

std::string PickName(const CostChunk& study, const CostPick& pick) {
  if (pick.row < 0 || pick.row >= static_cast<int64_t>(study.rows.size())) return ModelText(pick.model);
  return study.rows[static_cast<size_t>(pick.row)].name;
}

int64_t AnswerCount(const CostChunk& study) {
  return std::count_if(study.rows.begin(), study.rows.end(),
                       [](const CostRow& row) { return row.achieved.has_value(); });
}

std::string TrustText(const CostChunk& study) {
  const CostSummary& summary = *study.summary;
  return absl::StrCat("Answers that err by more than they claim: ", summary.deceived, " of ", AnswerCount(study),
                      ". No answer: ", summary.failed, ". No time left: ", summary.out_of_time, ".");
}

std::vector<CostNote> NotesOf(const CostChunk& study) {
  std::vector<CostNote> notes;
  for (const CostRow& row : study.rows) {
    if (row.note.empty()) continue;
    auto note =
        std::find_if(notes.begin(), notes.end(), [&row](const CostNote& known) { return known.text == row.note; });
    if (note == notes.end()) note = notes.insert(note, CostNote{.text = row.note, .methods = {}});
    note->methods.push_back(row.name);
  }
  return notes;
}

std::string MachineText(const CostMachine& machine) {
  return absl::StrCat(machine.cpu, ", ", machine.simd_target, ", ", machine.compiler,
                      machine.optimized ? "" : " without optimization: these times say little");
}

std::vector<bool> OnFront(const CostChunk& study) {
  std::vector<bool> front(study.rows.size(), false);
  for (const int64_t row : study.summary->front) front.at(static_cast<size_t>(row)) = true;
  return front;
}

std::string CostText(const CostChunk& study) {
  const CostSummary& summary = *study.summary;
  return absl::StrCat(
      Wrapped(absl::StrCat(study.rows.size(), " methods for one impact. The exact answer: ", summary.reference_source,
                           ".")),
      "\n", MethodsText(study),
      "\n* on the Pareto front: none is as fast and as exact. Errors are fractions of the velocity before.\n\n",
      PicksText(study), NotesText(study), "\n", Wrapped(TrustText(study)),
      Wrapped(absl::StrCat(MachineText(summary.machine), "; ricochet ", study.engine.version, ", engine ",
                           study.engine.fingerprint)),
      "Measured in ", absl::StrFormat("%.2g", summary.elapsed_s), " s\n");
}

std::string CostCsv(const CostChunk& study) {
  std::string text;
  const std::vector<bool> front = OnFront(study);
  for (size_t i = 0; i < study.rows.size(); ++i) {
    const Columns columns = ColumnsOf(study, i, front[i]);
    const auto name = [](std::string* out, const auto& column) { out->append(column.first); };
    const auto value = [](std::string* out, const auto& column) { out->append(column.second); };
    if (i == 0) absl::StrAppend(&text, absl::StrJoin(columns, ",", name), "\n");
    absl::StrAppend(&text, absl::StrJoin(columns, ",", value), "\n");
  }
  return text;
}

}  // namespace ricochet::cli
