#include "server/port_file.h"

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

TEST(PortFile, ErrorNamesThePath) {
  const absl::Status status = WritePortFile("/nonexistent/port", 1);
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("/nonexistent/port"));
}

}  // namespace
}  // namespace ricochet::server
