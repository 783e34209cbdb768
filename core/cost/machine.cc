#include "core/cost/machine.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "core/numerics/simd_target.h"

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

namespace ricochet {
namespace {

std::string CpuName() {
#if defined(__x86_64__) || defined(__i386__)
  // Each of the three CPUID leaves from here on holds 16 characters of the name.
  constexpr uint32_t kFirst = 0x80000002;
  constexpr uint32_t kLast = 0x80000004;
  std::array<uint32_t, 4> part = {};
  if (static_cast<uint32_t>(__get_cpuid_max(0x80000000, nullptr)) >= kLast) {
    std::string name;
    for (uint32_t leaf = kFirst; leaf <= kLast; ++leaf) {
      __get_cpuid(leaf, &part[0], &part[1], &part[2], &part[3]);
      std::array<char, sizeof(part)> text = {};
      std::memcpy(text.data(), part.data(), sizeof(part));
      name.append(text.data(), strnlen(text.data(), text.size()));
    }
    absl::RemoveExtraAsciiWhitespace(&name);
    if (!name.empty()) return name;
  }
#endif
  return "unknown";
}

std::string CompilerName() {
#if defined(__clang__)
  return absl::StrCat("Clang ", __clang_major__, ".", __clang_minor__, ".", __clang_patchlevel__);
#elif defined(__GNUC__)
  return absl::StrCat("GCC ", __GNUC__, ".", __GNUC_MINOR__, ".", __GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

bool IsOptimized() {
#if defined(__OPTIMIZE__)
  return true;
#else
  return false;
#endif
}

}  // namespace

CostMachine ThisMachine() {
  return {.cpu = CpuName(), .compiler = CompilerName(), .simd_target = SimdTarget(), .optimized = IsOptimized()};
}

}  // namespace ricochet
