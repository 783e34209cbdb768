#include "core/certified/certified.h"

#include <flint/flint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "core/certified/answers.h"
#include "core/certified/digits.h"
#include "core/certified/system.h"
#include "core/contact/effective.h"
#include "core/contact/reduction.h"
#include "core/numerics/elementary.h"
#include "core/problem/scene_problem.h"

namespace ricochet {
namespace certified {
namespace {

enum class Asked { kSolve, kBounds };

template <typename N>
Answer<N> AnswerTo(Asked asked, const SystemContact<N>& system, Branches& branches) {
  return asked == Asked::kSolve ? AnswerSolve(system, branches) : AnswerBounds(system, branches);
}

// FLINT keeps numbers and tables for each thread, which nothing else frees when the thread ends.
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
    return Violation{"planar_contact.w_tn_per_kg",
                     "makes det W < 0: must leave it >= 0 exactly, not to rounding, with certified_digits"};
  }
  const bool in_range = contact.wnn.Sign() > 0 && (contact.u0 * contact.wnn - contact.v0 * contact.wtn).Sign() == 0;
  if (contact.det.Sign() > 0 || in_range) return std::nullopt;
  return Violation{scene.surface_velocity.has_value() ? "surface_velocity" : "planar_contact.tangential_m_s",
                   "makes (u0, v0) lie beside the range of W, whose rank is one: must lie in it exactly, not to "
                   "rounding, with certified_digits"};
}

Certificate CertifyExact(Asked asked, const SystemContact<Surd>& system, int digits) {
  Branches branches;
  const Answer<Surd> answer = AnswerTo(asked, system, branches);
  Certificate certificate = {
      .digits = digits, .precision_bits = static_cast<int>(BitsOf(digits)), .regimes = {answer.regime}};
  for (const NamedNumber<Surd>& named : answer.numbers) {
    if (!named.number.has_value()) continue;
    CertifiedNumber& number = certificate.numbers.emplace_back(Certify(*named.number, digits));
    number.path = named.path;
  }
  return certificate;
}

// --- Intervals ---

ArfInterval ValueOf(const Number<ArfInterval>& number) { return number.is_square ? Sqrt(number.value) : number.value; }

// The hull of answers.
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

  // Includes every answer that open branches allow.
  void IncludeAll(Asked asked, const SystemContact<ArfInterval>& system) {
    Branches branches;
    Include(AnswerTo(asked, system, branches));
    while (branches.NextRun()) Include(AnswerTo(asked, system, branches));
  }

  bool empty() const { return regimes_.empty(); }

