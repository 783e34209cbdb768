#include "client/cli/plot/picture_input.h"

#include <CLI/App.hpp>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/input/file_option.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "core/base/utf8.h"

namespace ricochet::cli {
namespace {

// Below this nothing can be read, above it a program that shows pictures fails.
constexpr int64_t kLeastSide = 200;
constexpr int64_t kMostSide = 10'000;

// Returns the options that say how a picture looks, of those that were given.
std::vector<const char*> GivenLooks(const PictureOptions& options) {
  std::vector<const char*> given;
  if (!options.title.empty()) given.push_back("--title");
  if (!options.size.empty()) given.push_back("--size");
  if (options.log_x) given.push_back("--logx");
  if (options.log_y) given.push_back("--logy");
  if (options.kind != PlotKind::kAuto) given.push_back("--kind");
  return given;
}

}  // namespace

void AddPictureOptions(CLI::App& app, const std::string& what, PictureOptions& options) {
  MarkFile(FileUse::kWritten, app.add_option("--plot", options.file, absl::StrCat("Draw ", what, " with gnuplot")),
           PictureFormats())
      ->type_name("FILE.svg|.png|.pdf")
      ->group("Picture");
  AddLookOptions(app, options);
}

void AddLookOptions(CLI::App& app, PictureOptions& options) {
  app.add_option("--title", options.title, "Title of the picture, instead of one that says what it shows")
      ->type_name("TEXT")
      ->group("Picture");
  app.add_option("--size", options.size, "Width and height of the picture in pixels, such as 960x620")
      ->type_name("WxH")
      ->group("Picture");
}

void AddAxisOptions(CLI::App& app, PictureOptions& options) {
  app.add_flag("--logx", options.log_x, "Logarithmic axis to the right")->group("Picture");
  app.add_flag("--logy", options.log_y, "Logarithmic axis upwards")->group("Picture");
}

void AddKindOption(CLI::App& app, PictureOptions& options) {
  app.add_option_function<std::string>(
         "--kind",
         [&options](const std::string& name) { options.kind = name == "map" ? PlotKind::kMap : PlotKind::kCurves; },
         "Curves over the last axis, or a map of two axes in colours [a map if both axes have more than 12 values]")
      ->check(CLI::IsMember({"curves", "map"}))
      ->option_text("curves|map")
      ->group("Picture");
}

absl::StatusOr<PictureSize> SizeOf(const PictureOptions& options) {
  const std::string& text = options.size;
  if (text.empty()) return PictureSize{};
  const std::vector<std::string> parts = absl::StrSplit(text, 'x');
  const absl::Status wrong =
      InputError("--size", text, absl::StrCat("be WIDTHxHEIGHT in pixels, each from ", kLeastSide, " to ", kMostSide));
  if (parts.size() != 2) return wrong;
  std::vector<int> sides;
  for (const std::string& part : parts) {
    const absl::StatusOr<int64_t> side = ParseCount(part, "--size");
    if (!side.ok() || *side < kLeastSide || *side > kMostSide) return wrong;
    sides.push_back(static_cast<int>(*side));
  }
  return PictureSize{sides[0], sides[1]};
}

absl::Status CheckPicture(const PictureOptions& options) {
  if (options.file.empty()) {
    const std::vector<const char*> given = GivenLooks(options);
    if (given.empty()) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat(absl::StrJoin(given, " and "), given.size() == 1 ? " needs" : " need", " --plot FILE"));
  }
  if (Printable(options.title) != options.title) {
    return InputError("--title", Printable(options.title), "be UTF-8 without control characters");
  }
  return SizeOf(options).status();
}

absl::Status DrawWith(absl::StatusOr<Plot> plot, const PictureOptions& options) {
  if (!plot.ok()) return plot.status();
  RICOCHET_TRY(const PictureSize size, SizeOf(options));
  if (!options.title.empty()) plot->title = options.title;
  if (size.width > 0) std::tie(plot->width, plot->height) = std::pair(size.width, size.height);
  for (Panel& panel : plot->panels) {
    panel.log_x = panel.log_x || (options.log_x && panel.y_ticks.empty());
    panel.log_y = panel.log_y || (options.log_y && panel.y_ticks.empty());
  }
  return Draw(*plot, options.file);
}

absl::Status DrawPicture(absl::StatusOr<Plot> plot, const PictureOptions& options) {
  absl::Status drawn = DrawWith(std::move(plot), options);
  if (drawn.ok()) return drawn;
  return {drawn.code(),
          absl::StrCat("the numbers are complete, but ", options.file, " was not drawn: ", drawn.message())};
}

}  // namespace ricochet::cli
