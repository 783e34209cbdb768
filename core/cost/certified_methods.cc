// Certified arithmetic, at 16, 32 and 64 digits.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/certified/certified.h"
#include "core/cost/methods_by_model.h"
#include "core/cost/reference_velocity.h"

namespace ricochet {
namespace {

constexpr int kDigits[] = {16, 32, 64};

// 10^(1 - digits): a certified decimal is within one unit of its last digit.
double UnitOfLastDigit(int digits) {
  double unit = 1.0;
  for (int i = 1; i < digits; ++i) unit *= 0.1;
  return unit;
}

Kernel CertifiedKernel(const Scene& scene, int digits, double speed) {
  // The certificate of most digits, made for the first answer.
  auto finest = std::make_shared<std::optional<Certificate>>();
  const auto solve = [digits](const Scene& of, Stopped stopped) { return CertifyContact(of, digits, stopped); };
  const auto read = [digits, speed, finest](const Scene& of, const std::optional<Certificate>& certificate) {
    if (!certificate.has_value()) return KernelAnswer{.failure = "No digits of this impact could be certified."};
    if (!finest->has_value()) *finest = CertifyContact(of, kReferenceDigits, [] { return false; });
    KernelAnswer answer = {.velocity = RoundedVelocityOf(*certificate)};
    const double after = std::max(std::fabs(answer.velocity[0]), std::fabs(answer.velocity[2]));
    answer.claimed = UnitOfLastDigit(digits) * after / speed;
    answer.numerical_error = Distance(*certificate, finest->value()) / speed;
    return answer;
  };
  return MakeKernel(scene, solve, read);
}

}  // namespace

void AddCertified(const Scene& scene, double speed, double claimed_modelling, const ReferencePointer& exact,
                  Methods& methods) {
  for (const int digits : kDigits) {
    const bool closed_form = std::holds_alternative<Pendulum>(scene.system);
    StudiedMethod method = {.name = absl::StrCat("certified, ", digits, " digits"),
                            .method = {.model = closed_form ? Model::kPendulum : Model::kPlanar,
                                       .arithmetic = Arithmetic::kCertified,
                                       .digits = digits},
                            .claimed_modelling = claimed_modelling,
                            .exact = exact};
    if (certified::IsAvailable()) {
      if (!CheckCertifiable(scene, digits).empty()) return;
      method.kernel = CertifiedKernel(scene, digits, speed);
    } else {
      method.unavailable = "This build has no certified numbers (component certified).";
    }
    methods.push_back(std::move(method));
  }
}

}  // namespace ricochet
