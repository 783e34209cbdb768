// Field table: the unit and the meaning of every number of a scene and of an outcome, as the comments of the protos
// state them.

#ifndef RICOCHET_CLIENT_CLI_TEXT_FIELD_TABLE_H_
#define RICOCHET_CLIENT_CLI_TEXT_FIELD_TABLE_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace google::protobuf {
class FieldDescriptor;
}

namespace ricochet::cli {

struct FieldInfo {
  std::string path;     // Axes and columns spell it so, without indices: "linkage.links.theta_rad".
  std::string unit;     // "rad/s", "kg m²", "N/m"; empty for a pure number.
  std::string meaning;  // The first sentence of the comment, without its unit: "k, stiffness".
  std::string range;    // The range as the comment states it: "> 0", "0 <= value <= 1"; empty for any finite number.
  std::string comment;  // The whole comment on one line, with range and default.
};

// Returns every number of ricochet.v1.Scene in the order of the proto, and pendulum.phi_rad, which an axis can drive.
const std::vector<FieldInfo>& SceneFieldTable();

// Returns every number of ricochet.v1.Outcome in the order of the proto. The columns of a sweep are among them.
const std::vector<FieldInfo>& OutcomeFieldTable();

// Returns what is known of a number of a scene or an outcome, for a path with or without indices, such as
// "linkage.links[1].theta_rad". Returns null if there is no such number.
const FieldInfo* FindFieldInfo(absl::string_view path);

// Returns the unit of a number of a scene or an outcome, or of a column that is a derivative: "(m/s)/kg". It is empty
// for a pure number and for an unknown path.
std::string UnitOfPath(const std::string& path);

// Returns what such a number is, in a few words: "k, stiffness"; empty for an unknown path.
std::string MeaningOfPath(const std::string& path);

// Returns true for a number of a mechanism in its generalised coordinates, whose units only the caller knows, and for a
// derivative of it or by it.
bool IsInCoordinates(const std::string& path);

// Returns a path without the unit in its name: "pendulum.a" for "pendulum.a_m", "rates_after[0]" for
// "rates_after_rad_s[0]".
std::string WithoutUnit(const std::string& path);

// Returns the range that the comment of a number states, or an empty text.
std::string RangeOf(const std::string& comment);

// Returns the unit of a field of any message of ricochet.v1; empty for a pure number.
std::string UnitOf(const google::protobuf::FieldDescriptor& field);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_FIELD_TABLE_H_
