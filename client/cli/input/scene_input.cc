#include "client/cli/input/scene_input.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/command_options.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/mechanism_file.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "proto/text/message_text.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/scene.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr SceneFlag kSceneFlags[] = {
    {"--a", &SceneOptions::a, "pendulum.a_m", "Horizontal distance from the pin to the contact, m"},
    {"--b", &SceneOptions::b, "pendulum.b_m", "Depth of the contact below the pin, m [0]"},
    {"--inertia", &SceneOptions::inertia, "pendulum.inertia_kg_m2", "Moment of inertia about the pin, kg m² [1]"},
    {"--omega", &SceneOptions::omega, "pendulum.omega_minus_rad_s",
     "Angular velocity before, rad/s; < 0 approaches [-1]"},
    {"--mu", &SceneOptions::mu, "friction.kinetic_coefficient", "Coefficient of kinetic friction [0]"},
    {"--mu-static", &SceneOptions::mu_static, "friction.static_coefficient",
     "Coefficient of static friction [the value of --mu]"},
    {"--newton", &SceneOptions::newton, "restitution.newton", "Coefficient of restitution by Newton: -v+/v-"},
    {"--poisson", &SceneOptions::poisson, "restitution.poisson",
     "Coefficient of restitution by Poisson: ratio of normal impulses"},
    {"--energetic", &SceneOptions::energetic, "restitution.energetic",
     "Coefficient of restitution by Stronge: root of the ratio of normal works"},
};

constexpr double kDefaultInertia = 1.0;
constexpr double kDefaultOmega = -1.0;

// Sets the numbers of the scene that flags state. All flags that are no numbers are reported at once.
absl::Status SetByFlags(const SceneOptions& options, Scene& scene) {
  std::vector<Violation> violations;
  for (const SceneFlag& flag : kSceneFlags) {
    const std::optional<std::string>& text = options.*flag.value;
    if (!text.has_value()) continue;
    const absl::StatusOr<double> number = ParseNumber(*text, flag.name);
    if (!number.ok()) {
      for (Violation& violation : ViolationsOf(number.status())) violations.push_back(std::move(violation));
      continue;
    }
    RICOCHET_TRY(const Field field, ResolveField(flag.field, scene));
    field.Set(*number);  // The solver says which rule of the scene it breaks.
  }
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

absl::StatusOr<Scene> PendulumFromFlags(const SceneOptions& options) {
  Scene scene = {.system = Pendulum{.inertia_kg_m2 = kDefaultInertia, .omega_minus_rad_s = kDefaultOmega}};
  if (absl::Status status = SetByFlags(options, scene); !status.ok()) return status;
  return scene;
}

absl::StatusOr<Scene> MechanismFromFlags(const SceneOptions& options) {
  RICOCHET_TRY(Mechanism mechanism, ReadHeldMechanism(options, 1));
  Scene scene = {.system = std::move(mechanism)};
  if (absl::Status status = SetByFlags(options, scene); !status.ok()) return status;
  return scene;
}

// True if a flag is given that describes the pendulum itself.
bool AnyPendulumFlag(const SceneOptions& options) {
  return options.a.has_value() || options.b.has_value() || options.inertia.has_value() || options.omega.has_value();
}

bool AnyFlag(const SceneOptions& options) {
  return std::any_of(std::begin(kSceneFlags), std::end(kSceneFlags),
                     [&](const SceneFlag& flag) { return (options.*flag.value).has_value(); });
}

absl::Status CannotRead(const std::string& path, int error) {
  return absl::InvalidArgumentError(absl::StrCat("cannot read ", path, ": ", std::strerror(error)));
}

absl::Status AsStatus(const std::string& name, const std::string& wrong) {
  return wrong.empty() ? absl::OkStatus() : absl::InvalidArgumentError(absl::StrCat(name, " ", wrong));
}

std::string NameOf(const std::string& path) { return path == "-" ? "standard input" : path; }

}  // namespace

