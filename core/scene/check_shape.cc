#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/base/decimal.h"
#include "core/contact/delassus.h"
#include "core/contact/reduction.h"
#include "core/contact/symmetric_matrix.h"
#include "core/scene/check.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The largest principal moment may exceed the sum of the other two by this share of the sum of all three, so that
// tensors of plates and rods that were rounded to single precision are accepted.
constexpr double kMomentRounding = 1e-6;

std::string ListText(const std::vector<double>& values) {
  return absl::StrCat("[", absl::StrJoin(values, ", ", [](std::string* out, double x) { *out += ShortestDecimal(x); }),
                      "]");
}

Violation MatrixViolation(const std::string& field, const std::vector<double>& upper, const char* rule) {
  return MakeViolation(field, absl::StrCat("= ", ListText(upper)), absl::StrCat("be ", rule), ViolationKind::kValue,
                       EntriesOf(field, upper.size()));
}

// The smallest eigenvalue of the matrix, scaled to a unit diagonal, must exceed `least`. Returns whether it does.
bool CheckMatrix(const std::string& field, const std::vector<double>& upper, double least, const char* rule,
                 Check& check) {
  if (!check.Length(field, upper.size(), 6) || !AllFinite(upper)) return false;
  const bool holds = IsSurelyDefinite(upper) || SmallestScaledEigenvalue(Symmetric(upper.data())) > least;
  check.Require(holds, [&] { return MatrixViolation(field, upper, rule); });
  return holds;
}

void CheckOne(std::monostate /*unset*/, Check& check) {
  check.RequireSet(
      false, "system",
      "be one of pendulum, planar_body, spatial_body, body_pair, linkage, planar_contact, spatial_contact, mechanism");
}

void CheckOne(const Pendulum& /*pendulum*/, Check& /*check*/) {}
void CheckOne(const PlanarBody& /*body*/, Check& /*check*/) {}

void CheckBody(const SpatialBody& body, const std::string& prefix, Check& check) {
  CheckInertia(prefix + ".inertia_com_kg_m2", body.inertia_com_kg_m2, check);
  check.Length(prefix + ".offset_m", body.offset_m.size(), 3);
  check.Length(prefix + ".linear_m_s", body.linear_m_s.size(), 3);
  check.Length(prefix + ".angular_rad_s", body.angular_rad_s.size(), 3);
}

void CheckOne(const SpatialBody& body, Check& check) { CheckBody(body, "spatial_body", check); }

void CheckOne(const BodyPair& pair, Check& check) {
  check.RequireSet(!std::holds_alternative<std::monostate>(pair.bodies), "body_pair.bodies",
                   "be one of planar, spatial");
  if (const auto* spatial = std::get_if<SpatialPair>(&pair.bodies)) {
    CheckBody(spatial->body_1, "body_pair.spatial.body_1", check);
    CheckBody(spatial->body_2, "body_pair.spatial.body_2", check);
  }
}

void CheckOne(const Linkage& linkage, Check& check) {
  check.Require(!linkage.links.empty(),
                [] { return MakeViolation("linkage.links", "has 0 entries", "have at least one"); });
}

void CheckOne(const PlanarContact& contact, Check& check) {
  const double tt = contact.w_tt_per_kg;
  const double nn = contact.w_nn_per_kg;
  const double tn = contact.w_tn_per_kg;
  if (!Holds(tt, NumberRule::kNotNegative) || !std::isfinite(tn) || !Holds(nn, NumberRule::kNotNegative)) return;
  check.Require(PlanarDelassus{tt, tn, nn}.IsSemidefinite(), [&] {
    return MakeViolation("planar_contact.w_tn_per_kg", tn,
                         absl::StrCat("leave W positive semidefinite: w_tn^2 <= w_tt w_nn = ", ShortestDecimal(tt),
                                      " * ", ShortestDecimal(nn)),
                         {"planar_contact.w_tt_per_kg", "planar_contact.w_nn_per_kg"});
  });
}

void CheckOne(const SpatialContact& contact, Check& check) {
  CheckMatrix("spatial_contact.w_per_kg", contact.w_per_kg, -16.0 * kEpsilon, "positive semidefinite", check);
  check.Length("spatial_contact.tangential_m_s", contact.tangential_m_s.size(), 2);
}

void CheckOne(const Mechanism& mechanism, Check& check) { CheckMechanism(mechanism, 1, check); }

}  // namespace

// A body's tensor is positive definite, and none of its principal moments exceeds the sum of the other two.
void CheckInertia(const std::string& field, const std::vector<double>& upper, Check& check) {
  if (!CheckMatrix(field, upper, 16.0 * kEpsilon, "positive definite", check)) return;
  check.Require(LargestMomentShare(Symmetric(upper.data())) <= 0.5 + 0.5 * kMomentRounding, [&] {
    return MatrixViolation(field, upper,
                           "that of a body: its largest principal moment is at most the sum of the other two");
  });
}

void CheckShape(const System& system, Check& check) {
  std::visit([&check](const auto& one) { CheckOne(one, check); }, system);
}

}  // namespace ricochet