  // As a set unless there is one regime and every number is narrow enough for its digits.
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

// Without open branches, or nothing.
std::optional<Certificate> TryLinkage(Asked asked, const SystemContact<ArfInterval>& system, int digits, slong bits) {
  Branches branches;
  Hulls hulls;
  hulls.Include(AnswerTo(asked, system, branches));
  if (branches.any_open()) return std::nullopt;
  Certificate certificate = hulls.Certify(digits, bits);
  if (certificate.is_set) return std::nullopt;
  return certificate;
}

absl::StatusOr<Certificate> CertifyLinkage(Asked asked, const Scene& scene, const EffectiveCoefficients& effective,
                                           int digits, slong most_bits) {
  for (slong bits = std::min(2 * BitsOf(digits), most_bits);; bits = std::min(2 * bits, most_bits)) {
    const std::optional<SystemContact<ArfInterval>> system = ReduceLinkage(scene, effective, bits);
    if (system.has_value()) {
      const std::optional<Certificate> certificate = TryLinkage(asked, *system, digits, bits);
      if (certificate.has_value()) return *certificate;
    }
    if (bits < most_bits) continue;
    if (!system.has_value()) {
      return InvalidRequest({{"linkage.links",
                              "have a mass matrix that is singular to the most bits of certified "
                              "answers: must be less unlike in mass and length"}});
    }
    Hulls hulls;
    hulls.IncludeAll(asked, *system);
    return hulls.Certify(digits, bits);
  }
}

// --- Sets ---

template <size_t kCount>
using Box = std::array<Range, kCount>;

// Parts the ranges of `box` that are no single numbers and calls visit(part) for each combination of parts.
template <size_t kCount, typename Visitor>
void VisitParts(const Box<kCount>& box, const Visitor& visit) {
  std::vector<size_t> uncertain;
  for (size_t i = 0; i < kCount; ++i) {
    if (box[i].lower < box[i].upper) uncertain.push_back(i);
  }
  const double parts_exactly = Pow(kMostSetBoxes, 1.0 / static_cast<double>(uncertain.size()));
  const auto parts = static_cast<int>(std::floor(parts_exactly + 1e-9));
  const auto end = [&](const Range& range, int part) {
    if (part == 0 || part == parts) return part == 0 ? range.lower : range.upper;
    return std::lerp(range.lower, range.upper, static_cast<double>(part) / parts);
  };
  std::vector<int> index(uncertain.size(), 0);
  for (;;) {
    Box<kCount> part = box;
    for (size_t k = 0; k < uncertain.size(); ++k) {
      const Range& whole = box[uncertain[k]];
      part[uncertain[k]] = {end(whole, index[k]), end(whole, index[k] + 1)};
    }
    visit(part);
    size_t k = 0;
    while (k < index.size() && ++index[k] == parts) index[k++] = 0;
    if (k == index.size()) return;
  }
}

template <size_t kCount>
bool IsPoint(const Box<kCount>& box) {
  return std::all_of(box.begin(), box.end(), [](const Range& range) { return range.lower == range.upper; });
}

template <typename N>
N Make(const Range& range, slong bits);
template <>
Surd Make<Surd>(const Range& range, slong /*bits*/) {
  return range.lower;
}
template <>
ArfInterval Make<ArfInterval>(const Range& range, slong bits) {
  return {Arf(range.lower), Arf(range.upper), bits};
}

constexpr size_t kSetNumbers = 8;
using SetBox = Box<kSetNumbers>;

SetBox BoxOf(const PendulumSet& set) {
  return {set.inertia, set.a, set.b, set.omega_minus, set.mu, set.mu_static, set.coefficient, Range()};
}

SetBox BoxOf(const ContactSet& set) {
  return {set.wtt, set.wtn, set.wnn, set.u0, set.v0, set.mu, set.mu_static, set.coefficient};
}

// Nothing if no part of the box is a contact.
template <typename N>
std::optional<SystemContact<N>> SystemOf(const PendulumSet& set, const SetBox& box, slong bits) {
  const auto number = [&](size_t i) { return Make<N>(box[i], bits); };
  SystemContact<N> system = ReducePendulum<N>(number(0), number(1), number(2), number(3));
  system.contact.mu = number(4);
  system.contact.mu_static = number(5);
  system.contact.law = set.law;
  system.contact.coefficient = number(6);
  return system;
}

bool CanBeNegativeOnly(const Surd& /*det*/) { return false; }
bool CanBeNegativeOnly(const ArfInterval& det) { return det.upper().Sign() < 0; }

template <typename N>
std::optional<SystemContact<N>> SystemOf(const ContactSet& set, const SetBox& box, slong bits) {
  const auto number = [&](size_t i) { return Make<N>(box[i], bits); };
  SystemContact<N> system;
  Contact<N>& contact = system.contact;
  contact.wtt = number(0);
  contact.wtn = number(1);
  contact.wnn = number(2);
  contact.u0 = number(3);
  contact.v0 = number(4);
  contact.mu = number(5);
  contact.mu_static = number(6);
  contact.law = set.law;
  contact.coefficient = number(7);
  contact.det = contact.wtt * contact.wnn - Square(contact.wtn);
  if (CanBeNegativeOnly(contact.det)) return std::nullopt;
  // A contact without mobility along n does not approach.
  if (box[2].upper > 0.0) contact.rho = contact.wtn / contact.wnn;
  return system;
}

template <typename Set>
absl::StatusOr<Certificate> CertifySet(Asked asked, const Set& set, int digits) {
  FreeTablesWithThread();
  const SetBox box = BoxOf(set);
  const slong bits = BitsOf(digits);
  if (IsPoint(box)) {
    const SystemContact<Surd> system = *SystemOf<Surd>(set, box, bits);
    const std::optional<Violation> violation = CheckExactContact(Scene(), system.contact);
    if (violation.has_value()) return InvalidRequest({*violation});
    return CertifyExact(asked, system, digits);
  }
  Hulls hulls;
  VisitParts(box, [&](const SetBox& part) {
    const std::optional<SystemContact<ArfInterval>> system = SystemOf<ArfInterval>(set, part, bits);
    if (system.has_value()) hulls.IncludeAll(asked, *system);
  });
  if (hulls.empty()) {
    return InvalidRequest({{"planar_contact", "has no W with det W >= 0 in the set: must have one"}});
  }
  Certificate certificate = hulls.Certify(digits, bits);
  certificate.is_set = true;
  return certificate;
}

// --- Scenes ---

EffectiveCoefficients EffectiveOf(const Scene& scene) {
  if (!HasClosedForm(scene)) return EffectiveAt(scene, ApproachSpeed(Reduce(scene)));
  const pendulum::Problem problem = ClosedFormProblem(scene);
  return {.kinetic_friction = problem.mu, .static_friction = problem.mu_static, .restitution = problem.coefficient};
}

absl::StatusOr<Certificate> CertifyScene(Asked asked, const Scene& scene, int digits, int most_bits) {
  FreeTablesWithThread();
  const EffectiveCoefficients effective = EffectiveOf(scene);
  if (std::holds_alternative<Linkage>(scene.system)) {
    return CertifyLinkage(asked, scene, effective, digits, most_bits);
  }
  const SystemContact<Surd> system = ReduceExactly(scene, effective);
  const std::optional<Violation> violation = CheckExactContact(scene, system.contact);
  if (violation.has_value()) return InvalidRequest({*violation});
  return CertifyExact(asked, system, digits);
}

bool HasParallelLinks(const Scene& scene) {
  const auto* const linkage = std::get_if<Linkage>(&scene.system);
  return linkage != nullptr && std::all_of(linkage->links.begin(), linkage->links.end(), [&](const Link& link) {
           return link.theta_rad == linkage->links.front().theta_rad;
         });
}

}  // namespace
}  // namespace certified

