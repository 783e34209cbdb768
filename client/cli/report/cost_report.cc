#include "client/cli/report/cost_report.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "client/cli/text/wrap.h"
#include "core/base/counted.h"
#include "proto/wire/cost.h"
#include "proto/wire/plan.h"

namespace ricochet::cli {
namespace {

constexpr size_t kWidth = 100;
constexpr size_t kGap = 2;

// Breaks a text into lines of at most kWidth characters. The first line starts with `indent` spaces, the others with
// two more.
std::string Wrapped(const std::string& text, size_t indent = 0) {
  return absl::StrCat(std::string(indent, ' '), WrapWords(text, kWidth, indent, indent + 2), "\n");
}

std::vector<std::string> Cells(const CostRow& row, bool on_front) {
  const auto error = [&row](double CostError::*part) { return row.achieved.has_value() ? MadeText(row, part) : "-"; };
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
  if (study.summary->picks.empty()) return "";
  std::string text = "Method that the plan picks\n";
  for (const CostPick& pick : study.summary->picks) {
    absl::StrAppendFormat(&text, "  %-16s   %s\n", PickRangeText(pick), PickName(study, pick));
  }
  return text + "\n";
}

// A long list is shortened to its ends, because a note often applies to many neighbouring rows.
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
  return text.empty() ? "" : absl::StrCat("Notes\n", text, "\n");
}

void AddTime(const std::string& name, const std::optional<CostTime>& time, CsvRow& row) {
  const auto seconds = [&](const char* field, double CostTime::*part) {
    row.Number(name + field, time.has_value() ? std::optional((*time).*part) : std::nullopt);
  };
  seconds(".median_s", &CostTime::median_s);
  seconds(".lower_quartile_s", &CostTime::lower_quartile_s);
  seconds(".upper_quartile_s", &CostTime::upper_quartile_s);
  row.Integer(name + ".samples", time.has_value() ? std::optional(time->samples) : std::nullopt);
  row.Integer(name + ".per_sample", time.has_value() ? std::optional(time->per_sample) : std::nullopt);
}

void AddError(const std::string& name, const std::optional<CostError>& error, CsvRow& row) {
  const auto add = [&](const char* field, double CostError::*part) {
    row.Number(name + field, error.has_value() ? std::optional((*error).*part) : std::nullopt);
  };
  add(".total", &CostError::total);
  add(".numerical", &CostError::numerical);
  add(".modelling", &CostError::modelling);
}

CsvRow CsvRowOf(const CostChunk& study, size_t index, bool on_front) {
  const CostRow& row = study.rows[index];
  std::vector<std::string> picked;
  for (const CostPick& pick : study.summary->picks) {
    if (pick.row == static_cast<int64_t>(index)) picked.push_back(PickRangeText(pick));
  }
  CsvRow csv;
  csv.Integer("index", index);
  csv.Quoted("name", row.name);
  csv.Words("status", EnumName(row.status));
  // The methods for several contacts use none of the models for one contact.
  const bool has_model = row.method.model != Model::kUnspecified;
  csv.Words("method.model", has_model ? EnumName(row.method.model) : "");
  csv.Words("method.arithmetic", has_model ? absl::AsciiStrToUpper(ArithmeticText(row.method.arithmetic)) : "");
  csv.Number("method.tolerance", row.method.tolerance);
  csv.Integer("method.digits", row.method.digits);
  csv.Number("method.stiffness", row.method.stiffness);
  AddTime("solve", row.solve, csv);
  AddTime("batch", row.batch, csv);
  csv.Truth("batch_in_lanes", row.batch_in_lanes);
  AddError("claimed", row.status == CostStatus::kMeasured ? std::optional(row.claimed) : std::nullopt, csv);
  AddError("achieved", row.achieved, csv);
  csv.Number("reference_error", row.reference_error);
  csv.Truth("deceived", row.ClaimIsBroken());
  csv.Integer("steps", row.steps);
  csv.Integer("right_hand_sides", row.right_hand_sides);
  csv.Truth("on_front", on_front);
  csv.Quoted("picked_for_tolerances", absl::StrJoin(picked, "; "));
  csv.Quoted("note", row.note);
  return csv;
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
    // A value such as 999.6 would be rounded to 1000, so it takes the next unit.
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

std::string MadeText(const CostRow& row, double CostError::*part) {
  if (!row.achieved.has_value()) return "";
  const CostError& made = *row.achieved;
  const double error = made.*part;
  // The numerical error has a reference of its own, whose error is known only if it is the one of the total error. A
  // method that is its own reference has none at all.
  const bool is_bounded =
      part == &CostError::total || (part == &CostError::numerical && (made.modelling == 0.0 || error == 0.0));
  return is_bounded && error < row.reference_error ? absl::StrCat("<=", ErrorText(row.reference_error))
                                                   : ErrorText(error);
}

std::string PickRangeText(const CostPick& pick) {
  if (pick.least_tolerance == pick.most_tolerance) return Rounded(pick.least_tolerance);
  return absl::StrCat(Rounded(pick.least_tolerance), " to ", Rounded(pick.most_tolerance));
}

std::string PickName(const CostChunk& study, const CostPick& pick) {
  if (pick.model == Model::kNone) return "no model, as the contact separates";
  if (pick.row < 0 || pick.row >= static_cast<int64_t>(study.rows.size())) return ModelText(pick.model);
  const CostRow& row = study.rows[static_cast<size_t>(pick.row)];
  if (row.status != CostStatus::kMeasured) return row.name;
  return absl::StrCat(row.name, ", which claims ", ErrorText(row.claimed.total));
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
  return absl::StrCat(Wrapped(absl::StrCat(Counted(study.rows.size(), "method"),
                                           " for one impact. The exact answer: ", summary.reference_source, ".")),
                      "\n", MethodsText(study), "\n",
                      summary.front.empty() ? "" : "* on the Pareto front: none is as fast and as exact. ",
                      "Errors are fractions of the velocity before.\n\n", PicksText(study), NotesText(study),
                      Wrapped(TrustText(study)),
                      Wrapped(absl::StrCat(MachineText(summary.machine), "; ricochet ", study.engine.version,
                                           ", engine ", study.engine.fingerprint)),
                      "Measured in ", absl::StrFormat("%.2g", summary.elapsed_s), " s\n");
}

std::string CostCsv(const CostChunk& study) {
  const std::vector<bool> front = OnFront(study);
  std::vector<CsvRow> rows;
  for (size_t i = 0; i < study.rows.size(); ++i) rows.push_back(CsvRowOf(study, i, front[i]));
  return CsvOf(rows);
}

}  // namespace ricochet::cli
