// Takes the place of every other source of this folder in a build without FLINT: no certificate can be asked for.

#include <vector>

#include "core/base/invariant.h"
#include "core/certified/certified.h"
#include "core/certified/residual.h"

namespace ricochet {
namespace {

constexpr char kNotChecked[] = "a certificate was computed whose request CheckCertifiable refuses";

}  // namespace

bool certified::IsAvailable() { return false; }

double certified::Residual(const std::string& /*decimal*/, double /*number*/) {
  StopOnBrokenInvariant(kNotChecked, __FILE__, __LINE__);
}

double certified::Residual(const std::string& /*decimal*/, const std::string& /*other*/) {
  StopOnBrokenInvariant(kNotChecked, __FILE__, __LINE__);
}

std::vector<Violation> CheckCertifiable(const Scene& /*scene*/, int digits) {
  return {MakeViolation("certified_digits", digits, "be 0, this build has no certified numbers (component certified)")};
}

absl::StatusOr<Certificate> CertifySolve(const Scene& /*scene*/, const CertifiedPrecision& /*precision*/,
                                         absl::FunctionRef<bool()> /*stopped*/) {
  StopOnBrokenInvariant(kNotChecked, __FILE__, __LINE__);
}

absl::StatusOr<Certificate> CertifyBounds(const Scene& /*scene*/, const CertifiedPrecision& /*precision*/,
                                          absl::FunctionRef<bool()> /*stopped*/) {
  StopOnBrokenInvariant(kNotChecked, __FILE__, __LINE__);
}

}  // namespace ricochet
