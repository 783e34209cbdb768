#include "client/cli/report/cost_picture.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/plot/plot_axis.h"
#include "client/cli/report/cost_report.h"
#include "client/cli/text/table.h"
#include "core/base/decimal.h"

namespace ricochet::cli {
namespace {

// Errors below half an ulp of a double are drawn here, on the left edge.
constexpr int kLeastExponent = -17;
// Methods without an answer, and claims without a bound, are drawn in a column of their own beyond the errors.
constexpr double kBeyond = 1e3;
constexpr char kErrsMore[] = "errs more than it claims";
constexpr char kMisses[] = "misses its tolerance";
constexpr char kNoAnswer[] = "gave no answer";
constexpr char kParetoFront[] = "Pareto front";

constexpr char kAxes[] = R"(set logscale xy
set border 3
set tics nomirror scale 0.6
set mxtics 1
set mytics 1
set offsets 0, 0, 0, 0
)";

// A line of the picture: the methods that differ in their tolerance or digits alone.
struct Family {
  Model model;
  Arithmetic arithmetic;
  double stiffness;
  bool operator==(const Family&) const = default;
};

struct Line {
  Family family;
  std::vector<const CostRow*> rows;
};

std::vector<Line> LinesOf(const CostChunk& study) {
  std::vector<Line> lines;
  for (const CostRow& row : study.rows) {
    // Certified numbers are those of one exact model, whatever it is called.
    const bool certified = row.method.arithmetic == Arithmetic::kCertified;
    const Family family{certified ? Model::kUnspecified : row.method.model, row.method.arithmetic,
                        row.method.stiffness};
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& known) { return known.family == family; });
    if (line == lines.end()) line = lines.insert(line, Line{family, {}});
    line->rows.push_back(&row);
  }
  return lines;
}

// The name that the rows share: a tolerance is the last word of a name.
std::string TitleOf(const Line& line) {
  if (line.family.arithmetic == Arithmetic::kCertified) return "certified";
  const CostRow& row = *line.rows.front();
  return row.method.tolerance.has_value() ? row.name.substr(0, row.name.rfind(' ')) : row.name;
}

struct Look {
  const char* colour;
  int open_mark;  // gnuplot's number of the mark.
  int full_mark;
};

// Models are told apart by mark and colour, arithmetics by open and full marks, so that a print in grey can be read
// too.
constexpr std::pair<Model, Look> kLooks[] = {
    {Model::kFrictionless, {"#0072B2", 4, 5}}, {Model::kFirstOrder, {"#D55E00", 14, 15}},
    {Model::kSliding, {"#E69F00", 14, 15}},    {Model::kPendulum, {"#009E73", 8, 9}},
    {Model::kPlanar, {"#CC79A7", 10, 11}},     {Model::kSpatial, {"#56B4E9", 12, 13}},
    {Model::kCompliant, {"#D55E00", 6, 7}},    {Model::kFiniteDuration, {"#8C6D31", 1, 1}},
    {Model::kImpactLaw, {"#0072B2", 6, 7}},
};
constexpr Look kOtherLook = {"#7F7F7F", 3, 3};

Look LookOf(const Family& family) {
  if (family.arithmetic == Arithmetic::kCertified) return {"#000000", 7, 7};
  for (const auto& [model, look] : kLooks) {
    if (model == family.model) return look;
  }
  return kOtherLook;
}

// Curves for the stiffnesses of a spring share a colour and differ by dashes and marks; `ordinal` counts them.
std::string StyleOf(const Family& family, int ordinal) {
  const Look look = LookOf(family);
  const bool full = family.arithmetic == Arithmetic::kCompensated;
  const int mark = family.stiffness > 0.0 ? 1 + ordinal % 3 : full ? look.full_mark : look.open_mark;
  return absl::StrCat("with linespoints linewidth 1.6 pointsize 1.25 linecolor rgb '", look.colour, "' dashtype ",
                      1 + ordinal % 4, " pointtype ", mark);
}

double Drawn(double error) { return std::max(error, std::pow(10.0, kLeastExponent)); }
double DrawnClaim(double error) { return std::isinf(error) ? kBeyond : Drawn(error); }

using Place = std::pair<double, double> (*)(const CostRow& row);

