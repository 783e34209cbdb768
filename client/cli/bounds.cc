#include <CLI/App.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/input/axis_input.h"
#include "client/cli/input/certificate_report.h"
#include "client/cli/input/derivative_input.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/io/output_format.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/bounds_plot.h"
#include "client/cli/report/derivatives_report.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/counted.h"
#include "core/base/try.h"
#include "core/scene/field.h"
#include "proto/wire/requests.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: the coefficients that friction allows a pendulum, whatever its material.
  $ ricochet bounds --a 0.3 --b 1 --mu 0.1
  Rebound: x = mu |b|/a = 0.333333, r = (1 - x)/(1 + x) = 0.5.

               sharp (spring)   energy only   first order in x   error <=
  Newton      0 ... 0.707107       0 ... 1     0 ... 0.666667 ...
  Poisson      0 ... 1.41421       0 ... 2      0 ... 1.33333 ...
  ...
"sharp": the contact returns no more energy than it stored. "energy only": the kinetic energy does not grow.
--range, which may be repeated, also gives guaranteed ranges over all scenes whose fields lie in the given ranges.
CSV has one row for each quantity, at full precision, with --certified one for each proved number, and with
--derivatives one for each derivative. It is one table, so that these two exclude each other and --range.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct BoundsOptions {
  CommonOptions common;
  SceneOptions scene;
  std::vector<std::string> ranges;
  std::string certified;
  DerivativeOptions derivatives;
  PictureOptions picture;
};

// One quantity: its names, and the fields that hold its range, its first-order error and its coefficient.
struct Quantity {
  const char* name;
  const char* title;
  Range CoefficientBounds::*range;
  double NearlyVertical::*error;               // Null if the first order is exact.
  double (*coefficient)(const Coefficients&);  // Null for a quantity that is not a coefficient.
};

constexpr std::array kQuantities = {
    Quantity{"newton", "Newton", &CoefficientBounds::newton, &NearlyVertical::newton_error,
             [](const Coefficients& c) { return c.newton; }},
    Quantity{"poisson", "Poisson", &CoefficientBounds::poisson, &NearlyVertical::poisson_error,
             [](const Coefficients& c) { return c.poisson.value_or(0.0); }},
    Quantity{"energetic", "energetic", &CoefficientBounds::energetic, nullptr,
             [](const Coefficients& c) { return c.energetic.value_or(0.0); }},
    Quantity{"tangential", "tangential (Brach)", &CoefficientBounds::tangential, &NearlyVertical::tangential_error,
             [](const Coefficients& c) { return c.tangential; }},
    Quantity{"normal_total_n_s", "normal impulse [N s]", &CoefficientBounds::normal_total_n_s,
             &NearlyVertical::normal_total_error_n_s, nullptr},
};

std::string Interval(const Range& range) { return absl::StrCat(Rounded(range.lower), " ... ", Rounded(range.upper)); }

// Returns true for the bounds of a pendulum over a surface at rest: for other systems both ratios are 0.
bool HasRatios(const Bounds& bounds) { return bounds.friction_ratio != 0.0 || bounds.slope_ratio != 0.0; }

std::string Heading(const Bounds& bounds) {
  std::string regime = RegimeText(bounds.regime);
  if (!HasRatios(bounds)) return absl::StrCat("Regime of the elastic impact: ", regime, ".\n");
  regime[0] = static_cast<char>(regime[0] - 'a' + 'A');
  return absl::StrCat(regime, ": x = mu |b|/a = ", Rounded(bounds.friction_ratio),
                      ", r = (1 - x)/(1 + x) = ", Rounded(bounds.slope_ratio), ".\n");
}

