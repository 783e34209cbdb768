// The writer of the log on files, pipes and disks that fail.

#include "server/base/log_writer.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/processes/temporary_directory.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

// Far longer than any wait of the writer's own.
constexpr seconds kLong(20);

std::string Contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string NoticeOf(int64_t dropped) { return "dropped " + std::to_string(dropped) + "\n"; }

class LogWriterTest : public testing::Test {
 protected:
  LogWriterTest() { std::signal(SIGPIPE, SIG_IGN); }

  std::filesystem::path Path(const std::string& name) const { return directory_.path() / name; }

  TemporaryDirectory directory_;
};

TEST_F(LogWriterTest, LinesAreAppendedInOrder) {
  std::ofstream(Path("log")) << "old\n";
  auto writer = LogWriter::Open(Path("log"));
  ASSERT_TRUE(writer.ok()) << writer.status();
  (*writer)->Push("one\n");
  (*writer)->Push("two\n");
  EXPECT_TRUE((*writer)->Flush(kLong));
  EXPECT_EQ(Contents(Path("log")), "old\none\ntwo\n");
}

TEST_F(LogWriterTest, AFileOfItsOwnIsForTheOwnerAndTheGroup) {
  const mode_t before = umask(0);
  const auto writer = LogWriter::Open(Path("log"));
  umask(before);
  struct stat file = {};
  ASSERT_EQ(stat(Path("log").c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 07777U, 0640U);
}

TEST_F(LogWriterTest, WhatWaitsIsWrittenBeforeTheEnd) {
  { LogWriter::Open(Path("log")).value()->Push("last\n"); }
  EXPECT_EQ(Contents(Path("log")), "last\n");
}

TEST_F(LogWriterTest, APathThatCannotBeWrittenIsNamed) {
  const auto writer = LogWriter::Open(Path("no_such_directory/log"));
  EXPECT_THAT(std::string(writer.status().message()), HasSubstr("no_such_directory/log"));
}

TEST_F(LogWriterTest, APipeThatNobodyHasOpenedIsAnErrorAndNotAWait) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(LogWriter::Open(Path("pipe")).status().code(), absl::StatusCode::kUnavailable);
}

TEST_F(LogWriterTest, APipeThatNobodyReadsDropsAndCountsAndGoesOnWhenItIsRead) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  const int pipe = open(Path("pipe").c_str(), O_RDWR | O_NONBLOCK);
  // In a full pipe no line finds room before the test reads, so all lines that are lost are lost in one go.
  std::string expected;
  while (write(pipe, "x", 1) == 1) expected += 'x';
  auto writer = LogWriter::Open(Path("pipe"), /*buffer_bytes=*/100'000).value();
  constexpr int kLines = 50'000;
  for (int i = 0; i < kLines; ++i) writer->Push("0123456789\n");
  // Set only now, so that the writer cannot report the first losses before the last.
  writer->SetNotice(NoticeOf);
  const int64_t dropped = writer->dropped();
  EXPECT_GT(dropped, 0);
  EXPECT_FALSE(writer->Flush(milliseconds(10)));

  const std::string notice = NoticeOf(dropped);
  std::string text;
  for (const auto end = steady_clock::now() + kLong; text.find(notice) == std::string::npos;) {
    ASSERT_LT(steady_clock::now(), end);
    char part[4096];
    const ssize_t count = read(pipe, part, sizeof part);
    if (count > 0) text.append(part, static_cast<size_t>(count));
  }
  EXPECT_TRUE(writer->Flush(kLong));
  for (int64_t i = 0; i < kLines - dropped; ++i) expected += "0123456789\n";
  EXPECT_EQ(text, expected + notice);
  close(pipe);
}

TEST_F(LogWriterTest, AWriterOnAPipeThatNobodyReadsEnds) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  const int pipe = open(Path("pipe").c_str(), O_RDWR | O_NONBLOCK);
  auto writer = LogWriter::Open(Path("pipe")).value();
  for (int i = 0; i < 50'000; ++i) writer->Push("0123456789\n");
  writer.reset();
  close(pipe);
}