double Made(const CostRow& row) { return Drawn(row.ComparedError()); }

std::pair<double, double> TimePlace(const CostRow& row) { return {Made(row), row.solve->median_s}; }
std::pair<double, double> ClaimPlace(const CostRow& row) { return {DrawnClaim(row.claimed.total), Made(row)}; }

bool HasPlace(const CostRow& row) { return row.solve.has_value() && row.achieved.has_value(); }

std::vector<Curve> CurvesOf(const CostChunk& study, Place place) {
  std::vector<Curve> curves;
  int springs = 0;
  for (const Line& line : LinesOf(study)) {
    Curve curve{.title = TitleOf(line),
                .points = {},
                .style = StyleOf(line.family, line.family.stiffness > 0.0 ? springs++ : 0)};
    for (const CostRow* row : line.rows) {
      if (HasPlace(*row)) curve.points.push_back(place(*row));
    }
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

// Adds a ring around the points of the rows for which `holds`.
void AddRing(const CostChunk& study, Place place, const char* title, const char* style, bool (*holds)(const CostRow&),
             std::vector<Curve>& curves) {
  Curve ring{.title = title, .points = {}, .style = style};
  for (const CostRow& row : study.rows) {
    if (HasPlace(row) && holds(row)) ring.points.push_back(place(row));
  }
  if (!ring.points.empty()) curves.push_back(std::move(ring));
}

void AddRings(const CostChunk& study, Place place, std::vector<Curve>& curves) {
  AddRing(
      study, place, kErrsMore, "with points pointtype 6 pointsize 2.6 linewidth 2 linecolor rgb 'red'",
      [](const CostRow& row) { return row.ClaimIsBroken(); }, curves);
  AddRing(
      study, place, kMisses, "with points pointtype 4 pointsize 2.4 linewidth 1.5 linecolor rgb '#7F7F7F'",
      [](const CostRow& row) {
        return row.method.tolerance.has_value() && row.achieved->numerical > *row.method.tolerance;
      },
      curves);
}

// Draws methods that failed beyond all errors, at the time that they took, or at the top if that is not known.
Curve FailedCurve(const CostChunk& study, double top) {
  Curve failed{.title = kNoAnswer,
               .points = {},
               .style = "with points pointtype 2 pointsize 1.8 linewidth 2.5 linecolor rgb 'red'"};
  for (const CostRow& row : study.rows) {
    if (row.status != CostStatus::kFailed) continue;
    failed.points.emplace_back(kBeyond, row.solve.has_value() ? row.solve->median_s : top);
  }
  return failed;
}

Curve FrontCurve(const CostChunk& study) {
  Curve front{.title = kParetoFront, .points = {}, .style = "with fsteps linewidth 6 linecolor rgb '#d0d0d0'"};
  for (const int64_t row : study.summary->front) {
    const CostRow& at = study.rows.at(static_cast<size_t>(row));
    if (HasPlace(at)) front.points.push_back(TimePlace(at));
  }
  return front;
}

// The labels of an axis of errors: every `every` decades, the least, and `beyond` for what has no error.
std::string ErrorTicks(const char* axis, int every, const std::string& beyond) {
  std::vector<std::string> ticks = {absl::StrCat("'≤", PowerOfTen(kLeastExponent), "' 1e", kLeastExponent)};
  for (int exponent = kLeastExponent + every; exponent <= 0; exponent += every) {
    ticks.push_back(absl::StrCat("'", PowerOfTen(exponent), "' 1e", exponent));
  }
  if (!beyond.empty()) ticks.push_back(absl::StrCat("'", beyond, "' ", ShortestDecimal(kBeyond)));
  return absl::StrCat("set ", axis, "tics (", absl::StrJoin(ticks, ", "), ")\n");
}

// The label of the column beyond the errors needs room on both sides.
std::string ErrorRange(const char* axis, bool beyond, PictureWidth width) {
  const char* end = !beyond ? "10" : width == PictureWidth::kWide ? "4e4" : "2e6";
  return absl::StrCat("set ", axis, "range [4e-18:", end, "]\n");
}

std::string TimeTicks(int least, int most) {
  std::vector<std::string> ticks;
  for (int exponent = least; exponent <= most; ++exponent) {
    static constexpr const char* kUnits[] = {"ns", "µs", "ms", "s"};
    const int unit = std::clamp((exponent + 9) / 3, 0, 3);
    const double number = std::pow(10.0, exponent + 9 - 3 * unit);
    ticks.push_back(absl::StrCat("'", Rounded(number), " ", kUnits[unit], "' 1e", exponent));
  }
  return absl::StrCat("set ytics (", absl::StrJoin(ticks, ", "), ")\nset yrange [1e", least, ":1e", most, "]\n");
}

// Returns the powers of ten between which all times lie.
std::pair<int, int> TimeRange(const CostChunk& study) {
  double least = 1e300;
  double most = 0.0;
  for (const CostRow& row : study.rows) {
    if (!row.solve.has_value() || !(row.solve->median_s > 0.0)) continue;
    least = std::min(least, row.solve->median_s);
    most = std::max(most, row.solve->median_s);
  }
  if (most == 0.0) return {-9, -3};
  const auto low = static_cast<int>(std::floor(std::log10(least)));
  const auto high = static_cast<int>(std::floor(std::log10(most))) + 1;
  return high - low > 1 ? std::pair(low, high) : std::pair(low - 1, high + 1);
}

// Decades from label to label.
int EveryOf(PictureWidth width) { return width == PictureWidth::kWide ? 3 : 5; }

Panel TimePanel(const CostChunk& study, PictureWidth width) {
  const auto [least, most] = TimeRange(study);
  Panel panel{
      .title = "Time of one solve over its error",
      .x_label = width == PictureWidth::kWide ? "error made, as a fraction of the velocity before" : "error made",
      .y_label = "time of one solve"};
  panel.curves.push_back(FrontCurve(study));
  for (Curve& curve : CurvesOf(study, TimePlace)) panel.curves.push_back(std::move(curve));
  AddRings(study, TimePlace, panel.curves);
  Curve failed = FailedCurve(study, std::pow(10.0, most - 0.15));
  const bool any_failed = !failed.points.empty();
  if (any_failed) panel.curves.push_back(std::move(failed));
  panel.settings = absl::StrCat(kAxes, ErrorRange("x", any_failed, width),
                                ErrorTicks("x", EveryOf(width), any_failed ? "no answer" : ""), TimeTicks(least, most));
  return panel;
}

Panel ClaimPanel(const CostChunk& study, PictureWidth width) {
  Panel panel{.title = absl::StrCat("Error made over error claimed:", width == PictureWidth::kWide ? " " : "\n",
                                    study.summary->deceived, " of ", AnswerCount(study), " claim too little"),
              .x_label = "error claimed",
              .y_label = "error made"};
  const bool beyond = std::any_of(study.rows.begin(), study.rows.end(),
                                  [](const CostRow& row) { return HasPlace(row) && std::isinf(row.claimed.total); });
  panel.curves.push_back({.title = "made = claimed",
                          .points = {{4e-18, 4e-18}, {10.0, 10.0}},
                          .style = "with lines linewidth 1.5 dashtype 2 linecolor rgb '#606060'"});
  for (Curve& curve : CurvesOf(study, ClaimPlace)) panel.curves.push_back(std::move(curve));
  AddRings(study, ClaimPlace, panel.curves);
  panel.settings = absl::StrCat(kAxes, ErrorRange("x", beyond, width), ErrorRange("y", false, width),
                                ErrorTicks("x", EveryOf(width), beyond ? "no bound" : ""), ErrorTicks("y", 3, ""),
                                "set label 1 'claims too little' at 1e-14, 3e-2 textcolor rgb '#606060'\n");
  return panel;
}

// Returns one panel as a picture for a page: the legend stands beside it, or below where there is no room.
Plot Alone(Panel panel, PictureWidth width) {
  panel.title = "";
  const bool wide = width == PictureWidth::kWide;
  const auto legend_lines = static_cast<int>(panel.curves.size());
  const int height = wide ? std::max(560, 90 + 25 * legend_lines) : 440 + 26 * legend_lines;
  absl::StrAppend(&panel.settings, "set key reverse Left samplen 2.5 spacing 1.25 maxcols 1\n");
  if (wide) {
    absl::StrAppend(&panel.settings,
                    "set key at screen 0.735, 0.97 left top\nset rmargin at screen 0.70\n"
                    "set tmargin at screen 0.97\n");
  } else {
    absl::StrAppend(&panel.settings, "set key at screen 0.02, ", Rounded(1.0 - 400.0 / height),
                    " left top\nset rmargin at screen 0.96\nset bmargin at screen ", Rounded(1.0 - 330.0 / height),
                    "\nset tmargin at screen 0.99\n");
  }
  // A telephone shows a narrow picture 372 pixels wide, and the least letters of plots must be 10 pixels high there.
  constexpr int kNarrow = 330;
  return {.title = "", .panels = {std::move(panel)}, .width = wide ? 1040 : kNarrow, .height = height};
}

// SideBySide places two panels and their legend, in fractions of the picture.
struct SideBySide {
  double left_1, right_1, left_2, right_2, top, bottom;
  std::string key;
};

const SideBySide kLegendBeside = {
    0.085,
    0.41,
    0.485,
    0.785,
    0.87,
    0.12,
    "set key at screen 0.80, 0.88 left top reverse Left samplen 2 spacing 1.25 maxcols 1\n"};
constexpr int kLeastWidthWithLegendBeside = 1300;
constexpr int kLeastWidthWithDetail = 900;

// Places the legend below, with as many columns as the picture has room for.
SideBySide LegendBelow(const Panel& panel, int width, int height) {
  const double letter = LetterHeight(width / 2.0, height);
  const double letter_width = kLetterWidth * letter;
  size_t longest = 0;
  for (const Curve& curve : panel.curves) longest = std::max(longest, curve.title.size());
  const int columns = std::max(1, static_cast<int>(width / (letter_width * (static_cast<double>(longest) + 7.0))));
  const int lines = (static_cast<int>(panel.curves.size()) + columns - 1) / columns;
  const double legend = (1.4 * lines + 0.5) * letter / height;
  const double labels = (7.0 * letter_width + 3.0 * letter) / width;
  return {labels,
          0.49,
          0.5 + labels,
          0.985,
          1.0 - 6.5 * letter / height,
          legend + 4.0 * letter / height,
          absl::StrCat("set key at screen ", Rounded(2.0 * letter_width / width), ", ", Rounded(legend),
                       " left top reverse Left samplen 2 spacing 1.15 vertical maxrows ", lines, "\n")};
}

void AppendPlace(double left, double right, const SideBySide& place, const std::string& key, Panel& panel) {
  absl::StrAppend(&panel.settings, key, "set lmargin at screen ", Rounded(left), "\nset rmargin at screen ",
                  Rounded(right), "\nset tmargin at screen ", Rounded(place.top), "\nset bmargin at screen ",
                  Rounded(place.bottom), "\n");
}

}  // namespace

Plot CostTimePlot(const CostChunk& study, PictureWidth width) { return Alone(TimePanel(study, width), width); }

Plot CostClaimPlot(const CostChunk& study, PictureWidth width) { return Alone(ClaimPanel(study, width), width); }

Plot CostPlot(const CostChunk& study, const std::string& title, int width, int height) {
  if (width == 0) std::tie(width, height) = std::pair(1480, 620);
  const bool wide = width >= kLeastWidthWithLegendBeside;
  const PictureWidth detail = width >= kLeastWidthWithDetail ? PictureWidth::kWide : PictureWidth::kNarrow;
  Panel time = TimePanel(study, detail);
  Panel claim = ClaimPanel(study, detail);
  // The legend is that of the second panel, which lacks the front and the failures: they are added as empty curves.
  for (const Curve& curve : time.curves) {
    if (curve.title == kParetoFront || curve.title == kNoAnswer) {
      claim.curves.push_back({.title = curve.title, .points = {{NAN, NAN}}, .style = curve.style});
    }
  }
  const SideBySide place = wide ? kLegendBeside : LegendBelow(claim, width, height);
  AppendPlace(place.left_1, place.right_1, place, "unset key\n", time);
  AppendPlace(place.left_2, place.right_2, place, place.key, claim);
  return {.title = title, .panels = {std::move(time), std::move(claim)}, .width = width, .height = height};
}

}  // namespace ricochet::cli