std::vector<Violation> CheckCertifiable(const Scene& scene, int digits) {
  std::vector<Violation> violations;
  const auto refuse = [&violations](bool is_wrong, const char* field, const char* description) {
    if (is_wrong) violations.push_back({field, description});
  };
  if (digits < 1 || digits > kMostCertifiedDigits) {
    violations.push_back(MakeViolation("certified_digits", digits, "be in [1, 1000]"));
  }
  refuse(TangentialDirections(scene.system) > 1, "system",
         "is in space: certified answers are for a pendulum, planar bodies, a linkage or planar_contact");
  refuse(!std::holds_alternative<std::monostate>(scene.impact_law), "impact_law",
         "is set: certified answers are for Coulomb friction and a coefficient of restitution");
  refuse(scene.compliance.has_value(), "compliance", "is set: certified answers are for rigid contact");
  refuse(!std::holds_alternative<std::monostate>(scene.finite_forces), "finite_forces",
         "are set: certified answers are for impacts that take no time");
  refuse(scene.surface_velocity.has_value() && certified::HasParallelLinks(scene), "surface_velocity",
         "is set: certified answers for links that are all parallel are for a surface at rest");
  return violations;
}

absl::StatusOr<Certificate> CertifySolve(const Scene& scene, int digits, int most_bits) {
  return certified::CertifyScene(certified::Asked::kSolve, scene, digits, most_bits);
}
absl::StatusOr<Certificate> CertifyBounds(const Scene& scene, int digits, int most_bits) {
  return certified::CertifyScene(certified::Asked::kBounds, scene, digits, most_bits);
}
absl::StatusOr<Certificate> CertifySolve(const PendulumSet& set, int digits) {
  return certified::CertifySet(certified::Asked::kSolve, set, digits);
}
absl::StatusOr<Certificate> CertifySolve(const ContactSet& set, int digits) {
  return certified::CertifySet(certified::Asked::kSolve, set, digits);
}
absl::StatusOr<Certificate> CertifyBounds(const PendulumSet& set, int digits) {
  return certified::CertifySet(certified::Asked::kBounds, set, digits);
}
absl::StatusOr<Certificate> CertifyBounds(const ContactSet& set, int digits) {
  return certified::CertifySet(certified::Asked::kBounds, set, digits);
}

}  // namespace ricochet
