#include "core/scene/validate_multi.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/contact/mechanism.h"
#include "core/contact/symmetric_matrix.h"
#include "core/scene/check.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "core/types/multi_contact.h"

namespace ricochet {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// The largest stiffness of a range may be at most this many times the smallest.
constexpr double kMostStiffnessRatio = 1e12;
// Larger coefficients could make the forces of coupled contacts exceed the range of doubles.
constexpr double kMostFriction = 1e9;

std::string Entry(const char* list, size_t index, const char* field) {
  return absl::StrCat(list, "[", index, "]", *field == '\0' ? "" : ".", field);
}

template <typename Part>
void CheckNumbers(const Part& part, const char* prefix, int entry, Check& check) {
  const auto visit = [&check](const NumberPath& path, double value, NumberRule rule) {
    check.Number(path, value, rule);
  };
  numbers::VisitPart(part, prefix, visit, entry);
}

// --- The system ---

void CheckBody(const FreeBody& body, size_t index, int directions, Check& check) {
  const auto name = [&](const char* field) { return Entry("free_bodies.bodies", index, field); };
  CheckNumbers(body, "free_bodies.bodies", static_cast<int>(index), check);
  const size_t turns = directions == 2 ? 1 : 3;
  const auto space = static_cast<size_t>(directions);
  check.Length(name("position_m"), body.position_m.size(), space);
  if (!body.linear_m_s.empty()) check.Length(name("linear_m_s"), body.linear_m_s.size(), space);
  if (!body.angular_rad_s.empty()) check.Length(name("angular_rad_s"), body.angular_rad_s.size(), turns);
  const std::vector<double>& inertia = body.inertia_com_kg_m2;
  if (!check.Length(name("inertia_com_kg_m2"), inertia.size(), directions == 2 ? 1 : 6)) return;
  if (!AllFinite(inertia)) return;
  if (directions == 2) {
    check.Number(NumberPath{"free_bodies.bodies", static_cast<int>(index), "inertia_com_kg_m2", 0}, inertia[0],
                 NumberRule::kPositive);
    return;
  }
  CheckInertia(name("inertia_com_kg_m2"), inertia, check);
}

void CheckSystem(const std::monostate& /*unset*/, const MultiContactScene& /*scene*/, Check& check) {
  check.RequireSet(false, "system", "be one of contact_matrix, free_bodies, mechanism");
}

void CheckSystem(const ContactMatrix& matrix, const MultiContactScene& scene, Check& check) {
  CheckNumbers(matrix, "contact_matrix", -1, check);
  const size_t contacts = scene.contacts.size();
  const size_t rows = matrix.velocity_m_s.size();
  const bool fits = contacts > 0 && (rows == 2 * contacts || rows == 3 * contacts);
  check.Require(contacts == 0 || fits, [&] {
    return MakeViolation("contact_matrix.velocity_m_s", absl::StrCat("has ", Counted(rows, "entry")),
                         absl::StrCat("have 2 or 3 for each of the contacts, ", 2 * contacts, " or ", 3 * contacts));
  });
  if (fits) check.Length("contact_matrix.w_per_kg", matrix.w_per_kg.size(), rows * rows);
}

void CheckSystem(const FreeBodies& free, const MultiContactScene& scene, Check& check) {
  check.Require(!free.bodies.empty(),
                [] { return MakeViolation("free_bodies.bodies", "has 0 entries", "have at least one"); });
  if (free.bodies.empty()) return;
  const int directions = DirectionsOf(scene);
  check.Require(directions != 0, [&] {
    return MakeViolation("free_bodies.bodies[0].position_m",
                         absl::StrCat("has ", Counted(free.bodies.front().position_m.size(), "entry")),
                         "have 2 in a plane or 3 in space");
  });
  for (size_t i = 0; directions != 0 && i < free.bodies.size(); ++i) CheckBody(free.bodies[i], i, directions, check);
}

void CheckSystem(const Mechanism& mechanism, const MultiContactScene& scene, Check& check) {
  CheckNumbers(mechanism, "mechanism", -1, check);
  CheckMechanism(mechanism, std::max<size_t>(scene.contacts.size(), 1), check);
}

// --- Contacts ---

// Checks the number of a body or a contact.
void CheckOrdinal(const std::string& field, int32_t number, int32_t least, size_t most, Check& check) {
  check.Require(number >= least && number <= static_cast<int64_t>(most), [&] {
    return MakeViolation(field, absl::StrCat("= ", number), absl::StrCat("be in [", least, ", ", most, "]"));
  });
}

// Checks the fields that a contact of bodies must state and a contact of another system must leave out.
void CheckPlace(const MultiContactScene& scene, size_t index, Check& check) {
  const MultiContactPoint& contact = scene.contacts[index];
  const auto name = [&](const char* field) { return Entry("contacts", index, field); };
  const auto* const free = std::get_if<FreeBodies>(&scene.system);
  if (free == nullptr) {
    const bool is_empty =
        contact.body == 0 && contact.other_body == 0 && contact.point_m.empty() && contact.normal.empty();
    check.Require(is_empty || std::holds_alternative<std::monostate>(scene.system), [&] {
      return MakeViolation(name(""), "has a body, a point or a normal", "have none, the system states no bodies");
    });
    return;
  }
  CheckOrdinal(name("body"), contact.body, 1, free->bodies.size(), check);
  CheckOrdinal(name("other_body"), contact.other_body, 0, free->bodies.size(), check);
  check.Require(contact.body != contact.other_body || contact.body == 0, [&] {
    return MakeViolation(name("other_body"), absl::StrCat("= ", contact.other_body), "be another than body");
  });
  const auto directions = static_cast<size_t>(DirectionsOf(scene));
  if (directions == 0) return;
  check.Length(name("point_m"), contact.point_m.size(), directions);
  if (!check.Length(name("normal"), contact.normal.size(), directions)) return;
  check.Require(std::any_of(contact.normal.begin(), contact.normal.end(), [](double x) { return x != 0.0; }),
                [&] { return MakeViolation(name("normal"), "is 0", "have a direction"); });
}

void CheckContacts(const MultiContactScene& scene, Check& check) {
  const size_t count = scene.contacts.size();
  check.Require(count >= 1 && count <= static_cast<size_t>(kMostContacts), [&] {
    return MakeViolation("contacts", absl::StrCat("has ", Counted(count, "entry")),
                         absl::StrCat("have 1 to ", kMostContacts));
  });
  for (size_t i = 0; i < count && !check.IsFull(); ++i) {
    CheckNumbers(scene.contacts[i], "contacts", static_cast<int>(i), check);
    check.Require(!(scene.contacts[i].friction > kMostFriction), [&] {
      return MakeViolation(Entry("contacts", i, "friction"), scene.contacts[i].friction,
                           absl::StrCat("be at most ", ShortestDecimal(kMostFriction)));
    });
    check.Require(scene.contacts[i].energetic.has_value(),
                  [&] { return MakeViolation(Entry("contacts", i, "energetic"), "is not set", "be in [0, 1]"); });
    CheckPlace(scene, i, check);
  }
}

// --- The matrix ---

void CheckMatrix(const ContactMatrix& matrix, const MultiReduction& reduction, Check& check) {
  const auto rows = static_cast<size_t>(reduction.w.rows());
  const double rounding = LeastEigenvalue(rows);
  for (size_t i = 0; i < rows; ++i) {
    const double own = matrix.w_per_kg[i * rows + i];
    check.Require(own >= 0.0, [&] {
      return MakeViolation(Entry("contact_matrix.w_per_kg", i * rows + i, ""), own,
                           "be >= 0, as it is on the diagonal");
    });
  }
  if (check.failed()) return;
  const auto w = [&](size_t i, size_t j) { return matrix.w_per_kg[i * rows + j]; };
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = 0; j < i; ++j) {
      const double scale = std::sqrt(std::abs(w(i, i))) * std::sqrt(std::abs(w(j, j)));
      check.Require(std::abs(w(i, j) - w(j, i)) <= rounding * std::max(scale, std::abs(w(j, i))), [&] {
        return MakeViolation(Entry("contact_matrix.w_per_kg", i * rows + j, ""), w(i, j),
                             absl::StrCat("be that of its transpose, ", ShortestDecimal(w(j, i)),
                                          "; take (W + W^T)/2 if they differ by rounding"));
      });
    }
  }
  if (check.failed()) return;
  const double least = SmallestScaledEigenvalue(reduction.w);
  check.Require(least >= -rounding, [&] {
    return MakeViolation("contact_matrix.w_per_kg",
                         absl::StrCat("has the eigenvalue ", ShortestDecimal(least), ", scaled to a unit diagonal"),
                         "be positive semidefinite");
  });
}

