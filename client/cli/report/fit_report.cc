#include "client/cli/report/fit_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/counted.h"
#include "proto/wire/fit.h"

namespace ricochet::cli {
namespace {

// The text shows residuals of this many rows at most, and kShownShares rows that tell most about an unknown.
constexpr size_t kShownRows = 40;
constexpr size_t kShownShares = 3;

// A residual in sigmas, with so many digits behind the point unless it is large.
std::string ResidualText(double residual, int digits) {
  constexpr double kLarge = 1e6;
  return std::fabs(residual) < kLarge ? absl::StrFormat("%.*f", digits, residual + 0.0) : Rounded(residual);
}

std::string EndText(const FitEnd& end) {
  switch (end.kind) {
    case FitEndKind::kFound:
      return Rounded(*end.value);
    case FitEndKind::kCutByBound:
      return absl::StrCat(Rounded(*end.value), " (bound)");
    case FitEndKind::kUnbounded:
      return "unbounded";
    case FitEndKind::kNotSeen:
    case FitEndKind::kUnspecified:
      break;
  }
  return "not seen";
}

// Names the rows that tell most about an unknown, with their shares.
std::string SharesText(const std::vector<double>& shares) {
  std::vector<size_t> rows(shares.size());
  std::iota(rows.begin(), rows.end(), size_t{0});
  std::stable_sort(rows.begin(), rows.end(), [&](size_t a, size_t b) { return shares[a] > shares[b]; });
  std::string text;
  for (size_t i = 0; i < std::min(kShownShares, rows.size()) && shares[rows[i]] >= 0.005; ++i) {
    absl::StrAppendFormat(&text, "%s%d (%.0f %%)", text.empty() ? "" : ", ", rows[i], 100.0 * shares[rows[i]]);
  }
  return text.empty() ? "none" : text;
}

std::string UnknownsText(const FitResponse& response) {
  Table table;
  table.Add({"", "estimate", "sigma", "95 % from", "to", "rows that tell most"});
  for (const FitEstimate& unknown : response.unknowns) {
    table.Add({unknown.path, unknown.seen ? Rounded(unknown.value) : absl::StrCat("not seen, ", Rounded(unknown.value)),
               unknown.sigma.has_value() ? Rounded(*unknown.sigma) : "none", EndText(unknown.low),
               EndText(unknown.high), SharesText(unknown.row_shares)});
  }
  return absl::StrCat("\nUnknowns\n", table.Render(2));
}

std::string CorrelationText(const FitResponse& response) {
  const size_t size = response.unknowns.size();
  if (size < 2) return "";
  Table table;
  for (size_t k = 0; k < size; ++k) {
    std::vector<std::string> cells = {response.unknowns[k].path};
    for (size_t j = 0; j <= k; ++j) {
      const double correlation = response.correlation[k * size + j];
      cells.push_back(std::isnan(correlation) ? "none" : absl::StrFormat("%.3f", correlation));
    }
    table.Add(std::move(cells));
  }
  return absl::StrCat("\nCorrelation\n", table.Render(2));
}

std::string ResidualsText(const FitRequest& request, const FitResponse& response) {
  Table table;
  std::vector<std::string> head = {"row", "regime"};
  for (const FitMeasured& measured : request.measured) head.push_back(measured.path);
  table.Add(std::move(head));
  const size_t shown = std::min(kShownRows, response.rows.size());
  for (size_t row = 0; row < shown; ++row) {
    std::vector<std::string> cells = {absl::StrCat(row), RegimeText(response.rows[row].regime)};
    for (const double residual : response.rows[row].residuals) {
      cells.push_back(std::isnan(residual) ? "" : ResidualText(residual, 2));
    }
    table.Add(std::move(cells));
  }
  const size_t left_out = response.rows.size() - shown;
  return absl::StrCat("\nResiduals [sigma]\n", table.Render(2),
                      left_out == 0 ? ""
                                    : absl::StrCat("  ... and ", Counted(left_out, "more row"),
                                                   "; --format csv --rows has them all\n"));
}

std::string NotesText(const FitResponse& response) {
  std::string text;
  for (const FitOutlier& outlier : response.outliers) {
    absl::StrAppend(&text, "  Row ", outlier.row, " is an outlier: ", outlier.path, " lies ",
                    ResidualText(outlier.residual, 1), " sigma from the fit.\n");
  }
  for (const std::string& note : response.notes) absl::StrAppend(&text, "  ", note, "\n");
  return text.empty() ? "" : absl::StrCat("\nNotes\n", text);
}

// Says how well the model fits, and whether the data refuse it.
std::string VerdictText(const FitResponse& response) {
  std::string text = absl::StrCat(response.refused ? "REFUSED: " : "", "chi2 ", Rounded(response.chi2), " with ",
                                  response.degrees_of_freedom, " degrees of freedom");
  if (response.p_value.has_value())
    absl::StrAppend(&text, ", probability ", absl::StrFormat("%.3g", *response.p_value));
  return text + "\n";
}

}  // namespace

std::string FitText(const FitRequest& request, const FitResponse& response) {
  return absl::StrCat(VerdictText(response), UnknownsText(response), CorrelationText(response),
                      ResidualsText(request, response), NotesText(response));
}

std::string FitSummaryText(const FitResponse& response) {
  return absl::StrCat(VerdictText(response), NotesText(response));
}

std::string FitCsv(const FitResponse& response) {
  std::vector<CsvRow> rows;
  for (const FitEstimate& unknown : response.unknowns) {
    CsvRow& row = rows.emplace_back();
    row.Words("path", unknown.path);
    row.Number("value", unknown.value);
    row.Truth("seen", unknown.seen);
    row.Number("sigma", unknown.sigma);
    row.Number("low.value", unknown.low.value);
    row.Words("low.kind", EnumName(unknown.low.kind));
    row.Number("high.value", unknown.high.value);
    row.Words("high.kind", EnumName(unknown.high.kind));
  }
  return CsvOf(rows);
}

std::string FitRowsCsv(const FitRequest& request, const FitResponse& response) {
  const auto known = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
  std::vector<CsvRow> rows;
  for (size_t i = 0; i < response.rows.size(); ++i) {
    CsvRow& row = rows.emplace_back();
    row.Integer("row", static_cast<int64_t>(i));
    row.Words("regime", RegimeName(response.rows[i].regime));
    for (size_t j = 0; j < request.measured.size(); ++j) {
      row.Number(absl::StrCat(request.measured[j].path, ".predicted"), known(response.rows[i].predicted[j]));
      row.Number(absl::StrCat(request.measured[j].path, ".residual"), known(response.rows[i].residuals[j]));
    }
  }
  return CsvOf(rows);
}

}  // namespace ricochet::cli
