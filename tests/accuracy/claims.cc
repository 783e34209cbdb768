// Prints the table of claims: for each method, tolerance and kind of scenes, how the errors claimed compare with the
// errors achieved. It takes the number of scenes of each row as its argument and fails if a claim deceived.
//
// docs/accuracy.md explains the columns. "unknown" counts infinite claims, "least" and "median" are of claimed over
// achieved, "worst" is the largest error achieved, and the last two columns count claims and errors above the tolerance.

#include "tests/support/claims.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support/compliant_claims.h"
#include "tests/support/finite_duration_claims.h"
#include "tests/support/pendulum_claims.h"
#include "tests/support/planar_claims.h"
#include "tests/support/sliding_claims.h"
#include "tests/support/spatial_claims.h"

namespace ricochet {
namespace {

constexpr uint64_t kSeed = 77;

// The table, row by row.
class Table {
 public:
  Table() { PrintClaimsHeader(); }

  void Add(const std::string& method, const std::string& scenes, const ClaimTally& tally) {
    PrintClaims(method, scenes, tally);
    std::fflush(stdout);
    deceived_ += tally.deceived();
  }
  int deceived() const { return deceived_; }

 private:
  int deceived_ = 0;
};

// Calls `add` for typical and for hard scenes.
template <typename Add>
void ForBothKinds(const Add& add) {
  add("typical", false);
  add("hard", true);
}

void AddPendulum(int count, Table& table) {
  ForBothKinds([&](const char* scenes, bool hard) {
    table.Add("pendulum, plain", scenes, pendulum::PlainClaims(hard, count, kSeed));
    table.Add("pendulum, compensated", scenes, pendulum::CompensatedClaims(hard, count, kSeed));
    const first_order::Claims claims = first_order::ClaimsOf(hard, count, kSeed);
    table.Add("first order, velocity", scenes, claims.velocity);
    table.Add("first order, impulse", scenes, claims.impulse);
  });
}

void AddPlanar(int count, Table& table) {
  ForBothKinds([&](const char* scenes, bool hard) {
    const planar::Claims plain = planar::ClaimsOf(planar::SolvePlain, hard, count, kSeed);
    table.Add("planar plain, velocity", scenes, plain.velocity);
    table.Add("planar plain, impulse", scenes, plain.impulse);
    table.Add("planar plain, work", scenes, plain.work);
    const planar::Claims compensated = planar::ClaimsOf(planar::InDoubleDouble, hard, count, kSeed);
    table.Add("planar comp., velocity", scenes, compensated.velocity);
    table.Add("planar comp., impulse", scenes, compensated.impulse);
    table.Add("planar comp., work", scenes, compensated.work);
  });
}

template <size_t kTangential>
void AddSliding(const std::string& where, int count, Table& table) {
  ForBothKinds([&](const char* scenes, bool hard) {
    const sliding::Claims sliding = sliding::ClaimsOf<kTangential>(/*friction=*/true, hard, count, kSeed);
    table.Add("sliding, velocity" + where, scenes, sliding.velocity);
    table.Add("sliding, impulse" + where, scenes, sliding.impulse);
    const sliding::Claims smooth = sliding::ClaimsOf<kTangential>(/*friction=*/false, hard, count, kSeed);
    table.Add("smooth, velocity" + where, scenes, smooth.velocity);
    table.Add("smooth, impulse" + where, scenes, smooth.impulse);
  });
}

void AddSpatial(int count, Table& table) {
  for (const double tolerance : spatial::kClaimTolerances) {
    ForBothKinds([&](const char* scenes, bool hard) {
      table.Add("space", scenes, spatial::SpatialClaims(hard, tolerance, count, kSeed));
    });
  }
}

void AddCompliant(int count, Table& table) {
  ForBothKinds(
      [&](const char* scenes, bool hard) { table.Add("compliant", scenes, compliant::ClaimsOf(hard, count, kSeed)); });
}

void AddFiniteDuration(int count, Table& table) {
  using finite_duration::ClaimKind;
  constexpr std::pair<const char*, ClaimKind> kKinds[] = {
      {"linear", ClaimKind::kLinear}, {"Hertz", ClaimKind::kHertz}, {"compliant", ClaimKind::kCompliant}};
  for (const auto& [name, kind] : kKinds) {
    for (const double tolerance : finite_duration::kClaimTolerances) {
      ForBothKinds([&](const char* scenes, bool hard) {
        table.Add(std::string("duration, ") + name, scenes,
                  finite_duration::ClaimsOf(kind, hard, tolerance, count, kSeed));
      });
    }
  }
}

int Run(int count) {
  Table table;
  AddPendulum(count, table);
  AddPlanar(count, table);
  AddSliding<1>(" (2D)", count, table);
  AddSliding<2>(" (3D)", count, table);
  AddSpatial(count, table);
  AddCompliant(count, table);
  AddFiniteDuration(count, table);
  std::printf("%d claims deceived\n", table.deceived());
  return table.deceived() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  constexpr int kCount = 10'000;
  return ricochet::Run(argc > 1 ? std::atoi(argv[1]) : kCount);
}