void CheckSpread(const MultiReduction& reduction, Check& check) {
  const Eigen::VectorXd diagonal = reduction.w.diagonal();
  const double largest = diagonal.maxCoeff();
  for (Eigen::Index row = 0; row < diagonal.size(); ++row) {
    const auto field = [&] { return Entry("contacts", static_cast<size_t>(row / reduction.directions), ""); };
    RequireShareOfW(diagonal(row), largest, field, check);
  }
}

// The velocities of bodies and mechanisms lie in the range of their W, up to what rounding makes of W where masses
// differ much. Bounds of possible outcomes allow for that much. Beyond it W has lost the larger masses.
void CheckRange(const std::string& field, const MultiContactScene& scene, const MultiReduction& reduction,
                const Eigen::VectorXd& velocity, Check& check) {
  const bool is_stated = std::holds_alternative<ContactMatrix>(scene.system);
  const auto* const mechanism = std::get_if<Mechanism>(&scene.system);
  const double most = is_stated ? 64.0 * static_cast<double>(reduction.w.rows()) * kEpsilon : 0x1p-20;
  const Eigen::VectorXd sizes = reduction.jacobian.cwiseAbs() * velocity.cwiseAbs();
  const double outside = DistanceFromRange(reduction.w, reduction.ContactVelocity(velocity), sizes);
  check.Require(outside <= most, [&] {
    const bool has_held = mechanism != nullptr && HoldsCoordinates(*mechanism);
    const std::string share = std::isfinite(outside) ? absl::StrCat("a share of ", ShortestDecimal(outside)) : "a part";
    return MakeViolation(field, absl::StrCat("has ", share, " beside the range of W"),
                         absl::StrCat("lie in it, no impulse changes the rest",
                                      is_stated  ? "; M and J keep what the rounding of W loses"
                                      : has_held ? "; held coordinates that move press contacts apart or together: "
                                                   "hold fewer, or state their rates as 0"
                                                 : ""));
  });
}

