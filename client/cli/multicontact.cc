#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/multicontact_report.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "core/scene/validate_multi.h"
#include "proto/wire/multi_contact.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: a block that falls flat on two corners.
  $ ricochet scene template box_on_two_feet -o box.textproto
  $ ricochet multicontact --scene box.textproto
  ORDER_MATTERS: body_1.x differs by 0.9 m/s between the orders 1 and 2.
  ...
--method names what to compute: orders of single impacts (at most 6 contacts), springs (in a plane), possible (bounds on
every outcome). The default is each that the scene allows. `ricochet scene list` names templates with several contacts.
CSV has one row for each outcome, each sample of --stiffness-ratio, and each end of the bounds, which alone have values
of a --function.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct MultiContactOptions {
  CommonOptions common;
  SceneOptions scene;  // A file, or a mechanism and the coefficients of its contacts.
  std::string friction, energetic;
  std::vector<std::string> methods;
  std::vector<std::string> states;
  std::vector<std::string> outputs;
  std::string stiffness_ratio;
  PictureOptions picture;
};

absl::StatusOr<MultiContactMethod> ReadMethod(const std::string& name) {
  for (const MultiContactMethod method : kMultiContactMethods) {
    if (name == NameOf(method)) return method;
  }
  return InputError("--method", name, "be orders, springs or possible");
}

absl::StatusOr<LinearOutput> ReadOutput(const std::string& text) {
  const size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return InputError("--function", text, "be NAME=NUMBER,NUMBER,...");
  RICOCHET_TRY(std::vector<double> coefficients, ParseNumbers(text.substr(equals + 1), "--function"));
  return LinearOutput{.name = text.substr(0, equals), .coefficients = std::move(coefficients)};
}

absl::StatusOr<StiffnessRange> ReadRange(const std::string& text) {
  const std::vector<std::string> halves = absl::StrSplit(text, '=');
  const std::vector<std::string> ends = absl::StrSplit(halves.back(), ':');
  StiffnessRange range;
  if (halves.size() != 2 || ends.size() != 2 || !absl::SimpleAtoi(halves[0], &range.contact)) {
    return InputError("--stiffness-ratio", text, "be CONTACT=LOW:HIGH, such as 2=0.01:100");
  }
  RICOCHET_TRY(const double low, ParseNumber(ends[0], "--stiffness-ratio"));
  RICOCHET_TRY(const double high, ParseNumber(ends[1], "--stiffness-ratio"));
  range.low = low;
  range.high = high;
  return range;
}

// Reads a mechanism, and the coefficients of its contacts.
absl::StatusOr<MultiContactScene> SceneOfMechanism(const MultiContactOptions& options) {
  if (options.friction.empty() || options.energetic.empty()) {
    return absl::InvalidArgumentError("--mechanism needs --mu and --energetic, with a number for each contact");
  }
  RICOCHET_TRY(const std::vector<double> friction, ParseNumbers(options.friction, "--mu"));
  RICOCHET_TRY(const std::vector<double> energetic, ParseNumbers(options.energetic, "--energetic"));
  if (energetic.size() != friction.size()) {
    return InputError("--energetic", options.energetic, absl::StrCat("be as many as --mu, ", friction.size()));
  }
  RICOCHET_TRY(Mechanism mechanism, ReadHeldMechanism(options.scene, static_cast<int64_t>(friction.size())));
  MultiContactScene scene = {.system = std::move(mechanism)};
  for (size_t i = 0; i < friction.size(); ++i) {
    scene.contacts.push_back({.friction = friction[i], .energetic = energetic[i]});
  }
  return scene;
}

absl::StatusOr<MultiContactScene> ReadScene(const MultiContactOptions& options) {
  const SceneOptions& files = options.scene;
  if (files.file.empty() == files.mechanism.empty()) {
    return absl::InvalidArgumentError("needs --scene FILE or --mechanism FILE.npz, and not both");
  }
  if (!files.mechanism.empty()) return SceneOfMechanism(options);
  if (!options.friction.empty() || !options.energetic.empty() || !files.kept.empty() || files.composite) {
    return absl::InvalidArgumentError(
        "--mu, --energetic, --keep and --composite need --mechanism FILE.npz; a scene states its own");
  }
  v1::MultiContactScene scene;
  if (absl::Status status = ReadMessage(files.file, scene); !status.ok()) return status;
  return FromProto(scene);
}

