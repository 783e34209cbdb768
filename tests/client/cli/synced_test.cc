// What a name promises was on the disk before the file got the name, so that a loss of power cannot leave a name
// without its bytes. The functions that sync and rename are replaced by ones that also keep a record.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "client/cli/io/output.h"
#include "client/cli/io/partial_file.h"
#include "client/cli/sweep/sweep_output.h"
#include "ricochet/solver.h"
#include "tests/support/processes/temporary_directory.h"

namespace {

struct Record {
  std::filesystem::path folder;
  std::map<ino_t, off_t> synced;      // The size of each file when it was last synced.
  std::vector<std::string> named;     // The names that were given, in their order.
  std::vector<std::string> unsynced;  // The files that had bytes which were not synced when a name was given.
};

Record* record = nullptr;

void NoteSync(int descriptor) {
  struct stat info;
  if (record != nullptr && fstat(descriptor, &info) == 0) record->synced[info.st_ino] = info.st_size;
}

void NoteRename(const char* name) {
  if (record == nullptr) return;
  record->named.push_back(std::filesystem::path(name).filename());
  for (const auto& entry : std::filesystem::directory_iterator(record->folder)) {
    struct stat info;
    if (stat(entry.path().c_str(), &info) != 0) continue;
    const auto found = record->synced.find(info.st_ino);
    const off_t synced = found == record->synced.end() ? 0 : found->second;
    if (info.st_size != synced) record->unsynced.push_back(entry.path().filename());
  }
  // The inode of a file that is replaced may come back as another file.
  struct stat replaced;
  if (stat(name, &replaced) == 0) record->synced.erase(replaced.st_ino);
}

}  // namespace

extern "C" int fsync(int descriptor) {
  NoteSync(descriptor);
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

extern "C" int fdatasync(int descriptor) {
  NoteSync(descriptor);
  return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  NoteRename(to);
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace ricochet::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Synced : public testing::Test {
 protected:
  Synced() {
    record_.folder = directory_.path();
    record = &record_;
  }
  ~Synced() override { record = nullptr; }
  std::string Path(const std::string& name) const { return directory_ / name; }

  TemporaryDirectory directory_;
  Record record_;
};

TEST_F(Synced, AManifestCountsOnlyBytesThatAreOnTheDisk) {
  Partial wanted;
  wanted.set_format("csv");
  absl::StatusOr<PartialFile> file = PartialFile::Open(Path("rows.csv"), wanted, /*resume=*/false);
  ASSERT_TRUE(file.ok()) << file.status();
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(file->Write(std::string(1000, 'x')).ok());
    wanted.set_next_index(i);
    ASSERT_TRUE(file->Checkpoint(wanted).ok());
  }
  ASSERT_TRUE(file->Write("the last bytes").ok());
  ASSERT_TRUE(file->Commit().ok());
  EXPECT_THAT(record_.named, ElementsAre("rows.csv.part.json", "rows.csv.part.json", "rows.csv.part.json",
                                         "rows.csv.part.json", "rows.csv"));
  EXPECT_THAT(record_.unsynced, IsEmpty());
}

TEST_F(Synced, AFileIsOnTheDiskBeforeItIsNamed) {
  ASSERT_TRUE(WriteFile(Path("answer.json"), "{}\n").ok());
  EXPECT_THAT(record_.named, ElementsAre("answer.json"));
  EXPECT_THAT(record_.unsynced, IsEmpty());
}

SweepRequest SmallSweep() {
  SweepRequest request;
  request.grid.scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  request.grid.axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.4, 1000}}};
  request.columns = {"coefficients.newton"};
  return request;
}

// Lets a sweep go through `output` to its end.
absl::Status Pass(const SweepRequest& request, absl::StatusOr<SweepOutput> output) {
  if (!output.ok()) return output.status();
  const LocalSolver solver(Limits::None(), 1);
  for (absl::StatusOr<SweepChunk>& chunk : solver.Sweep(request, {})) {
    if (!chunk.ok()) return chunk.status();
    if (absl::Status status = output->Join(*chunk); !status.ok()) return status;
    if (absl::Status status = output->Write(*chunk); !status.ok()) return status;
  }
  return output->Commit();
}

TEST_F(Synced, ASweepOfEachFormatIsOnTheDiskBeforeItIsNamed) {
  const SweepRequest request = SmallSweep();
  for (const Format format : {Format::kText, Format::kCsv, Format::kNpy, Format::kNetcdf}) {
    const CommonOptions options = {.format = format, .output = Path("sweep." + FormatName(format))};
    const absl::Status done = Pass(request, SweepOutput::Open(request, options, /*summary_only=*/false));
    if (done.code() == absl::StatusCode::kUnimplemented) continue;  // A build without NetCDF.
    ASSERT_TRUE(done.ok()) << done;
    EXPECT_EQ(record_.named.back(), "sweep." + FormatName(format));
  }
  EXPECT_THAT(record_.unsynced, IsEmpty());
}

TEST_F(Synced, AShardIsOnTheDiskBeforeItIsNamedAndAfterItsManifest) {
  const absl::StatusOr<SweepShard> shard = MakeShard(SmallSweep(), {.index = 0, .count = 2}, Path("sweep"));
  ASSERT_TRUE(shard.ok()) << shard.status();
  const absl::Status done = Pass(shard->part, SweepOutput::OpenShard(*shard));
  ASSERT_TRUE(done.ok()) << done;
  EXPECT_THAT(record_.named, ElementsAre("sweep.shard-0-of-2.part.json", "sweep.shard-0-of-2.part.json",
                                         "sweep.shard-0-of-2.json", "sweep.shard-0-of-2"));
  EXPECT_THAT(record_.unsynced, IsEmpty());
}

}  // namespace
}  // namespace ricochet::cli