// Names the field that a scene states its velocity with.
struct VelocityField {
  std::string operator()(std::monostate) const { return "system"; }
  std::string operator()(const ContactMatrix& /*matrix*/) const { return "contact_matrix.velocity_m_s"; }
  std::string operator()(const FreeBodies& /*free*/) const { return "free_bodies.bodies"; }
  std::string operator()(const Mechanism& /*mechanism*/) const { return "mechanism.rates"; }
};

// --- The rest of the request ---

void CheckMethods(const MultiContactRequest& request, int directions, Check& check) {
  const auto contacts = static_cast<int>(request.scene.contacts.size());
  for (size_t i = 0; i < request.methods.size(); ++i) {
    const MultiContactMethod method = request.methods[i];
    const std::string why_not = WhyNot(method, directions, contacts);
    check.Require(why_not.empty(), [&] {
      return Violation{Entry("methods", i, ""), absl::StrCat("= ", NameOf(method), ": ", why_not)};
    });
  }
  if (!request.stiffness_range.has_value()) return;
  const bool takes_springs =
      request.methods.empty() ||
      std::find(request.methods.begin(), request.methods.end(), MultiContactMethod::kSprings) != request.methods.end();
  check.Require(takes_springs,
                [] { return MakeViolation("stiffness_range", "is set", "be absent without the method springs"); });
  const StiffnessRange& range = *request.stiffness_range;
  const std::string why_not = WhyNot(MultiContactMethod::kSprings, directions, contacts);
  check.Require(why_not.empty(), [&] { return Violation{"stiffness_range", "is set: " + why_not}; });
  CheckOrdinal("stiffness_range.contact", range.contact, 1, request.scene.contacts.size(), check);
  check.Number(NumberPath{"stiffness_range", -1, "low"}, range.low, NumberRule::kPositive);
  check.Number(NumberPath{"stiffness_range", -1, "high"}, range.high, NumberRule::kPositive);
  check.Require(!(range.low > 0.0 && range.high > 0.0) ||
                    (range.high > range.low && range.high / range.low <= kMostStiffnessRatio),
                [&] {
                  return MakeViolation(
                      "stiffness_range.high", range.high,
                      absl::StrCat("be above low and at most ", ShortestDecimal(kMostStiffnessRatio), " times it"),
                      {"stiffness_range.low"});
                });
}

