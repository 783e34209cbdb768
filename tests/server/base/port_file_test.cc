#include "server/base/port_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace ricochet::server {
namespace {

TEST(PortFile, ReplacesTheOldOneAndLeavesNothingElse) {
  const std::filesystem::path directory = testing::TempDir() + "ricochetd_port_file";
  std::filesystem::create_directory(directory);
  ASSERT_TRUE(WritePortFile(directory / "port", 1).ok());
  ASSERT_TRUE(WritePortFile(directory / "port", 50051).ok());
  std::string line;
  std::getline(std::ifstream(directory / "port") >> std::ws, line);
  EXPECT_EQ(line, "50051");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory), {}), 1);
  std::filesystem::remove_all(directory);
}

// A reader of the old file reads it to its end: the new one is another file, which takes the name once it is complete.
TEST(PortFile, IsNeverSeenHalfWritten) {
  const std::filesystem::path directory = testing::TempDir() + "ricochetd_port_whole";
  std::filesystem::remove_all(directory);
  std::filesystem::create_directory(directory);
  ASSERT_TRUE(WritePortFile(directory / "port", 50051).ok());
  std::filesystem::create_hard_link(directory / "port", directory / "old");
  ASSERT_TRUE(WritePortFile(directory / "port", 1).ok());
  int old = 0;
  std::ifstream(directory / "old") >> old;
  EXPECT_EQ(old, 50051);
  std::filesystem::remove_all(directory);
}

TEST(PortFile, DevicesLinksAndDirectoriesAreNotReplaced) {
  const std::filesystem::path directory = testing::TempDir() + "ricochetd_port_link";
  std::filesystem::create_directory(directory);
  const std::filesystem::path target = directory / "target";
  std::ofstream(target) << "precious\n";
  std::filesystem::create_symlink(target, directory / "link");
  std::filesystem::create_directory(directory / "inner");
  for (const std::filesystem::path& path :
       {directory / "link", directory / "inner", std::filesystem::path("/dev/null")}) {
    const absl::Status status = WritePortFile(path, 1);
    EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition) << path;
    EXPECT_THAT(std::string(status.message()),
                testing::HasSubstr(path.string() + ": it is there and not a plain file"));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  RemovePortFile(directory / "link", 1);
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  std::filesystem::remove_all(directory);
}

TEST(PortFile, IsRemovedByTheServerThatWroteItAlone) {
  const std::string path = testing::TempDir() + "ricochetd_port_removed";
  ASSERT_TRUE(WritePortFile(path, 50051).ok());
  RemovePortFile(path, 50052);
  EXPECT_TRUE(std::filesystem::exists(path)) << "another server wrote it";
  RemovePortFile(path, 50051);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(PortFile, ErrorNamesThePath) {
  const absl::Status status = WritePortFile("/nonexistent/port", 1);
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("/nonexistent/port"));
}

}  // namespace
}  // namespace ricochet::server
