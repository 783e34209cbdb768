#include "core/cost/certified_velocity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/statusor.h"
#include "core/base/invariant.h"
#include "core/certified/certified.h"
#include "core/certified/residual.h"

namespace ricochet {
namespace {

constexpr char kTangentialPath[] = "contact_velocity_after.tangential_m_s[0]";
constexpr char kNormalPath[] = "contact_velocity_after.normal_m_s";

const CertifiedNumber& NumberOf(const Certificate& certificate, const std::string& path) {
  const auto found = std::find_if(certificate.numbers.begin(), certificate.numbers.end(),
                                  [&path](const CertifiedNumber& number) { return number.path == path; });
  CheckInvariant(found != certificate.numbers.end(), "a certificate has the numbers of an outcome");
  return *found;
}

}  // namespace

std::optional<Certificate> CertifyContact(const Scene& scene, int digits, Stopped stopped) {
  if (!CheckCertifiable(scene, digits).empty()) return std::nullopt;
  absl::StatusOr<Certificate> certificate = CertifySolve(scene, {.digits = digits}, stopped);
  if (!certificate.ok() || certificate->is_set) return std::nullopt;
  return *std::move(certificate);
}

Wide ExactNumber(const Certificate& certificate, const std::string& path) {
  const CertifiedNumber& number = NumberOf(certificate, path);
  return Wide::Exactly(number.value) + Wide::Exactly(certified::Residual(number.decimal, number.value));
}

ReferenceVelocity ReferenceVelocityOf(const Certificate& certificate) {
  return {.of = {ExactNumber(certificate, kTangentialPath), Wide::Exactly(0.0), ExactNumber(certificate, kNormalPath)},
          .error = 0x1p-104,
          .source = kCertifiedSource};
}

Velocity3 RoundedVelocityOf(const Certificate& certificate) {
  return {NumberOf(certificate, kTangentialPath).value, 0.0, NumberOf(certificate, kNormalPath).value};
}

double Distance(const Certificate& one, const Certificate& other) {
  double most = 0.0;
  for (const char* path : {kTangentialPath, kNormalPath}) {
    most = std::max(most, std::fabs(certified::Residual(NumberOf(one, path).decimal, NumberOf(other, path).decimal)));
  }
  return most;
}

}  // namespace ricochet