TEST_F(LogWriterTest, AFullDeviceStopsNobody) {
  auto writer = LogWriter::Open("/dev/full", /*buffer_bytes=*/1000).value();
  for (int i = 0; i < 1000; ++i) writer->Push("0123456789\n");
  EXPECT_GT(writer->dropped(), 0);
  EXPECT_FALSE(writer->Flush(milliseconds(10)));
}

// Mounts a small file system in memory, or tells why not.
class SmallDisk {
 public:
  explicit SmallDisk(std::filesystem::path path) : path_(std::move(path)) {
    std::filesystem::create_directory(path_);
    mounted_ = mount("tmpfs", path_.c_str(), "tmpfs", 0, "size=64k") == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount2(path_.c_str(), MNT_DETACH);
  }
  bool mounted() const { return mounted_; }

 private:
  std::filesystem::path path_;
  bool mounted_ = false;
};

TEST_F(LogWriterTest, AFullDiskThatIsFreedTakesTheRestAndTellsWhatIsMissing) {
  const SmallDisk disk(Path("disk"));
  if (!disk.mounted()) GTEST_SKIP() << "cannot mount a file system here";
  { std::ofstream(Path("disk/other")) << std::string(60'000, 'x'); }
  auto writer = LogWriter::Open(Path("disk/log"), /*buffer_bytes=*/40'000).value();
  writer->SetNotice(NoticeOf);
  constexpr int kLines = 10'000;
  for (int i = 0; i < kLines; ++i) {
    writer->Push("0123456789\n");
    if (i % 1000 == 0) writer->Flush(milliseconds(20));
  }
  EXPECT_GT(writer->dropped(), 0);
  EXPECT_FALSE(writer->Flush(milliseconds(10)));
  std::filesystem::remove(Path("disk/other"));
  EXPECT_TRUE(writer->Flush(kLong));
  std::string expected;
  for (int64_t i = 0; i < kLines - writer->dropped(); ++i) expected += "0123456789\n";
  EXPECT_EQ(Contents(Path("disk/log")), expected + NoticeOf(writer->dropped()));
}

TEST_F(LogWriterTest, AfterReopenLinesGoToANewFile) {
  auto writer = LogWriter::Open(Path("log")).value();
  writer->Push("before\n");
  EXPECT_TRUE(writer->Flush(kLong));
  std::filesystem::rename(Path("log"), Path("log.1"));
  writer->Push("between\n");
  EXPECT_TRUE(writer->Flush(kLong));
  EXPECT_TRUE(writer->Reopen().ok());
  writer->Push("after\n");
  EXPECT_TRUE(writer->Flush(kLong));
  EXPECT_EQ(Contents(Path("log.1")), "before\nbetween\n");
  EXPECT_EQ(Contents(Path("log")), "after\n");
}

TEST_F(LogWriterTest, AReopenThatFailsKeepsTheOldFile) {
  std::filesystem::create_directory(Path("directory"));
  auto writer = LogWriter::Open(Path("directory/log")).value();
  std::filesystem::rename(Path("directory"), Path("elsewhere"));
  EXPECT_FALSE(writer->Reopen().ok());
  writer->Push("still\n");
  EXPECT_TRUE(writer->Flush(kLong));
  EXPECT_EQ(Contents(Path("elsewhere/log")), "still\n");
}

TEST_F(LogWriterTest, AReopenWhileTheDiskIsFullMovesWhatWaitsToTheNewFile) {
  std::filesystem::create_symlink("/dev/full", Path("log"));
  auto writer = LogWriter::Open(Path("log")).value();
  writer->Push("waits\n");
  EXPECT_FALSE(writer->Flush(milliseconds(10)));
  std::filesystem::remove(Path("log"));
  EXPECT_TRUE(writer->Reopen().ok());
  EXPECT_TRUE(writer->Flush(kLong));
  EXPECT_EQ(Contents(Path("log")), "waits\n");
}

}  // namespace
}  // namespace ricochet::server
