// Fail: how a fuzz target reports a broken claim, so that libFuzzer keeps the input.

#ifndef RICOCHET_TESTS_FUZZ_FAIL_H_
#define RICOCHET_TESTS_FUZZ_FAIL_H_

#include <cstdio>
#include <cstdlib>
#include <string>

namespace ricochet {

[[noreturn]] inline void Fail(const std::string& what) {
  std::fprintf(stderr, "BROKEN: %s\n", what.c_str());
  std::abort();
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_FAIL_H_
