#include "core/certified/certified.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/certified/answers.h"
#include "core/certified/digits.h"
#include "core/certified/flint.h"
#include "core/certified/system.h"
#include "core/contact/reduction.h"
#include "core/contact/scene_contact.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace certified {
namespace {

using Stopped = absl::FunctionRef<bool()>;

enum class Question { kSolve, kBounds };

template <typename N>
Answer<N> AnswerTo(Question question, const SystemContact<N>& system, Branches& branches) {
  return question == Question::kSolve ? AnswerSolve(system, branches) : AnswerBounds(system, branches);
}

// FLINT keeps numbers and tables for each thread; nothing but this frees them when the thread ends.
void FreeTablesWithThread() {
  struct Tables {
    ~Tables() { flint_cleanup(); }
  };
  thread_local const Tables tables;
  static_cast<void>(tables);
}

// --- Exact systems ---

std::optional<Violation> CheckExactContact(const Scene& scene, const Contact<Surd>& contact) {
  if (contact.v0.Sign() >= 0) return std::nullopt;
  if (contact.det.Sign() < 0) {
    return MakeViolation("planar_contact.w_tn_per_kg", "makes det W < 0",
                         "leave it >= 0 exactly, not to rounding, with certified_digits");
  }
  const bool in_range = contact.wnn.Sign() > 0 && (contact.u0 * contact.wnn - contact.v0 * contact.wtn).Sign() == 0;
  if (contact.det.Sign() > 0 || in_range) return std::nullopt;
  return MakeViolation(scene.surface_velocity.has_value() ? "surface_velocity" : "planar_contact.tangential_m_s",
                       "makes (u0, v0) lie beside the range of W, whose rank is one",
                       "lie in it exactly, not to "
                       "rounding, for a certified answer, which knows no impact of this kind");
}

Certificate CertifyExact(Question question, const SystemContact<Surd>& system, int digits) {
  Branches branches;
  const Answer<Surd> answer = AnswerTo(question, system, branches);
  Certificate certificate = {
      .digits = digits, .precision_bits = static_cast<int>(BitsOf(digits)), .regimes = {answer.regime}};
  for (const NamedNumber<Surd>& named : answer.numbers) {
    if (!named.number.has_value()) continue;
    CertifiedNumber& number = certificate.numbers.emplace_back(Certify(*named.number, digits));
    number.path = named.path;
  }
  return certificate;
}

// --- Linkages, in intervals ---

ArfInterval ValueOf(const Number<ArfInterval>& number) { return number.is_square ? Sqrt(number.value) : number.value; }

// Hulls keeps for each number of an answer the smallest interval that contains it in all answers included so far.
class Hulls {
 public:
  void Include(const Answer<ArfInterval>& answer) {
    regimes_.insert(answer.regime);
    hulls_.resize(answer.numbers.size());
    for (size_t i = 0; i < answer.numbers.size(); ++i) {
      const auto& [path, number] = answer.numbers[i];
      hulls_[i].first = path;
      if (!number.has_value()) continue;
      const ArfInterval value = ValueOf(*number);
      std::optional<ArfInterval>& hull = hulls_[i].second;
      hull = hull.has_value() ? Hull(*hull, value) : value;
    }
  }

  // Returns a set unless there is one regime and every number is narrow enough for its digits.
  Certificate Certify(int digits, slong bits) const {
    Certificate certificate = {.digits = digits,
                               .precision_bits = static_cast<int>(bits),
                               .regimes = {regimes_.begin(), regimes_.end()},
                               .is_set = regimes_.size() > 1};
    for (const auto& [path, hull] : hulls_) {
      if (!hull.has_value()) continue;
      const std::optional<CertifiedNumber> proved = certified::Certify(*hull, digits);
      if (!proved.has_value()) certificate.is_set = true;
      certificate.numbers.push_back(proved.has_value() ? *proved : CertifyRange(*hull, digits));
      certificate.numbers.back().path = path;
    }
    return certificate;
  }

