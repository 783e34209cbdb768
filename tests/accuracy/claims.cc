// Prints the table of claims: for each method, tolerance and kind of scenes, how the errors claimed compare with the
// errors achieved. It takes the number of scenes of each row as its argument and fails if a claim deceived.
//
// docs/accuracy.md explains the columns. "least" and "median" are of claimed over achieved, "worst" is the largest error
// achieved, and the last two columns count claims and errors above the tolerance.

#include "tests/support/claims.h"

#include <cstdio>
#include <cstdlib>
#include <string>

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

void AddSpatial(int count, Table& table) {
  for (const double tolerance : spatial::kClaimTolerances) {
    table.Add("space", "typical", spatial::SpatialClaims(/*hard=*/false, tolerance, count, kSeed));
    table.Add("space", "hard", spatial::SpatialClaims(/*hard=*/true, tolerance, count, kSeed));
  }
}

int Run(int count) {
  Table table;
  AddSpatial(count, table);
  std::printf("%d claims deceived\n", table.deceived());
  return table.deceived() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  constexpr int kCount = 10'000;
  return ricochet::Run(argc > 1 ? std::atoi(argv[1]) : kCount);
}
