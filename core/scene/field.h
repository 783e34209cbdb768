// Fields: what an axis can drive, by path. A field is resolved once for a scene, then set once a point.
//
// Fields are spelled as in the proto: "friction.kinetic_coefficient", "linkage.links[1].theta_rad",
// "spatial_contact.w_per_kg[3]"; core/scene/numbers.h knows them all. Which there are depends on the scene: its system,
// its lists. Beyond those that the scene states, an axis may drive friction.static_coefficient, each definition of
// restitution, and surface_velocity, which it makes present.
// Derived: pendulum.phi_rad, the paper's angle phi = arctan(a/b) (Fig. 4) at the base scene's distance
// R = sqrt(a^2 + b^2) from the pin: a = R sin(phi), b = R cos(phi).

#ifndef RICOCHET_CORE_SCENE_FIELD_H_
#define RICOCHET_CORE_SCENE_FIELD_H_

#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "core/scene/numbers.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets one field of the scene it was resolved for; that scene must outlive it and keep its system, law and lists.
class Field {
 public:
  // Returns whether what it has set keeps the rule that each number has by itself.
  bool Set(double value) const;

  // The paths of the scene's own fields that it sets: one, or for phi_rad two.
  const std::vector<std::string>& sets() const { return sets_; }

 private:
  friend absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene);

  struct Scalar {
    double* number;
    NumberRule rule;
    bool Set(double value) const {
      *number = value;
      return Holds(value, rule);
    }
  };
  struct Phi {
    Scalar a, b;
    double distance;
  };
  static Scalar Find(const std::string& path, Scene& scene);
  Field(std::variant<Scalar, Phi> driver, std::vector<std::string> sets) : driver_(driver), sets_(std::move(sets)) {}

  std::variant<Scalar, Phi> driver_;
  std::vector<std::string> sets_;
};

// The field at `path`. A restitution path switches the scene to that definition; a static_coefficient or
// surface_velocity path makes it present.
// Errors: INVALID_ARGUMENT whose message says what would be right, for an unknown path or one of another system.
absl::StatusOr<Field> ResolveField(const std::string& path, Scene& scene);

// Every path that an axis may drive in the scene.
std::vector<std::string> FieldPaths(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_FIELD_H_
