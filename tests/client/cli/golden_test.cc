// The output of the command line matches the golden files word for word, computed in this process and by a server.
//
// RICOCHET_UPDATE_GOLDEN=1 rewrites the files.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <ostream>
#include <regex>
#include <string>

#include "tests/client/cli/cli_run.h"
#include "tests/support/paths.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::cli {
namespace {

struct Golden {
  const char* name;
  Arguments arguments;
};

void PrintTo(const Golden& golden, std::ostream* stream) { *stream << golden.name; }

std::string Scenes(const std::string& name) { return TestDataPath("scenes/" + name); }

// A fit of the made table of docs/fit.md, with further words.
Arguments FitOfRod(const Arguments& more) {
  Arguments words = {"fit",
                     "--scene",
                     Scenes("falling_rod.textproto"),
                     "--data",
                     TestDataPath("falling_rod.csv"),
                     "--unknown",
                     "mu",
                     "--unknown",
                     "newton",
                     "--sigma",
                     "linear_m_s[0]=0.01",
                     "--sigma",
                     "linear_m_s[1]=0.01",
                     "--sigma",
                     "bodies_after[0].angular_rad_s[0]=0.1"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const Golden kGolden[] = {
    {"solve_paper.txt", {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--history", "4"}},
    {"solve_inadmissible.txt", {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--newton", "1.1"}},
    {"solve_locked.txt", {"solve", "--a", "0.3", "--b", "-1", "--mu", "0.5", "--poisson", "0.5"}},
    {"solve_separating.txt", {"solve", "--a", "0.3", "--b", "1", "--omega", "1", "--mu", "0.1", "--energetic", "1"}},
    {"solve_frictionless.txt", {"solve", "--a", "0.3", "--b", "1", "--inertia", "2", "--newton", "1/2"}},
    {"solve_paper.json", {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--format", "json"}},
    {"solve_paper.csv", {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--format", "csv"}},
    {"solve_certified.txt", {"solve", "--a", "5", "--b", "1", "--mu", "1", "--newton", "0.5", "--certified", "30"}},
    {"bounds_certified.csv", {"bounds", "--a", "4", "--b", "1", "--mu", "0.5", "--certified", "30", "--format", "csv"}},
    {"solve_history.csv",
     {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--history", "2", "--format", "csv"}},
    {"solve_chain.txt", {"solve", "--scene", Scenes("double_pendulum.textproto"), "--history", "2"}},
    {"solve_pair.txt", {"solve", "--scene", Scenes("body_pair.textproto")}},
    {"solve_pair.csv", {"solve", "--scene", Scenes("body_pair.textproto"), "--format", "csv"}},
    {"solve_data.txt", {"solve", "--scene", Scenes("rod_contact.textproto"), "--data", Scenes("contacts.csv")}},
    {"solve_data.json",
     {"solve", "--scene", Scenes("rod_contact.textproto"), "--data", Scenes("contacts.csv"), "--column",
      "coefficients.newton", "--format", "json"}},
    {"solve_law.txt", {"solve", "--scene", Scenes("kane_levinson.textproto")}},
    {"sweep_chain.csv",
     {"sweep", "--scene", Scenes("double_pendulum.textproto"), "--axis", "linkage.links[1].theta_rad=lin:0.1:1:5",
      "--column", "rates_after_rad_s[1],energy_change_j", "--regime", "--format", "csv"}},
    {"bounds_paper.txt", {"bounds", "--a", "4", "--b", "1", "--mu", "0.4", "--energetic", "1"}},
    {"bounds_locked.txt", {"bounds", "--a", "1", "--b", "1", "--mu", "1"}},
    {"bounds_rod.txt", {"bounds", "--scene", Scenes("rod_contact.textproto")}},
    {"bounds_chain.txt", {"bounds", "--scene", Scenes("double_pendulum.textproto")}},
    {"bounds_space.txt", {"bounds", "--scene", Scenes("spatial_body.json")}},
    {"bounds_uncertain.txt",
     {"bounds", "--a", "4", "--b", "1", "--mu", "0.4", "--range", "friction.kinetic_coefficient=0.36:0.44", "--range",
      "pendulum.a_m=3.6:4.4"}},
    {"bounds_uncertain.json",
     {"bounds", "--scene", Scenes("rod_contact.textproto"), "--range", "friction.kinetic_coefficient=0.63:0.77",
      "--format", "json"}},
    {"bounds_uncertain.csv",
     {"bounds", "--a", "4", "--b", "1", "--mu", "0.4", "--range", "friction.kinetic_coefficient=3:5", "--format",
      "csv"}},
    {"bounds_paper.json", {"bounds", "--a", "4", "--b", "1", "--mu", "0.4", "--format", "json"}},
    {"bounds_paper.csv", {"bounds", "--a", "4", "--b", "1", "--mu", "0.4", "--format", "csv"}},
    {"audit_kane.txt",
     {"audit", "--scene", Scenes("double_pendulum.textproto"), "--observed-rate",
      "-0.6692978596871272,0.7262307284606437"}},
    {"audit_pendulum.txt", {"audit", "--a", "0.3", "--b", "1", "--mu", "0.1", "--observed-rate", "0.9"}},
    {"audit_pendulum.json",
     {"audit", "--a", "0.3", "--b", "1", "--mu", "0.1", "--observed-velocity", "0.5,0.15", "--format", "json"}},
    {"audit_space.txt",
     {"audit", "--scene", Scenes("spatial_body.json"), "--observed-velocity", "0.4,0.3,1.5", "--uncertainty", "0.01"}},
    {"audit_space.csv",
     {"audit", "--scene", Scenes("spatial_body.json"), "--observed-velocity", "0.4,0.3,1.5", "--format", "csv"}},
    {"audit_data.txt",
     {"audit", "--scene", Scenes("double_pendulum.textproto"), "--data", TestDataPath("observed.csv")}},
    {"audit_data.json",
     {"audit", "--scene", Scenes("double_pendulum.textproto"), "--data", TestDataPath("observed.csv"), "--format",
      "json"}},
    {"fit_rod.txt", FitOfRod({})},
    {"fit_rod.json", FitOfRod({"--format", "json", "--region", "mu,newton", "--starts", "3"})},
    {"fit_rod.csv", FitOfRod({"--format", "csv", "--loss", "huber"})},
    {"fit_rod_rows.csv", FitOfRod({"--format", "csv", "--rows", "--bound", "mu=0.1:0.4"})},
    {"audit_data.jsonl",
     {"audit", "--scene", Scenes("double_pendulum.textproto"), "--data", TestDataPath("observed.csv"), "--format",
      "jsonl"}},
    {"sweep_friction.txt",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis", "friction.kinetic_coefficient=lin:0:0.4:5",
      "--regime"}},
    {"sweep_long.txt",
     {"sweep", "--a", "0.3", "--b", "1", "--mu", "0.1", "--axis", "restitution.newton=lin:0:1:1000", "--column",
      "coefficients.energetic"}},
    {"sweep_friction.csv",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis", "friction.kinetic_coefficient=lin:-0.1:0.4:6",
      "--axis", "pendulum.b_m=-1,1/3", "--regime", "--column", "coefficients.newton,coefficients.tangential",
      "--format", "csv"}},
    {"sweep_zip.csv",
     {"sweep", "--a", "0.3", "--b", "1", "--zip", "--axis", "friction.kinetic_coefficient=log:1e-4:0.1:4", "--axis",
      "restitution.poisson=lin:0:1:4", "--range", "1:3", "--column", "energy_change_j", "--format", "csv"}},
    {"sweep_friction.json",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis", "friction.kinetic_coefficient=0,0.1,-1",
      "--regime", "--format", "json"}},
    {"sweep_friction.jsonl",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis", "friction.kinetic_coefficient=0,0.1,-1",
      "--regime", "--format", "jsonl"}},
    {"solve_data.jsonl",
     {"solve", "--scene", Scenes("rod_contact.textproto"), "--data", Scenes("contacts.csv"), "--column",
      "coefficients.newton", "--format", "jsonl"}},
    {"solve_law.json", {"solve", "--scene", Scenes("kane_levinson.textproto"), "--format", "json"}},
    {"solve_law.csv", {"solve", "--scene", Scenes("kane_levinson.textproto"), "--format", "csv"}},
    {"sweep_summary.txt",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis",
      "friction.kinetic_coefficient=lin:-0.1:0.4:100001", "--summary-only"}},
    {"sweep_summary.csv",
     {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis",
      "friction.kinetic_coefficient=lin:-0.1:0.4:100001", "--summary-only", "--format", "csv"}},
};

// Replaces times, which differ from run to run, and the identity of the engine, which differs from release to release.
std::string Normalised(const std::string& text) {
  std::string result = std::regex_replace(text, std::regex(R"("version":"[0-9.]+","fingerprint":"[0-9a-f]{16}")"),
                                          R"("version":"VERSION","fingerprint":"FINGERPRINT")");
  result = std::regex_replace(result, std::regex(R"("elapsed_s":[0-9.e+-]+)"), R"("elapsed_s":ELAPSED)");
  return std::regex_replace(result, std::regex(R"( in [0-9.e+-]+ s\n)"), " in ELAPSED s\n");
}

// Standard output, and what standard error has beside it.
std::string Printed(const CliResult& result) {
  return Normalised(result.out) + (result.err.empty() ? "" : "Standard error:\n" + result.err);
}

class CliGolden : public CliTest, public testing::WithParamInterface<Golden> {
 protected:
  std::string path() const { return TestDataPath("golden/" + std::string(GetParam().name)); }
};

INSTANTIATE_TEST_SUITE_P(Outputs, CliGolden, testing::ValuesIn(kGolden), [](const auto& parameter) {
  return std::regex_replace(parameter.param.name, std::regex("[^a-zA-Z0-9]"), "_");
});

TEST_P(CliGolden, IsPrintedWordForWord) {
  const CliResult result = Run(GetParam().arguments);
  EXPECT_EQ(result.exit_code, 0);
  if (std::getenv("RICOCHET_UPDATE_GOLDEN") != nullptr) std::ofstream(path()) << Printed(result);
  EXPECT_EQ(Printed(result), ReadFile(path()));
}

TEST_P(CliGolden, IsTheSameFromAServer) {
  static const ServerProcess server;
  Arguments arguments = GetParam().arguments;
  arguments.insert(arguments.end(), {"--server", server.address(), "--deadline", "30s"});
  const CliResult result = Run(arguments);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(Printed(result), ReadFile(path()));
}

}  // namespace
}  // namespace ricochet::cli
