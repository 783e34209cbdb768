// The fingerprint depends on the last bit of every kind of answer, so that no two engines are taken for one that differ
// in a model, a law or a system.

#include "core/engine/fingerprint.h"

#include <fenv.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <cstdlib>
#include <string>
#include <vector>

#include "ricochet/engine_info.h"

namespace ricochet {
namespace {

// An unset model or system computes nothing.
bool ComputesNothing(const std::string& kind) { return kind == "model 0" || kind == "system 0"; }

TEST(FingerprintTest, EveryModelAndSystemIsProbed) {
  for (const Probe& probe : ProbeEngine()) EXPECT_EQ(probe.bits.empty(), ComputesNothing(probe.kind)) << probe.kind;
}

TEST(FingerprintTest, TheLastBitOfAnyKindOfAnswerChangesIt) {
  std::vector<Probe> probes = ProbeEngine();
  const std::string before = FingerprintOf(probes);
  for (Probe& probe : probes) {
    const size_t size = probe.bits.size();
    if (size == 0) continue;
    for (const size_t at : {size_t{0}, size / 2, size - 1}) {
      probe.bits[at] ^= 1;
      EXPECT_NE(FingerprintOf(probes), before) << probe.kind << ", number " << at;
      probe.bits[at] ^= 1;
    }
  }
  EXPECT_EQ(FingerprintOf(probes), before);
}

// It is computed once in a process, by whichever thread asks first.
TEST(FingerprintDeathTest, DoesNotDependOnTheFloatingPointModeOfTheCaller) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto compare = [](int changed) {
    std::fesetround(changed);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    const std::string first = ThisEngine().fingerprint;
    std::fesetenv(FE_DFL_ENV);
    std::exit(first == FingerprintOf(ProbeEngine()) ? 0 : 1);
  };
  EXPECT_EXIT(compare(FE_UPWARD), testing::ExitedWithCode(0), "");
}

TEST(FingerprintTest, TheEngineHasThatOfItsProbes) {
  EXPECT_EQ(ThisEngine().fingerprint, FingerprintOf(ProbeEngine()));
}

}  // namespace
}  // namespace ricochet
