#include "client/cli/report/scene_schema.h"

#include <google/protobuf/descriptor.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/text/field_table.h"
#include "proto/comments/commented_protos.h"

namespace ricochet::cli {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::OneofDescriptor;
using Json = nlohmann::ordered_json;

// Adds the range that a comment states: "> 0", ">= 0", "A <= value <= B" or "In [A, B]".
void AddRange(const std::string& range, Json& schema) {
  static const std::regex interval(R"((?:In \[)?([-0-9.e]+)(?: <= value <= |, )([-0-9.e]+)\]?)");
  std::smatch ends;
  if (range == "> 0") {
    schema["exclusiveMinimum"] = 0;
  } else if (range == ">= 0") {
    schema["minimum"] = 0;
  } else if (std::regex_match(range, ends, interval)) {
    schema["minimum"] = Json::parse(ends[1].str());
    schema["maximum"] = Json::parse(ends[2].str());
  }
}

// Adds the length of a list: "2 entries in a plane, 3 in space", "3 entries", "11, 12, 13, 22, 23, 33", "one entry in a
// plane, two in space", "At least one".
void AddLength(const std::string& comment, Json& schema) {
  static const std::regex by_space("([0-9]) entr(?:y|ies) in a plane, ([0-9]) in space");
  static const std::regex fixed("([0-9]) entries");
  std::smatch length;
  if (std::regex_search(comment, length, by_space)) {
    schema["minItems"] = std::stoi(length[1].str());
    schema["maxItems"] = std::stoi(length[2].str());
  } else if (std::regex_search(comment, length, fixed)) {
    schema["minItems"] = schema["maxItems"] = std::stoi(length[1].str());
  } else if (absl::StrContains(comment, "11, 12, 13, 22, 23, 33")) {
    schema["minItems"] = schema["maxItems"] = 6;
  } else if (absl::StrContains(comment, "one entry in a plane, two in space")) {
    schema["minItems"] = 1;
    schema["maxItems"] = 2;
  } else if (absl::StrContains(comment, "At least one.")) {
    schema["minItems"] = 1;
  }
}

std::string Reference(const Descriptor& message) { return absl::StrCat("#/$defs/", message.name()); }

Json ValueSchema(const FieldDescriptor& field, const std::string& comment) {
  if (field.message_type() != nullptr) return {{"$ref", Reference(*field.message_type())}};
  const bool is_flag = field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL;
  const bool is_whole = field.cpp_type() == FieldDescriptor::CPPTYPE_INT32;
  Json schema = {{"type", is_flag ? "boolean" : is_whole ? "integer" : "number"}};
  if (!UnitOf(field).empty()) schema["unit"] = UnitOf(field);
  AddRange(RangeOf(comment), schema);
  return schema;
}

// A matrix as a list of its rows (proto/text/json_matrices.h).
Json RowsSchema() { return {{"type", "array"}, {"items", {{"type", "array"}, {"items", {{"type", "number"}}}}}}; }

bool IsMatrix(const FieldDescriptor& field) {
  return field.name() == "mass_matrix" || field.name() == "jacobian" || field.name() == "w_per_kg";
}

Json FieldSchema(const FieldDescriptor& field) {
  const std::string comment = CommentOf(field);
  Json schema = {{"description", comment}};
  if (field.is_repeated()) {
    Json list = {{"type", "array"}};
    AddLength(comment, list);
    list["items"] = ValueSchema(field, comment);
    if (IsMatrix(field)) {
      schema["anyOf"] = {list, RowsSchema()};
    } else {
      schema.update(list);
    }
  } else {
    schema.update(ValueSchema(field, comment));
  }
  return schema;
}

// Exactly one of the fields must be there, or at most one.
Json ChoiceSchema(const OneofDescriptor& choice) {
  Json one_of = Json::array();
  for (int i = 0; i < choice.field_count(); ++i) one_of.push_back({{"required", {choice.field(i)->name()}}});
  const std::string comment = CommentOf(choice);
  if (!absl::EndsWith(comment, "Required.")) one_of.push_back({{"not", {{"anyOf", one_of}}}});
  return {{"description", comment}, {"oneOf", one_of}};
}

Json MessageSchema(const Descriptor& message) {
  Json schema = {{"type", "object"}, {"description", CommentOf(message)}};
  Json required = Json::array();
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    schema["properties"][field.name()] = FieldSchema(field);
    const bool is_alone = field.real_containing_oneof() == nullptr;
    if (is_alone && absl::EndsWith(CommentOf(field), "Required.")) required.push_back(field.name());
  }
  if (message.name() == "PlanarContact") {
    schema["properties"]["w_per_kg"] = RowsSchema();
    schema["properties"]["w_per_kg"]["description"] = "W, 2 x 2 with rows t and n, in place of its entries, 1/kg.";
  }
  schema["additionalProperties"] = false;
  if (!required.empty()) schema["required"] = required;
  for (int i = 0; i < message.real_oneof_decl_count(); ++i) {
    schema["allOf"].push_back(ChoiceSchema(*message.oneof_decl(i)));
  }
  return schema;
}

// Adds the definitions of a message and of all that it holds.
void AddDefinitions(const Descriptor& message, Json& definitions) {
  if (definitions.contains(message.name())) return;
  definitions[message.name()] = MessageSchema(message);
  for (int i = 0; i < message.field_count(); ++i) {
    const Descriptor* part = message.field(i)->message_type();
    if (part != nullptr) AddDefinitions(*part, definitions);
  }
}

}  // namespace

static std::string SchemaOf(const char* message, const char* title) {
  const Descriptor& scene = *CommentedProtos().FindMessageTypeByName(message);
  Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}, {"$ref", Reference(scene)}};
  AddDefinitions(scene, schema["$defs"]);
  return schema.dump(2) + "\n";
}

std::string SceneSchema() { return SchemaOf("ricochet.v1.Scene", "A scene of Ricochet. Units are SI and radians."); }

std::string MultiContactSceneSchema() {
  return SchemaOf("ricochet.v1.MultiContactScene", "Several contacts at once, of Ricochet. Units are SI and radians.");
}

}  // namespace ricochet::cli