std::string RangesText(const Bounds& bounds) {
  Table table;
  std::vector<std::string> header = {"", bounds.sampled ? "found by a sample" : "sharp (spring)"};
  if (bounds.energy_only.has_value()) header.emplace_back("energy only");
  if (bounds.nearly_vertical.has_value()) {
    header.insert(header.end(), {"first order in x", "error <="});
  }
  table.Add(header);
  for (const Quantity& quantity : kQuantities) {
    std::vector<std::string> row = {quantity.title, Interval(bounds.sharp.*quantity.range)};
    if (bounds.energy_only.has_value()) row.push_back(Interval((*bounds.energy_only).*quantity.range));
    if (bounds.nearly_vertical.has_value()) {
      row.push_back(Interval(bounds.nearly_vertical->bounds.*quantity.range));
      row.push_back(quantity.error == nullptr ? "0" : Rounded((*bounds.nearly_vertical).*quantity.error));
    }
    table.Add(row);
  }
  return table.Render(0);
}

// Returns an empty text if no coefficient of friction is critical.
std::string CriticalText(const CriticalFriction& critical) {
  const std::pair<const char*, std::optional<double>> rows[] = {
      {"a stopped contact sticks from", critical.stick},
      {"slip stops before compression ends above", critical.stop_compression},
      {"slip stops before an elastic impact ends above", critical.stop},
      {"slip reverses, until the contact sticks, from", critical.reversal},
      {"the contact jams above", critical.jam},
  };
  Table table;
  for (const auto& [title, value] : rows) {
    if (value.has_value()) table.Add({title, Rounded(*value)});
  }
  const std::string text = table.Render(2);
  return text.empty() ? "" : absl::StrCat("\nCritical coefficients of friction\n", text);
}

std::string FirstOrderText(const NearlyVertical& vertical) {
  Table table;
  table.Add({"", "first order in x", "error <="});
  for (const Quantity& quantity : kQuantities) {
    if (quantity.coefficient == nullptr) continue;
    table.Add({quantity.title, Rounded(quantity.coefficient(*vertical.coefficients)),
               Rounded(quantity.coefficient(vertical.coefficient_errors))});
  }
  return absl::StrCat("\nAt the scene's restitution\n", table.Render(2));
}

std::string EnclosureText(const Enclosure& enclosure, const std::vector<FieldRange>& ranges) {
  std::string text = "\nOver all scenes with\n";
  for (const FieldRange& range : ranges) {
    absl::StrAppend(&text, "  ", range.path, " in ", Interval({range.low, range.high}), "\n");
  }
  Table table;
  table.Add({"", "guaranteed range", "range found"});
  for (const Quantity& quantity : kQuantities) {
    table.Add(
        {quantity.title, Interval(enclosure.outer.*quantity.range), Interval(enclosure.attained.*quantity.range)});
  }
  const std::string excess =
      std::isinf(enclosure.excess)
          ? "A guaranteed range is infinite: friction may lock the contact, or W may be nearly singular"
          : absl::StrCat("Guaranteed ranges are at most ", Rounded(100.0 * enclosure.excess),
                         " % wider than those found");
  return absl::StrCat(text, "\n", table.Render(0), excess, " (", Counted(enclosure.boxes, "sub-range"),
                      " examined).\n");
}

std::string BoundsText(const BoundsRequest& request, const BoundsResponse& response) {
  const Bounds& bounds = response.bounds;
  std::string text = absl::StrCat(Heading(bounds), "\n", RangesText(bounds), CriticalText(bounds.critical));
  if (bounds.nearly_vertical.has_value() && bounds.nearly_vertical->coefficients.has_value()) {
    absl::StrAppend(&text, FirstOrderText(*bounds.nearly_vertical));
  }
  if (response.enclosure.has_value()) absl::StrAppend(&text, EnclosureText(*response.enclosure, request.ranges));
  if (response.certificate.has_value()) text += CertificateText(*response.certificate);
  if (!response.derivatives.empty()) text += DerivativesText(response.derivatives);
  return text;
}

// Adds the range of a quantity within bounds that may be unset.
void AddRange(const std::string& name, const Quantity& quantity, const std::optional<CoefficientBounds>& bounds,
              CsvRow& row) {
  const std::optional<Range> range = bounds.has_value() ? std::optional((*bounds).*quantity.range) : std::nullopt;
  row.Number(name + ".lower", range.has_value() ? std::optional(range->lower) : std::nullopt);
  row.Number(name + ".upper", range.has_value() ? std::optional(range->upper) : std::nullopt);
}

