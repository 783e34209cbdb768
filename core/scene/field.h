// Field: a number of a scene that an axis can drive, by its path. A field is resolved once for a scene, then set once
// for each point. DrivenFields: those that a request drives together.
//
// Paths are spelled as in the proto: "friction.kinetic_coefficient", "linkage.links[1].theta_rad",
// "spatial_contact.w_per_kg[3]"; core/scene/numbers.h lists them. A scene has the fields of its own system and lists.
// In addition an axis may drive friction.static_coefficient, each definition of restitution, and surface_velocity, even
// if the scene states none. One field is derived: pendulum.phi_rad is the paper's angle phi = arctan(a/b) (Fig. 4) at
// the base scene's distance R = sqrt(a^2 + b^2) from the pin, so that a = R sin(phi) and b = R cos(phi). An entry of
// mechanism.mass_matrix beside the diagonal drives the one across it, too, so that the matrix stays symmetric.

#ifndef RICOCHET_CORE_SCENE_FIELD_H_
#define RICOCHET_CORE_SCENE_FIELD_H_

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/scene/numbers.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// The path that may state a pendulum's angle, in place of a and b.
inline constexpr char kPhi[] = "pendulum.phi_rad";
// Returns why this field must not have the value, if it must not: checking the scene checks only what it drives.
std::optional<Violation> WhyNoPhi(double value);

// A Field sets one number of the scene for which it was resolved. That scene must outlive the field and keep its
// system, law and lists.
class Field {
 public:
  // Sets the field and returns whether each number that it has set keeps its own rule.
  bool Set(double value) const;

  // The number that the field sets; phi_rad has none.
  double value() const { return *std::get<Scalar>(driver_).number; }

  // The rule of the number that the field sets. phi_rad, which sets two, must lie in (0, pi): elsewhere the
  // contact is behind the pin.
  NumberRule rule() const;

  // The paths of the numbers that the field sets: one, or two for phi_rad and for an entry of a mechanism's mass matrix
  // beside the diagonal.
  const std::vector<std::string>& sets() const { return sets_; }

 private:
  friend absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene);

  struct Scalar {
    double* number;
    NumberRule rule;
    double* mirror = nullptr;  // The entry across the diagonal of a symmetric matrix, which is set to the same value.
    bool Set(double value) const {
      *number = value;
      if (mirror != nullptr) *mirror = value;
      return Holds(value, rule);
    }
  };
  struct Phi {
    Scalar a, b;
    double distance;
  };
  // Lets an entry of the mass matrix set the one across the diagonal, too, and adds its path to `sets`.
  static void SetMirror(Mechanism& mechanism, Scalar& entry, std::vector<std::string>& sets);
  static std::optional<Scalar> Find(const std::string& path, Scene& scene);
  Field(std::variant<Scalar, Phi> driver, std::vector<std::string> sets) : driver_(driver), sets_(std::move(sets)) {}

  std::variant<Scalar, Phi> driver_;
  std::vector<std::string> sets_;
};

// Resolves the field at `path`. A restitution path switches the scene to that definition; a static_coefficient or
// surface_velocity path adds it to the scene.
// It takes time proportional to the numbers of the scene.
// Errors: an unknown path, or one of another system, gets INVALID_ARGUMENT with a message that says how to list the
// right ones and names the nearest of them. The scene is then as it was.
absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene);

// Begins the description of a violation by a text of the caller: "= \"TEXT\"". It is escaped, and cut if it is long.
std::string Found(const std::string& text);

// Every path that an axis may drive in the scene. Of two entries of a mass matrix across the diagonal it has the upper
// one.
std::vector<std::string> FieldPaths(const Scene& scene);

// The paths of all fields: those above, and the lower entries of a mass matrix.
std::vector<std::string> AllFieldPaths(const Scene& scene);

// The fields of one scene that a sweep sets for each point, or a batch for each row.
class DrivenFields {
 public:
  // The request's name of its i-th driver: "axes[1]" or "fields[1]".
  using NameOf = absl::FunctionRef<std::string(size_t i)>;

  // Resolves each path in `scene`, which must outlive this object and keep its system, law and lists. `member` follows
  // the driver's name in the place of a violation: ".path" or nothing.
  DrivenFields(const std::vector<std::string>& paths, NameOf name_of, const char* member, Scene& scene);

  // The drivers whose path names no field of the scene, or one that another driver drives.
  const std::vector<Violation>& violations() const { return violations_; }

  // True if driving a field can cure this violation of the base scene.
  bool CanBeCured(const Violation& violation) const;

  // The fields of the drivers in their order, if there is no violation.
  size_t size() const { return fields_.size(); }
  const Field& operator[](size_t i) const { return fields_[i]; }

 private:
  std::vector<Field> fields_;
  std::vector<Violation> violations_;
  std::set<std::string> driven_;  // Paths of the numbers that are set whatever their base value.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_FIELD_H_
