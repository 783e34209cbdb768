// The chunks of a sweep grow with a reader that keeps up, and stay small for one that does not.

#include "core/engine/chunk_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "ricochet/solver.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Le;

// Returns the sizes in KiB of as many chunks as there are times, for a reader that takes each chunk so long.
std::vector<int64_t> SizesKib(const std::vector<milliseconds>& times) {
  ChunkSize size;
  ChunkSize::Time now = ChunkSize::Time() + std::chrono::hours(1);
  std::vector<int64_t> sizes;
  for (const milliseconds time : times) {
    sizes.push_back(size.Next(now) / 1024);
    now += std::chrono::seconds(1);  // The time of the computation does not count.
    size.Emitted(now);
    now += time;
  }
  return sizes;
}

TEST(ChunkSizeTest, DoublesForAReaderThatComesBackAtOnce) {
  EXPECT_THAT(SizesKib(std::vector<milliseconds>(8, milliseconds(1))),
              ElementsAre(16, 32, 64, 128, 256, 512, 512, 512));
}

TEST(ChunkSizeTest, StaysSmallForASlowReader) {
  EXPECT_THAT(SizesKib(std::vector<milliseconds>(5, milliseconds(5000))), Each(16));
}

TEST(ChunkSizeTest, ShrinksForAReaderThatBecomesSlow) {
  const milliseconds soon(1), late(500);
  EXPECT_THAT(SizesKib({soon, soon, soon, late, late, late, late, soon}), ElementsAre(16, 32, 64, 128, 64, 32, 16, 16));
}

TEST(ChunkSizeTest, StaysForAReaderThatTakesATenthOfASecond) {
  const milliseconds soon(1), middle(200);
  EXPECT_THAT(SizesKib({soon, middle, middle, middle}), ElementsAre(16, 32, 32, 32));
}

SweepRequest LongSweep() {
  return {
      .grid = {.scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                         .friction = {.kinetic_coefficient = 0.1},
                         .restitution = EnergeticCoefficient{1.0}},
               .axes = {{.path = "pendulum.b_m", .values = Linspace{0.4, 2.1, 1'000'000}}}},
      .columns = {"coefficients.newton"}};
}

// Returns the bytes of values in the first eight chunks for a reader that waits so long before it asks for the next.
std::vector<size_t> BytesOfChunks(milliseconds wait) {
  std::vector<size_t> bytes;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(LongSweep())) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    bytes.push_back(chunk->values.size() * sizeof(double));
    if (bytes.size() == 8) break;
    std::this_thread::sleep_for(wait);
  }
  return bytes;
}

TEST(ChunkSizeTest, ASweepWhoseReaderIsSlowHasSmallChunks) {
  EXPECT_THAT(BytesOfChunks(ChunkSize::kLate + milliseconds(1)), Each(Le(ChunkSize::kLeast)));
}

}  // namespace
}  // namespace ricochet