 private:
  std::set<Regime> regimes_;
  std::vector<std::pair<std::string, std::optional<ArfInterval>>> hulls_;
};

// Returns nothing if a branch stays open or a number is too wide for its digits.
std::optional<Certificate> TryLinkage(Question question, const SystemContact<ArfInterval>& system, int digits,
                                      slong bits) {
  Branches branches;
  Hulls hulls;
  hulls.Include(AnswerTo(question, system, branches));
  if (branches.any_open()) return std::nullopt;
  Certificate certificate = hulls.Certify(digits, bits);
  if (certificate.is_set) return std::nullopt;
  return certificate;
}

// Follows every way that open branches allow, until `stopped`.
Certificate CertifyEveryBranch(Question question, const SystemContact<ArfInterval>& system, int digits, slong bits,
                               Stopped stopped) {
  Branches branches;
  Hulls hulls;
  do {
    hulls.Include(AnswerTo(question, system, branches));
  } while (!stopped() && branches.NextRun());
  return hulls.Certify(digits, bits);
}

absl::Status SingularLinkage() {
  return InvalidRequest(
      {MakeViolation("linkage.links", "have a mass matrix that is singular to the most bits of certified answers",
                     "be less unlike in mass and length")});
}

absl::StatusOr<Certificate> CertifyLinkage(Question question, const Scene& scene,
                                           const EffectiveCoefficients& effective, const CertifiedPrecision& precision,
                                           Stopped stopped) {
  const int digits = precision.digits;
  const slong most_bits = precision.most_bits;
  for (slong bits = std::min(2 * BitsOf(digits), most_bits); !stopped(); bits = std::min(2 * bits, most_bits)) {
    const std::optional<SystemContact<ArfInterval>> system = ReduceLinkage(scene, effective, bits, stopped);
    if (stopped()) break;
    std::optional<Certificate> certificate;
    if (system.has_value()) certificate = TryLinkage(question, *system, digits, bits);
    if (certificate.has_value()) return *certificate;
    if (bits < most_bits) continue;
    if (!system.has_value()) return SingularLinkage();
    certificate = CertifyEveryBranch(question, *system, digits, bits, stopped);
    if (!stopped()) return *certificate;
  }
  return absl::CancelledError("the certificate was stopped by its caller");
}

// --- Scenes ---

EffectiveCoefficients EffectiveOf(const Scene& scene) {
  if (!HasClosedForm(scene)) return CoefficientsAtSpeed(scene, ApproachSpeed(Reduce(scene)));
  const pendulum::Problem problem = ClosedFormProblem(scene);
  return {.kinetic_friction = problem.mu, .static_friction = problem.mu_static, .restitution = problem.coefficient};
}

absl::StatusOr<Certificate> CertifyScene(Question question, const Scene& scene, const CertifiedPrecision& precision,
                                         Stopped stopped) {
  FreeTablesWithThread();
  const EffectiveCoefficients effective = EffectiveOf(scene);
  if (std::holds_alternative<Linkage>(scene.system)) {
    return CertifyLinkage(question, scene, effective, precision, stopped);
  }
  const SystemContact<Surd> system = ReduceExactly(scene, effective);
  const std::optional<Violation> violation = CheckExactContact(scene, system.contact);
  if (violation.has_value()) return InvalidRequest({*violation});
  return CertifyExact(question, system, precision.digits);
}

bool HasParallelLinks(const Scene& scene) {
  const auto* const linkage = std::get_if<Linkage>(&scene.system);
  return linkage != nullptr && AreParallel(linkage->links);
}

}  // namespace

bool IsAvailable() { return true; }

}  // namespace certified

std::vector<Violation> CheckCertifiable(const Scene& scene, int digits) {
  std::vector<Violation> violations;
  const auto refuse = [&violations](bool is_wrong, const char* field, const char* found, const char* rule) {
    if (is_wrong) violations.push_back(MakeViolation(field, found, rule));
  };
  if (digits < 1 || digits > kMostCertifiedDigits) {
    violations.push_back(MakeViolation("certified_digits", digits,
                                       absl::StrCat("be 0 for none, or in [1, ", kMostCertifiedDigits, "]")));
  }
  refuse(TangentialDirections(scene.system) > 1, "system", "lies in space",
         "be a pendulum, planar bodies, a linkage or planar_contact for a certified answer");
  refuse(
      std::holds_alternative<Mechanism>(scene.system), "mechanism", "is stated",
      "not be for a certified answer, which takes a linkage, planar bodies or the W and velocity of a planar_contact");
  refuse(!std::holds_alternative<std::monostate>(scene.impact_law), "impact_law", "is set",
         "not be for a certified answer, which needs Coulomb friction and a coefficient of restitution");
  refuse(scene.compliance.has_value(), "compliance", "is set",
         "not be for a certified answer, which needs rigid contact");
  refuse(!std::holds_alternative<std::monostate>(scene.finite_forces), "finite_forces", "are set",
         "not be for a certified answer, whose impact takes no time");
  refuse(scene.surface_velocity.has_value() && certified::HasParallelLinks(scene), "surface_velocity", "is set",
         "not be for a certified answer about links that are all parallel");
  return violations;
}

absl::StatusOr<Certificate> CertifySolve(const Scene& scene, const CertifiedPrecision& precision,
                                         absl::FunctionRef<bool()> stopped) {
  return certified::CertifyScene(certified::Question::kSolve, scene, precision, stopped);
}

absl::StatusOr<Certificate> CertifyBounds(const Scene& scene, const CertifiedPrecision& precision,
                                          absl::FunctionRef<bool()> stopped) {
  return certified::CertifyScene(certified::Question::kBounds, scene, precision, stopped);
}

}  // namespace ricochet
