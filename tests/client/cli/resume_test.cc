// Sweeps into a file that something ends: what is left, and that --resume makes the file of an undisturbed run of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/cli/sweep/sweep_output.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Waits until the manifest counts points, at most a minute.
constexpr char kUntilPoints[] =
    "for i in $(seq 12000); do grep -qs '\"next_index\": \"[1-9]' result.part.json && break; sleep 0.005; done\n";

std::string Sweep(const std::string& format, const std::string& more, const std::string& points = "1500000") {
  return "\"$R\" sweep --a 0.3 --b 1 --energetic 1 --axis friction.kinetic_coefficient=lin:-0.1:0.4:" + points +
         " --column coefficients.newton --regime --format " + format + " " + more;
}

// Each format that can be gone on with.
class CliResume : public CliTest, public testing::WithParamInterface<const char*> {
 protected:
  // One thread of its own leaves the time to end it.
  std::string Started(const std::string& more = "") const {
    const bool is_remote = more.find("--server") != std::string::npos;
    return Sweep(GetParam(), "-o result " + more + (is_remote ? "" : " --threads 1"));
  }
  std::string Undisturbed() const { return RunShell(Sweep(GetParam(), "")).out; }
  // Comparing strings would print megabytes.
  void ExpectUndisturbed() const { EXPECT_TRUE(Read("result") == Undisturbed()); }
  // Leaves a partial file of a run that was killed.
  void Kill() const {
    RunShell(Started() + " & pid=$!\n" + kUntilPoints + "kill -9 $pid; wait");
    ASSERT_THAT(Files(), ElementsAre("result.part", "result.part.json"));
  }
};

