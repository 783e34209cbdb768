// Sweeps in shards and what ricochet merge makes of them: the file of one run, or an error that names what is wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/cli/cli_run.h"
#include "tests/support/processes/server_process.h"

namespace ricochet::cli {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Invalid, rebounding and locked points.
std::string Sweep(const std::string& more, const std::string& points = "5003") {
  return "\"$R\" sweep --a 0.3 --b 1 --energetic 1 --axis friction.kinetic_coefficient=lin:-0.1:0.4:" + points +
         " --column coefficients.newton,work.normal_total_j --regime " + more;
}

std::string Shard(int index, int count, const std::string& more = "") {
  return Sweep("-o s --shard-index " + std::to_string(index) + " --shard-count " + std::to_string(count) + " " + more);
}

// Waits until a manifest counts points, at most a minute.
std::string UntilPointsOf(const std::string& part) {
  return "for i in $(seq 12000); do grep -qs '\"next_index\": \"[1-9]' " + part + ".json && break; sleep 0.005; done\n";
}

class CliShard : public CliTest {
 protected:
  void Compute(int count, const std::string& more = "") const {
    for (int i = 0; i < count; ++i) {
      const CliResult result = RunShell(Shard(i, count, more));
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
  }
  // Comparing strings would print megabytes.
  void ExpectMergedLike(const std::string& format, const std::string& whole) const {
    const CliResult merged = RunShell("\"$R\" merge --verify s -o merged --format " + format);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_TRUE(Read("merged") == RunShell(whole + " --format " + format).out) << format;
  }
  void ExpectRefused(const std::string& what, int exit_code = 42, const std::string& more = "") const {
    const CliResult merged = RunShell("\"$R\" merge s -o merged --format csv " + more);
    EXPECT_EQ(merged.exit_code, exit_code);
    EXPECT_THAT(merged.err, HasSubstr(what));
    EXPECT_THAT(Files(), Not(Contains("merged")));
  }
};

TEST_F(CliShard, MergeToTheFileOfOneRun) {
  for (const int count : {1, 3, 7}) {
    RunShell("rm -f s.*");
    Compute(count);
    for (const std::string format : {"csv", "json", "jsonl"}) ExpectMergedLike(format, Sweep(""));
  }
}

TEST_F(CliShard, OfARangeMergeToTheFileOfThatRange) {
  Compute(4, "--range 1500:3777");
  for (const std::string format : {"csv", "json"}) ExpectMergedLike(format, Sweep("--range 1500:3777"));
}

TEST_F(CliShard, WithoutPointsAreComputedAndMergedToo) {
  for (int i = 0; i < 4; ++i) ASSERT_EQ(RunShell(Shard(i, 4, "--range 7:9")).exit_code, 0);
  for (const std::string format : {"csv", "json"}) ExpectMergedLike(format, Sweep("--range 7:9"));
  RunShell("rm -f s.*");
  for (int i = 0; i < 2; ++i) ASSERT_EQ(RunShell(Shard(i, 2, "--range 7:7")).exit_code, 0);
  for (const std::string format : {"csv", "json"}) ExpectMergedLike(format, Sweep("--range 7:7"));
}

TEST_F(CliShard, ComeFromAServerToo) {
  const ServerProcess server;
  Compute(2, "--server " + server.address());
  ExpectMergedLike("csv", Sweep(""));
}

TEST_F(CliShard, OfDifferentCountsMayMakeUpASweep) {
  ASSERT_EQ(RunShell(Shard(0, 2, "--range 0:5000") + "\n" + Shard(2, 4, "--range 0:5000") + "\n" +
                     Shard(3, 4, "--range 0:5000"))
                .exit_code,
            0);
  ExpectMergedLike("csv", Sweep("--range 0:5000"));
}

TEST_F(CliShard, HaveAManifestThatSaysWhatTheyAre) {
  ASSERT_EQ(RunShell(Shard(2, 11)).exit_code, 0);
  EXPECT_THAT(Files(), ElementsAre("s.shard-02-of-11", "s.shard-02-of-11.json"));
  // 5003 points are 9 shards of 455 and 2 of 454; the first 9 are the longer ones.
  for (const std::string line : {"\"shard_index\": \"2\"", "\"shard_count\": \"11\"", "\"first_index\": \"910\"",
                                 "\"end_index\": \"1365\"", "\"rows\": \"455\"", "\"fingerprint\": \""}) {
    EXPECT_THAT(Read("s.shard-02-of-11.json"), HasSubstr(line));
  }
}

TEST_F(CliShard, ThatAreCompleteAreNotComputedAgain) {
  ASSERT_EQ(RunShell(Shard(0, 2)).exit_code, 0);
  const CliResult result = RunShell("ls -i s.shard* > before\n" + Shard(0, 2) + "\nls -i s.shard* | cmp - before");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.err, HasSubstr("s.shard-0-of-2 is complete"));
}

TEST_F(CliShard, GoOnAfterKillMinusNine) {
  const std::string points = "3000000";
  const auto shard = [&points](int index) {
    return Sweep("-o s --shard-count 2 --shard-index " + std::to_string(index), points);
  };
  ASSERT_EQ(RunShell(shard(1)).exit_code, 0);
  RunShell(shard(0) + " & pid=$!\n" + UntilPointsOf("s.shard-0-of-2.part") + "kill -9 $pid; wait");
  EXPECT_THAT(Files(),
              ElementsAre("s.shard-0-of-2.part", "s.shard-0-of-2.part.json", "s.shard-1-of-2", "s.shard-1-of-2.json"));
  ExpectRefused("no shard has points 0 to 1499999, before shard 1 of 2 (s.shard-1-of-2)");
  // The finished part is kept: its first bytes stay those of the run before.
  const CliResult result = RunShell("ls -i s.shard-0-of-2.part | cut -d ' ' -f 1 > before\n" + shard(0) +
                                    "\nls -i s.shard-0-of-2 | cut -d ' ' -f 1 | cmp - before");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ExpectMergedLike("csv", Sweep("", points));
}

TEST_F(CliShard, ThatAreMissingAreNamed) {
  Compute(4);
  RunShell("rm s.shard-0-of-4");
  ExpectRefused("cannot read shard 0 of 4 (s.shard-0-of-4)");
  RunShell("rm s.shard-0-of-4.json s.shard-2-of-4*");
  ExpectRefused("no shard has points 0 to 1250, before shard 1 of 4 (s.shard-1-of-4)");
  ExpectRefused("no shard has points 2502 to 3752, before shard 3 of 4 (s.shard-3-of-4)");
  RunShell("rm s.shard-3-of-4*");
  ExpectRefused("no shard has points 2502 to 5002, after shard 1 of 4 (s.shard-1-of-4)");
  RunShell("rm s.*");
  ExpectRefused("there is no finished shard s.shard-I-of-N", 42);
}

TEST_F(CliShard, ThatOverlapAreNamed) {
  Compute(3);
  ASSERT_EQ(RunShell(Shard(0, 2)).exit_code, 0);
  ExpectRefused("both shard 0 of 3 (s.shard-0-of-3) and shard 0 of 2 (s.shard-0-of-2) have points 0 to 1667");
  ExpectRefused("both shard 0 of 2 (s.shard-0-of-2) and shard 1 of 3 (s.shard-1-of-3) have points 1668 to 2501");
}

TEST_F(CliShard, OfAnotherSweepAreRefused) {
  Compute(2);
  EXPECT_THAT(RunShell(Shard(0, 2, "--mu-static 0.9")).err, HasSubstr("is of another sweep than the one asked for"));
  RunShell("rm s.shard-1-of-2*\n" + Shard(1, 2, "--mu-static 0.9"));
  ExpectRefused("shard 1 of 2 (s.shard-1-of-2) is of another sweep than shard 0 of 2", 2);
}

TEST_F(CliShard, OfAnotherEngineAreRefused) {
  Compute(2);
  RunShell("sed -i 's/\"fingerprint\": \"[0-9a-f]*\"/\"fingerprint\": \"0123456789abcdef\"/' s.shard-1-of-2.json");
  ExpectRefused("must not be mixed");
}

// The C library's pow gives other last bits where its processor has no fused multiply-add; it can be told to think so.
TEST_F(CliShard, OfAMachineWhoseLibraryHasOtherPowersAreRefused) {
  const std::string other = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4 ";
  if (RunShell("\"$R\" --version").out == RunShell(other + "\"$R\" --version").out) {
    GTEST_SKIP() << "this machine's C library has one pow";
  }
  ASSERT_EQ(RunShell(Shard(0, 2)).exit_code, 0);
  ASSERT_EQ(RunShell(other + Shard(1, 2)).exit_code, 0);
  ExpectRefused("must not be mixed");
}

TEST_F(CliShard, ThatWereChangedAreRefused) {
  Compute(2);
  RunShell("printf x | dd of=s.shard-1-of-2 bs=1 seek=5000 conv=notrunc status=none");
  for (const std::string more : {"", "--verify"}) ExpectRefused("shard 1 of 2 (s.shard-1-of-2)", 42, more);
  EXPECT_THAT(RunShell(Shard(1, 2)).err, HasSubstr("remove it and compute it anew"));
  RunShell("truncate -s 5000 s.shard-1-of-2");
  for (const std::string more : {"", "--verify"}) ExpectRefused("shard 1 of 2 (s.shard-1-of-2)", 42, more);
  RunShell(": > s.shard-1-of-2");
  ExpectRefused("it ends at point 2502 instead of 5003");
}

TEST_F(CliShard, WhoseManifestLiesAreRefused) {
  Compute(2);
  RunShell(
      "cp s.shard-0-of-2.json keep; sed -i 's/\"end_index\": \"2502\"/\"end_index\": \"2503\"/' s.shard-0-of-2.json");
  ExpectRefused("contradicts itself");
  RunShell("echo '{' > s.shard-0-of-2.json");
  ExpectRefused("is no manifest of a shard");
  // Shard 1 under the name of shard 0.
  RunShell("cp keep s.shard-0-of-2.json; cp s.shard-1-of-2 s.shard-0-of-2");
  ExpectRefused("shard 0 of 2 (s.shard-0-of-2): the sweep's next chunk should start at point 0");
}

// A task is told this, and computes that shard.
struct Place {
  std::string environment;
  std::string flags;
  std::string file;
};

class CliShardPlace : public CliTest, public testing::WithParamInterface<Place> {};

INSTANTIATE_TEST_SUITE_P(
    Launchers, CliShardPlace,
    testing::Values(
        Place{"SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_MIN=1", "--shard", "s.shard-2-of-4"},
        Place{"SLURM_ARRAY_TASK_ID=9 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=5 SLURM_ARRAY_TASK_STEP=2",
              "--shard", "s.shard-2-of-3"},
        // The task of a larger array that is repeated alone.
        Place{"SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_COUNT=1 SLURM_ARRAY_TASK_MIN=3", "--shard-count 4",
              "s.shard-3-of-4"},
        Place{"JOB_COMPLETION_INDEX=2", "--shard-count 3", "s.shard-2-of-3"},
        Place{"OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=2", "--shard", "s.shard-1-of-2"},
        Place{"OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=2", "--shard-index 0 --shard-count 1", "s.shard-0-of-1"}));

TEST_P(CliShardPlace, IsThatOfTheTask) {
  const CliResult result = RunShell("export " + GetParam().environment + "\n" + Sweep("-o s " + GetParam().flags));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(Files(), Contains(GetParam().file));
}

// A wrong place, and the words that are said of it.
struct WrongPlace {
  std::string environment;
  std::string flags;
  std::string error;
};

class CliShardWrongPlace : public CliTest, public testing::WithParamInterface<WrongPlace> {};

INSTANTIATE_TEST_SUITE_P(
    Launchers, CliShardWrongPlace,
    testing::Values(
        WrongPlace{"A=", "--shard", "--shard-count is missing: no Slurm array, Indexed Job or mpirun started this run"},
        WrongPlace{"A=", "--shard-count 2", "--shard-index is missing"},
        WrongPlace{"A=", "--shard-index 2 --shard-count 2", "--shard-index = 2: must be in [0, 1], for 2 shards"},
        WrongPlace{"A=", "--shard-index -1 --shard-count 2", "--shard-index = -1: must be"},
        WrongPlace{"A=", "--shard-index 0 --shard-count 0", "--shard-count = 0: must be at least 1"},
        WrongPlace{"A=", "--shard-index x --shard-count 2", "--shard-index = x: must be"},
        WrongPlace{"A=", "--shard --format csv", "--format"},
        WrongPlace{"A=", "--shard --summary-only", "--summary-only"},
        WrongPlace{"JOB_COMPLETION_INDEX=0", "--shard", "--shard-count is missing: Kubernetes tells"},
        WrongPlace{"JOB_COMPLETION_INDEX=5", "--shard-count 5",
                   "JOB_COMPLETION_INDEX = 5 is shard 5, counted from 0, but there are only 5 shards"},
        WrongPlace{"OMPI_COMM_WORLD_RANK=0", "--shard", "the environment lacks OMPI_COMM_WORLD_SIZE"},
        WrongPlace{"OMPI_COMM_WORLD_RANK=x OMPI_COMM_WORLD_SIZE=2", "--shard", "OMPI_COMM_WORLD_RANK = x: must be"},
        WrongPlace{"OMPI_COMM_WORLD_RANK=0 JOB_COMPLETION_INDEX=0", "--shard-count 2",
                   "both JOB_COMPLETION_INDEX and OMPI_COMM_WORLD_RANK are in the environment"},
        WrongPlace{"SLURM_ARRAY_TASK_ID=4 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_STEP=2",
                   "--shard", "SLURM_ARRAY_TASK_ID = 4: must be 1 or a number of steps of 2 above it"},
        // The tasks 1, 3 and 7 of an array are no steps of one length.
        WrongPlace{"SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=1", "--shard",
                   "SLURM_ARRAY_TASK_ID = 7 is shard 6, counted from 0, but there are only 3 shards"}));

TEST_P(CliShardWrongPlace, IsRefused) {
  const CliResult result = RunShell("export " + GetParam().environment + "\n" + Sweep("-o s " + GetParam().flags));
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().error));
  EXPECT_THAT(Files(), IsEmpty());
}

using CliShardInput = CliTest;

TEST_F(CliShardInput, NeedsAFile) {
  const CliResult result = RunShell(Sweep("--shard-index 0 --shard-count 2"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("a shard needs -o FILE"));
}

TEST_F(CliShardInput, ThatNoSolverTakesIsRefusedWithItsFields) {
  const CliResult result = RunShell(Shard(0, 2, "--range 5:6000"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("end_index = 6000: must be in [0, 5003]"));
  EXPECT_THAT(Files(), IsEmpty());
}

}  // namespace
}  // namespace ricochet::cli