absl::StatusOr<MultiContactRequest> ReadRequest(const MultiContactOptions& options) {
  RICOCHET_TRY(MultiContactScene scene, ReadScene(options));
  MultiContactRequest request = {.scene = std::move(scene)};
  for (const std::string& name : options.methods) {
    RICOCHET_TRY(const MultiContactMethod method, ReadMethod(name));
    request.methods.push_back(method);
  }
  for (const std::string& text : options.states) {
    RICOCHET_TRY(std::vector<double> velocity, ParseNumbers(text, "--state"));
    request.states.push_back({.velocity = std::move(velocity)});
  }
  for (const std::string& text : options.outputs) {
    RICOCHET_TRY(LinearOutput output, ReadOutput(text));
    request.outputs.push_back(std::move(output));
  }
  if (options.stiffness_ratio.empty()) return request;
  RICOCHET_TRY(request.stiffness_range, ReadRange(options.stiffness_ratio));
  return request;
}

// Errors: INVALID_ARGUMENT for an option whose method is not among those asked for.
absl::Status CheckMethods(const MultiContactOptions& options) {
  const std::vector<std::string>& methods = options.methods;
  const auto lacks = [&methods](const char* method) {
    return !methods.empty() && std::find(methods.begin(), methods.end(), method) == methods.end();
  };
  if (!options.outputs.empty() && lacks("possible")) {
    return absl::InvalidArgumentError("--function needs --method possible, which gives its bounds");
  }
  if (!options.stiffness_ratio.empty() && lacks("springs")) {
    return absl::InvalidArgumentError("--stiffness-ratio needs --method springs");
  }
  return absl::OkStatus();
}

absl::Status RunMultiContact(const MultiContactOptions& options) {
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  if (absl::Status status = CheckMethods(options); !status.ok()) return status;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const MultiContactRequest request, ReadRequest(options));
  RICOCHET_TRY(const MultiContactResponse response, solver->MultiContact(request));
  absl::Status written = WriteAnswer(
      options.common, response, [&] { return MultiContactText(request, response); },
      [&] { return MultiContactCsv(request, response); });
  if (!written.ok() || options.picture.file.empty()) return written;
  return DrawPicture(MultiContactPlot(request, response), options.picture);
}

}  // namespace

void AddMultiContact(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<MultiContactOptions>(
      app, "multicontact", "What several contacts at once can do, and whether order matters", kExample, RunMultiContact,
      command);
  MarkFile(FileUse::kRead,
           sub->add_option("--scene", options->scene.file,
                           "A ricochet.v1.MultiContactScene as JSON or textproto; - for standard input"))
      ->type_name("FILE")
      ->group("Scene");
  AddMechanismOptions(*sub, options->scene);
  sub->add_option("--mu", options->friction, "Friction of each contact of the mechanism")->type_name("MU,...");
  sub->add_option("--energetic", options->energetic, "Energetic coefficient of each contact of the mechanism")
      ->type_name("E,...");
  AddList(*sub, "--method", options->methods, "What to compute: orders, springs, possible [all that the scene allows]")
      ->type_name("NAME,...");
  AddRepeatable(*sub, "--state", options->states,
                "A velocity before in place of the scene's, body by body or contact by contact; repeatable")
      ->type_name("V,V,...");
  AddRepeatable(*sub, "--function", options->outputs,
                "A linear function of the velocities that gets bounds too; repeatable")
      ->type_name("NAME=C,C,...");
  sub->add_option("--stiffness-ratio", options->stiffness_ratio,
                  "Springs while the relative stiffness of a contact runs from LOW to HIGH")
      ->type_name("CONTACT=LOW:HIGH");
  AddPictureOptions(*sub, "the strike, the outcomes within what is possible, and the outcomes over the stiffness,",
                    options->picture);
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kMessageFormats);
}

}  // namespace ricochet::cli