absl::StatusOr<Mechanism> ReadHeldMechanism(const SceneOptions& options, int64_t contacts) {
  absl::StatusOr<Mechanism> mechanism = ReadMechanism(options.mechanism, contacts);
  if (!mechanism.ok()) return mechanism.status();
  const auto coordinates = static_cast<int64_t>(mechanism->rates.size());
  for (const std::string& kept : options.kept) {
    RICOCHET_TRY(const int64_t coordinate, ParseCount(kept, "--keep"));
    if (coordinate < 0 || coordinate >= coordinates) {
      return InputError("--keep", kept, absl::StrCat("be in [0, ", coordinates, ")"));
    }
    mechanism->kept_coordinates.push_back(static_cast<int32_t>(coordinate));
  }
  mechanism->composite = options.composite;
  return mechanism;
}

absl::Span<const SceneFlag> SceneFlags() { return kSceneFlags; }

bool SceneOptions::any() const { return !file.empty() || !mechanism.empty() || AnyFlag(*this); }

void AddSceneOptions(CLI::App& app, SceneOptions& options) {
  MarkFile(FileUse::kRead,
           app.add_option("--scene", options.file, "A ricochet.v1.Scene as JSON or textproto; - for standard input"))
      ->type_name("FILE")
      ->group("Scene");
  for (const SceneFlag& flag : kSceneFlags) {
    app.add_option(flag.name, options.*flag.value, flag.help)->type_name("X")->group("Scene");
  }
  app.get_option("--newton")->excludes(app.get_option("--poisson"))->excludes(app.get_option("--energetic"));
  app.get_option("--poisson")->excludes(app.get_option("--energetic"));
}

void AddAnySceneOptions(CLI::App& app, SceneOptions& options) {
  AddSceneOptions(app, options);
  app.get_option("--scene")->description(
      "A ricochet.v1.Scene, or a MultiContactScene, as JSON or textproto; - for standard input");
}

void AddMechanismOptions(CLI::App& app, SceneOptions& options) {
  MarkFile(FileUse::kRead,
           app.add_option("--mechanism", options.mechanism,
                          "A mechanism as numpy.savez writes it: arrays M (n x n), J with rows t, n or t1, t2, n for "
                          "each contact, and qdot (n)"))
      ->type_name("FILE.npz")
      ->group("Scene");
  AddList(app, "--keep", options.kept, "Coordinates of the mechanism that a brake or a controller holds")
      ->type_name("I,...")
      ->group("Scene");
  app.add_flag("--composite", options.composite, "All joints of the mechanism hold: it moves as one rigid body")
      ->group("Scene");
}

absl::Status RequireVelocity(const Scene& scene) {
  bool is_moving = false;
  std::vector<std::string> velocities;
  VisitNumbers(scene, [&](const NumberPath& path, double value, NumberRule /*rule*/) {
    const bool is_velocity =
        absl::EndsWith(path.name, "rad_s") || std::strcmp(path.name, "rates") == 0 || absl::EndsWith(path.name, "_m_s");
    if (!is_velocity || absl::StartsWith(path.name, "speed")) return;
    velocities.push_back(path.Text());
    is_moving = is_moving || value != 0.0;
  });
  if (is_moving || velocities.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("nothing strikes, because all velocities of the scene are 0: must have another value in ",
                   velocities.size() == 1 ? "" : "one of ", absl::StrJoin(velocities, ", ")));
}

// Says what is wrong with the combination of the options.
static absl::Status CheckSources(const SceneOptions& options) {
  if (!options.mechanism.empty()) {
    if (options.file.empty() && !AnyPendulumFlag(options)) return absl::OkStatus();
    return absl::InvalidArgumentError(
        "--mechanism cannot be combined with --scene or the flags of a pendulum: it takes --mu, --mu-static and a "
        "coefficient of restitution");
  }
  if (!options.kept.empty() || options.composite) {
    return absl::InvalidArgumentError("--keep and --composite need --mechanism FILE.npz; a scene states its own");
  }
  if (options.file.empty() && !AnyFlag(options)) {
    return absl::InvalidArgumentError("no scene: give --scene FILE, or a pendulum by --a, --b, --mu, --energetic ...");
  }
  if (!options.file.empty() && AnyFlag(options)) {
    return absl::InvalidArgumentError(
        "--scene cannot be combined with the flags of a pendulum: put the values into the file, or omit --scene");
  }
  return absl::OkStatus();
}