// Returns whether the list keeps the rules.
bool CheckList(const std::string& field, const std::vector<double>& list, size_t size, Check& check) {
  if (!check.Length(field, list.size(), size)) return false;
  for (size_t i = 0; i < size; ++i) {
    check.Require(std::isfinite(list[i]),
                  [&] { return MakeViolation(absl::StrCat(field, "[", i, "]"), list[i], "be finite"); });
  }
  return AllFinite(list);
}

// Checks lists that have one number for each velocity of the system.
void CheckLists(const MultiContactRequest& request, const MultiReduction& reduction, Check& check) {
  const auto size = static_cast<size_t>(reduction.velocity.size());
  for (size_t i = 0; i < request.states.size() && !check.IsFull(); ++i) {
    if (!CheckList(Entry("states", i, "velocity"), request.states[i].velocity, size, check)) continue;
    const Eigen::Map<const Eigen::VectorXd> velocity(request.states[i].velocity.data(), reduction.velocity.size());
    CheckRange(Entry("states", i, "velocity"), request.scene, reduction, velocity, check);
  }
  const int directions = reduction.directions;
  std::set<std::string> names;
  for (const std::string& name : ContactOutputNames(request.scene.contacts.size(), directions)) names.insert(name);
  for (const std::string& name : SystemOutputNames(request.scene.system, directions)) names.insert(name);
  for (size_t i = 0; i < request.outputs.size() && !check.IsFull(); ++i) {
    CheckList(Entry("outputs", i, "coefficients"), request.outputs[i].coefficients, size, check);
    const std::string& name = request.outputs[i].name;
    check.Require(!name.empty(), [&] { return MakeViolation(Entry("outputs", i, "name"), "is empty", "not be"); });
    check.Require(names.insert(name).second,
                  [&] { return MakeViolation(Entry("outputs", i, "name"), Found(name), "not name another output"); });
  }
}

}  // namespace

const char* NameOf(MultiContactMethod method) {
  static constexpr const char* kNames[] = {"unspecified", "orders", "springs", "possible"};
  static_assert(std::size(kNames) == kMultiContactMethods.size() + 1);
  const auto number = static_cast<size_t>(method);
  return number < std::size(kNames) ? kNames[number] : kNames[0];
}

std::string WhyNot(MultiContactMethod method, int directions, int contacts) {
  const auto& all = kMultiContactMethods;
  if (std::find(all.begin(), all.end(), method) == all.end()) return "must be orders, springs or possible";
  if (method == MultiContactMethod::kOrders && contacts > kMostContactsInOrders) {
    return absl::StrCat("orders are searched for at most ", kMostContactsInOrders, " contacts");
  }
  if (method == MultiContactMethod::kSprings && directions == 3) return "springs are computed in a plane only";
  return "";
}

std::vector<Violation> Validate(const MultiContactRequest& request, std::optional<MultiReduction>& reduction) {
  reduction.reset();
  Check check(Check::Mode::kListing);
  const MultiContactScene& scene = request.scene;
  std::visit([&](const auto& system) { CheckSystem(system, scene, check); }, scene.system);
  CheckContacts(scene, check);
  CheckMethods(request, DirectionsOf(scene), check);
  if (check.failed()) return std::move(check).violations();
  reduction = Reduce(scene);
  if (reduction->w.allFinite() && reduction->response.allFinite()) {
    const auto* const matrix = std::get_if<ContactMatrix>(&scene.system);
    if (matrix != nullptr) CheckMatrix(*matrix, *reduction, check);
    CheckSpread(*reduction, check);
    if (!check.failed()) {
      CheckRange(std::visit(VelocityField(), scene.system), scene, *reduction, reduction->velocity, check);
    }
  }
  if (reduction->w.allFinite()) CheckLists(request, *reduction, check);
  return std::move(check).violations();
}

}  // namespace ricochet
