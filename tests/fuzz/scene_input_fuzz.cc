// Fuzzes the reading of a scene by the command line. The first byte says whether the others are JSON, textproto, either
// of them, or the flags of a pendulum, one on each line.
//
// It checks that reading gives OK, or INVALID_ARGUMENT with a message; that a scene is the same after it was written in
// either format and read again; and that Validate and Solve accept any scene without a crash.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/text/number_input.h"
#include "core/scene/validate.h"
#include "proto/wire/scene.h"
#include "tests/fuzz/fail.h"

namespace ricochet::cli {
namespace {

void CheckStatus(const absl::Status& status) {
  if (status.ok()) return;
  if (status.code() != absl::StatusCode::kInvalidArgument || status.message().empty()) Fail(status.ToString());
}

// Writes numbers as their shortest decimals, and all NaN alike.
std::string Printed(const v1::Scene& scene) {
  std::string text;
  google::protobuf::TextFormat::PrintToString(scene, &text);
  return text;
}

v1::Scene ReadAgain(const std::string& path, const std::string& text) {
  v1::Scene scene;
  const absl::Status status = ParseMessage(path, text, scene);
  if (!status.ok()) Fail(status.ToString());
  return scene;
}

// Protobuf reads JSON's -0 as the integer 0, which is the same number with another sign.
void CheckJson(const v1::Scene& scene) {
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(scene, &json).ok()) Fail("a scene has no JSON");
  const bool has_nan = absl::StrContains(json, "NaN");
  if (!has_nan && FromProto(ReadAgain("scene.json", json)) != FromProto(scene)) Fail("JSON changes a scene");
}

void CheckText(const std::string& path, const std::string& text) {
  v1::Scene scene;
  const absl::Status status = ParseMessage(path, text, scene);
  CheckStatus(status);
  if (!status.ok()) return;
  static_cast<void>(Validate(FromProto(scene)));
  if (Printed(ReadAgain("scene.textproto", Printed(scene))) != Printed(scene)) Fail("textproto changes a scene");
  CheckJson(scene);
}

void CheckFlags(const std::string& text) {
  static constexpr const char* kFlags[] = {"--a",         "--b",      "--inertia", "--omega",     "--mu",
                                           "--mu-static", "--newton", "--poisson", "--energetic", "--scene"};
  CLI::App app;
  SceneOptions options;
  AddSceneOptions(app, options);
  std::vector<std::string> arguments;
  size_t i = 0;
  for (const absl::string_view line : absl::StrSplit(text, '\n')) {
    if (i == std::size(kFlags)) break;
    if (!line.empty()) arguments.push_back(absl::StrCat(kFlags[i], "=", line));
    ++i;
  }
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError&) {
    return;
  }
  // This is a folder, so that no file is read.
  if (!options.file.empty()) options.file = ".";
  const absl::StatusOr<Scene> scene = ReadScene(options);
  CheckStatus(scene.status());
  if (scene.ok()) static_cast<void>(Validate(*scene));
  CheckStatus(ParseCount(text, "--points").status());
  CheckStatus(ParseDuration(text, "--deadline").status());
}

}  // namespace
}  // namespace ricochet::cli

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      ricochet::cli::CheckText("scene.json", text);
      break;
    case 1:
      ricochet::cli::CheckText("scene.textproto", text);
      break;
    case 2:
      ricochet::cli::CheckText("-", text);
      break;
    default:
      ricochet::cli::CheckFlags(text);
  }
  return 0;
}