INSTANTIATE_TEST_SUITE_P(Formats, CliResume, testing::Values("csv", "json", "jsonl", "npy"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_P(CliResume, AfterKillMinusNineGivesTheFileOfAnUndisturbedRun) {
  Kill();
  const CliResult result = RunShell(Started("--resume"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // The friction is negative in the first fifth of the sweep, some of which the killed run has computed.
  EXPECT_THAT(result.err, HasSubstr("300000 points are invalid:\n"));
  ExpectUndisturbed();
  EXPECT_THAT(Files(), ElementsAre("result"));
}

TEST_P(CliResume, ATornEndIsCutOff) {
  Kill();
  EXPECT_EQ(RunShell("printf '12,0.3,' >> result.part\n" + Started("--resume")).exit_code, 0);
  ExpectUndisturbed();
}

TEST_P(CliResume, CtrlCShowsTheCommandThatGoesOn) {
  // The shell would let a program in the background ignore the signal.
  const CliResult stopped =
      RunShell("env --default-signal=INT " + Started() + " & pid=$!\n" + kUntilPoints + "kill -INT $pid; wait $pid");
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_THAT(stopped.err, HasSubstr("ricochet: interrupted"));
  const size_t command = stopped.err.find("\n  ");
  ASSERT_NE(command, std::string::npos) << stopped.err;
  const CliResult result = RunShell(stopped.err.substr(command, stopped.err.find('\n', command + 1) - command));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ExpectUndisturbed();
}

TEST_P(CliResume, AfterTheServerDiesAnotherOneGoesOn) {
  ServerProcess dying;
  const CliResult result = RunShell(Started("--server " + dying.address()) + " & pid=$!\n" + kUntilPoints + "kill -9 " +
                                    std::to_string(dying.pid()) + "; wait $pid");
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_THAT(result.err, HasSubstr("--resume"));
  const ServerProcess other;
  EXPECT_EQ(RunShell(Started("--resume --server " + other.address())).exit_code, 0);
  ExpectUndisturbed();
}

TEST_P(CliResume, ADeadServerOfAListIsNotNoticed) {
  const ServerProcess other;
  ServerProcess dying;
  const CliResult result = RunShell(Started("--server " + dying.address() + "," + other.address()) + " & pid=$!\n" +
                                    kUntilPoints + "kill -9 " + std::to_string(dying.pid()) + "; wait $pid");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ExpectUndisturbed();
}

TEST_P(CliResume, AFullDiskLeavesWhatIsOnIt) {
  // A block of ulimit has 512 or 1024 bytes: the file ends within its first third.
  const CliResult full = RunShell("ulimit -f 4000\n" + Started());
  EXPECT_EQ(full.exit_code, 42);
  EXPECT_THAT(full.err, HasSubstr("cannot write the output"));
  EXPECT_THAT(Files(), ElementsAre("result.part", "result.part.json"));
  EXPECT_EQ(RunShell(Started("--resume")).exit_code, 0);
  ExpectUndisturbed();
}

TEST_P(CliResume, ATamperedPartIsRefused) {
  Kill();
  const CliResult result =
      RunShell("printf x | dd of=result.part bs=1 seek=100 conv=notrunc status=none\n" + Started("--resume"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("are not those that were written"));
  EXPECT_THAT(Files(), ElementsAre("result.part", "result.part.json"));
}

TEST_P(CliResume, APartThatIsTooShortOrHasNoManifestIsRefused) {
  Kill();
  EXPECT_EQ(RunShell("cp result.part whole; truncate -s 100 result.part\n" + Started("--resume")).exit_code, 42);
  const CliResult result = RunShell("mv whole result.part; rm result.part.json\n" + Started("--resume"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("is missing or no manifest"));
}

TEST_P(CliResume, AManifestWithoutItsPartIsExplained) {
  Kill();
  const CliResult result = RunShell("rm result.part\n" + Started("--resume"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("result.part is missing or empty, although "));
}

TEST_P(CliResume, AnotherSweepIsRefused) {
  Kill();
  for (const std::string other : {"--mu 0.1", "--range 0:300000"}) {
    const CliResult result = RunShell(Started("--resume " + other));
    EXPECT_EQ(result.exit_code, 2) << other;
    EXPECT_THAT(result.err, HasSubstr("another sweep")) << other;
  }
}

TEST_P(CliResume, AnotherEngineIsRefused) {
  Kill();
  const CliResult result =
      RunShell("sed -i 's/\"fingerprint\": \"[0-9a-f]*\"/\"fingerprint\": \"0123456789abcdef\"/' result.part.json\n" +
               Started("--resume"));
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("must not be mixed"));
}

TEST_P(CliResume, AnUnfinishedFileIsNotOverwritten) {
  Kill();
  const CliResult result = RunShell(Started());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("add --resume to go on with it, or remove it"));
}

TEST_P(CliResume, TwoRunsDoNotWriteOneFile) {
  const CliResult result = RunShell(Started() + " & pid=$!\n" + kUntilPoints + "kill -STOP $pid\n" +
                                    Started("--resume") + "; code=$?; kill -9 $pid; exit $code");
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("another run is writing"));
}

// The picture has the points of the first run, too.
TEST_P(CliResume, ThePictureIsThatOfAnUndisturbedRun) {
  const std::string start = "\"$R\" sweep --a 0.3 --b 1 --energetic 1 --axis friction.kinetic_coefficient=lin:0:0.4:";
  const auto sweep = [&](const std::string& more) {
    return start + "900000 --column coefficients.newton --format " + GetParam() + " " + more;
  };
  RunShell(sweep("-o result") + " & pid=$!\n" + kUntilPoints + "kill -9 $pid; wait");
  ASSERT_THAT(Files(), ElementsAre("result.part", "result.part.json"));
  const CliResult resumed = RunShell(sweep("-o result --resume --size 400x300 --plot resumed.png"));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(RunShell(sweep("-o whole --size 400x300 --plot whole.png")).exit_code, 0);
  EXPECT_TRUE(Read("resumed.png") == Read("whole.png"));
}

TEST_P(CliResume, WithNothingToGoOnWithStartsAtTheFirstPoint) {
  EXPECT_EQ(RunShell(Started("--resume")).exit_code, 0);
  ExpectUndisturbed();
}

using CliWhole = CliTest;

TEST_F(CliWhole, TheCommandThatGoesOnDrawsThePicture) {
  EXPECT_EQ(ResumeCommand({"ricochet", "sweep", "--plot", "p.svg", "--title", "Two words"}),
            "ricochet sweep --plot p.svg --title 'Two words' --resume");
}

TEST_F(CliWhole, ResumeNeedsRowsInAFile) {
  for (const std::string& command :
       {Sweep("text", "-o result --resume"), Sweep("csv", "--resume"),
        Sweep("csv", "-o result --summary-only --resume"), Sweep("csv", "-o /dev/null --resume")}) {
    const CliResult result = RunShell(command);
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.err, HasSubstr("--resume needs -o FILE")) << command;
  }
  EXPECT_THAT(Files(), IsEmpty());
}

TEST_F(CliWhole, AFileWithTheNameOfTheManifestIsKept) {
  Write("result.part.json", "precious");
  const CliResult refused = RunShell(Sweep("csv", "-o result", "3"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("result.part.json is there, and the sweep needs this name: remove it"));
  EXPECT_EQ(Read("result.part.json"), "precious");
  EXPECT_THAT(Files(), ElementsAre("result.part.json"));
}

TEST_F(CliWhole, AFileThatIsReplacedKeepsItsMode) {
  const CliResult mode = RunShell("echo > f.txt; chmod 640 f.txt; \"$R\" scene list -o f.txt && stat -c %a f.txt");
  EXPECT_EQ(mode.out, "640\n") << mode.err;
}

TEST_F(CliWhole, AnInterruptedTableLeavesNoFile) {
  for (const std::string signal : {"INT", "TERM"}) {
    const CliResult result = RunShell("env --default-signal=INT timeout --preserve-status -s " + signal + " 0.5 " +
                                      Sweep("text", "-o result --summary-only", "1e12"));
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_THAT(result.err, Not(HasSubstr("--resume")));
    EXPECT_THAT(Files(), IsEmpty());
  }
}

}  // namespace
}  // namespace ricochet::cli