absl::StatusOr<Scene> ReadScene(const SceneOptions& options) {
  if (absl::Status status = CheckSources(options); !status.ok()) return status;
  if (!options.mechanism.empty()) return MechanismFromFlags(options);
  if (options.file.empty()) return PendulumFromFlags(options);
  v1::Scene proto;
  if (absl::Status status = ReadMessage(options.file, proto); !status.ok()) return status;
  return FromProto(proto);
}

absl::Status ReadAnyScene(const SceneOptions& options, std::variant<Scene, MultiContactScene>& scene) {
  if (options.file.empty()) {
    RICOCHET_TRY(scene, ReadScene(options));
    return absl::OkStatus();
  }
  if (absl::Status status = CheckSources(options); !status.ok()) return status;
  RICOCHET_TRY(const std::string text, ReadText(options.file));
  AnyScene proto;
  const std::string wrong = WhyNoScene(options.file, text, proto);
  if (wrong.empty()) std::visit([&scene](const auto& its_scene) { scene = FromProto(its_scene); }, proto);
  return AsStatus(NameOf(options.file), wrong);
}

static absl::StatusOr<std::string> ReadBytes(const std::string& path) {
  std::FILE* const file = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
  if (file == nullptr) return CannotRead(path, errno);
  std::string text;
  std::array<char, 65536> part = {};
  while (const size_t count = std::fread(part.data(), 1, part.size(), file)) text.append(part.data(), count);
  const int error = std::ferror(file) != 0 ? errno : 0;
  if (file != stdin) (void)std::fclose(file);
  if (error != 0) return CannotRead(NameOf(path), error);
  return text;
}

absl::Status CheckWholeRead(const std::istream& stream, const std::string& path) {
  const bool is_whole = &stream == &std::cin ? std::ferror(stdin) == 0 : !stream.bad();
  return is_whole ? absl::OkStatus() : CannotRead(NameOf(path), EIO);
}

absl::StatusOr<std::ifstream> OpenToRead(const std::string& path) {
  std::error_code unknown;  // A file that cannot be looked at cannot be opened either.
  if (std::filesystem::is_directory(path, unknown)) return CannotRead(path, EISDIR);
  std::ifstream file(path, std::ios::binary);
  if (!file) return CannotRead(path, errno);
  return file;
}

absl::StatusOr<std::string> ReadText(const std::string& path) {
  absl::StatusOr<std::string> text = ReadBytes(path);
  if (!text.ok()) return text;
  if (absl::Status status = RefuseUtf16(*text, NameOf(path)); !status.ok()) return status;
  if (absl::StartsWith(*text, kByteOrderMark)) text->erase(0, sizeof(kByteOrderMark) - 1);
  return text;
}

absl::Status ReadMessage(const std::string& path, google::protobuf::Message& message) {
  RICOCHET_TRY(const std::string text, ReadText(path));
  // A file may be empty on purpose; a pipe is so if the program before it failed.
  if (path == "-" && text.empty()) return absl::InvalidArgumentError("standard input is empty");
  return ParseMessage(path, text, message);
}

absl::Status ParseMessage(const std::string& path, const std::string& text, google::protobuf::Message& message) {
  return AsStatus(NameOf(path), WhyNoMessage(path, text, message));
}

absl::Status ParseJson(const std::string& name, const std::string& text, google::protobuf::Message& message) {
  return AsStatus(name, WhyNoJson(text, message));
}

}  // namespace ricochet::cli