std::string BoundsCsv(const BoundsResponse& response) {
  if (response.certificate.has_value()) return CertificateCsv(*response.certificate);
  if (!response.derivatives.empty()) return DerivativesCsv(response.derivatives);
  const Bounds& bounds = response.bounds;
  std::optional<CoefficientBounds> vertical, outer, attained;
  if (bounds.nearly_vertical.has_value()) vertical = bounds.nearly_vertical->bounds;
  if (response.enclosure.has_value()) outer = response.enclosure->outer;
  if (response.enclosure.has_value()) attained = response.enclosure->attained;
  std::vector<CsvRow> rows;
  for (const Quantity& quantity : kQuantities) {
    CsvRow& row = rows.emplace_back();
    row.Words("quantity", quantity.name);
    row.Words("regime", RegimeName(bounds.regime));
    row.Number("friction_ratio", bounds.friction_ratio);
    row.Number("slope_ratio", bounds.slope_ratio);
    AddRange(bounds.sampled ? "sampled" : "sharp", quantity, bounds.sharp, row);
    AddRange("energy_only", quantity, bounds.energy_only, row);
    AddRange("nearly_vertical", quantity, vertical, row);
    std::optional<double> error;
    if (vertical.has_value()) error = quantity.error == nullptr ? 0.0 : (*bounds.nearly_vertical).*quantity.error;
    row.Number("nearly_vertical.error", error);
    AddRange("enclosure.outer", quantity, outer, row);
    AddRange("enclosure.attained", quantity, attained, row);
  }
  return CsvOf(rows);
}

absl::StatusOr<BoundsRequest> ReadRequest(const BoundsOptions& options) {
  RICOCHET_TRY(const Scene scene, ReadScene(options.scene));
  RICOCHET_TRY(const int32_t digits, ReadCertifiedDigits(options.certified));
  BoundsRequest request{.scene = scene, .ranges = {}, .certified_digits = digits};
  for (const std::string& text : options.ranges) {
    RICOCHET_TRY(FieldRange range, ParseFieldRange(text, request.scene));
    request.ranges.push_back(std::move(range));
  }
  RICOCHET_TRY(request.derivatives, ReadDerivatives(options.derivatives, scene, BoundsNumbers(scene.system)));
  return request;
}

absl::Status RunBounds(const BoundsOptions& options) {
  if (AsksForNames(options.ranges)) return ListNames(options.common, options.scene, FieldPaths);
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  absl::Status table = CheckOneTable(options.common.format, {{"--range", !options.ranges.empty()},
                                                             {"--certified", !options.certified.empty()},
                                                             {"--derivatives", options.derivatives.any()}});
  if (!table.ok()) return table;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const BoundsRequest request, ReadRequest(options));
  RICOCHET_TRY(const BoundsResponse response, solver->Bounds(request));
  if (absl::Status still = RequireVelocity(request.scene); !still.ok()) return still;
  absl::Status written = WriteAnswer(
      options.common, response, [&] { return BoundsText(request, response); }, [&] { return BoundsCsv(response); });
  if (!written.ok() || options.picture.file.empty()) return written;
  return DrawPicture(BoundsPlot(response), options.picture);
}

}  // namespace

void AddBounds(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<BoundsOptions>(
      app, "bounds", "The values that the coefficients of an impact can take", kExample, RunBounds, command);
  AddSceneOptions(*sub, options->scene);
  AddRepeatable(*sub, "--range", options->ranges,
                "An uncertain field of a planar system, of friction or of the surface; may be repeated")
      ->type_name("PATH=LOW:HIGH");
  AddCertifiedOption(*sub, options->certified);
  AddDerivativeOptions(*sub, "ends of ranges and critical coefficients of friction", options->derivatives);
  AddPictureOptions(*sub, "the ranges as bars", options->picture);
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kMessageFormats);
}

}  // namespace ricochet::cli
