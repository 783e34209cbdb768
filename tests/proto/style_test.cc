// The style of the protos: names, zero values, types, and the unit of every number in its name. That each element has a
// comment is in documentation_test.cc.

#include <gmock/gmock.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "api_files.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;
using google::protobuf::ServiceDescriptor;
using testing::ElementsAre;
using testing::IsEmpty;

// Numbers without a unit, or with the unit of the field that they are about.
const std::set<std::string>& WithoutUnit() {
  static const std::set<std::string> names = {"allowance",
                                              "alpha",
                                              "chi2",
                                              "coefficients",
                                              "correlation",
                                              "cosine",
                                              "covariance",
                                              "difference",
                                              "distance",
                                              "e",
                                              "e_t",
                                              "energetic",
                                              "error",
                                              "excess",
                                              "exponent",
                                              "factor",
                                              "friction",
                                              "friction_ratio",
                                              "from",
                                              "from_above",
                                              "from_below",
                                              "high",
                                              "interval_rise",
                                              "jacobian",
                                              "jam",
                                              "kinetic",
                                              "kinetic_coefficient",
                                              "largest_excess",
                                              "least_tolerance",
                                              "limit",
                                              "loss_scale",
                                              "low",
                                              "lower",
                                              "mass_matrix",
                                              "modelling",
                                              "momentum_change",
                                              "most_tolerance",
                                              "mu_hat",
                                              "neglected",
                                              "newton",
                                              "newton_error",
                                              "normal",
                                              "numerical",
                                              "objective",
                                              "p_value",
                                              "poisson",
                                              "poisson_error",
                                              "predicted",
                                              "rates",
                                              "rates_after",
                                              "reference_error",
                                              "relative_error",
                                              "relative_stiffness",
                                              "relative_tolerance",
                                              "residual",
                                              "residuals",
                                              "restitution",
                                              "reversal",
                                              "rise",
                                              "rounding_error",
                                              "row_shares",
                                              "sigma",
                                              "size",
                                              "slope_ratio",
                                              "start",
                                              "static",
                                              "static_coefficient",
                                              "stick",
                                              "stiffness",
                                              "stop",
                                              "stop_compression",
                                              "tangential",
                                              "tangential_error",
                                              "tangential_ratio_squared",
                                              "to",
                                              "tolerance",
                                              "total",
                                              "upper",
                                              "value",
                                              "values",
                                              "velocity",
                                              "velocity_error",
                                              "x",
                                              "y"};
  return names;
}

// True if a message of type `outer` may hold one of type `inner`, at any depth.
bool Holds(const Descriptor& outer, const Descriptor& inner, std::set<const Descriptor*>& seen) {
  for (int i = 0; i < outer.field_count(); ++i) {
    const Descriptor* const type = outer.field(i)->message_type();
    if (type == &inner) return true;
    if (type != nullptr && seen.insert(type).second && Holds(*type, inner, seen)) return true;
  }
  return false;
}

class Lint {
 public:
  void Check(const FileDescriptor& file) {
    for (int i = 0; i < file.message_type_count(); ++i) Check(*file.message_type(i));
    for (int i = 0; i < file.enum_type_count(); ++i) Check(*file.enum_type(i));
    for (int i = 0; i < file.service_count(); ++i) Check(*file.service(i));
  }

  const std::vector<std::string>& faults() const { return faults_; }

 private:
  void Check(const Descriptor& message) {
    Match(message.full_name(), message.name(), "([A-Z][a-z0-9]*)+");
    // The server reads a request as deep as its types go (proto/wire/message_content.h).
    std::set<const Descriptor*> seen;
    if (Holds(message, message, seen)) faults_.push_back(message.full_name() + " must not contain itself");
    for (int i = 0; i < message.field_count(); ++i) Check(*message.field(i));
    for (int i = 0; i < message.nested_type_count(); ++i) Check(*message.nested_type(i));
    for (int i = 0; i < message.enum_type_count(); ++i) Check(*message.enum_type(i));
  }

  void Check(const FieldDescriptor& field) {
    Match(field.full_name(), field.name(), "[a-z][a-z0-9]*(_[a-z0-9]+)*");
    switch (field.type()) {
      case FieldDescriptor::TYPE_DOUBLE:
        if (WithoutUnit().count(field.name()) > 0) return;
        return Match(field.full_name(), field.name(),
                     ".*_(m|s|kg|n|j|rad|rad_s|m_s2?|kg_m2|n_s|n_m(1_5|_p)?|s_m|per_kg)");
      case FieldDescriptor::TYPE_BOOL:
      case FieldDescriptor::TYPE_ENUM:
      case FieldDescriptor::TYPE_INT32:
      case FieldDescriptor::TYPE_INT64:
      case FieldDescriptor::TYPE_STRING:
        return;
      case FieldDescriptor::TYPE_MESSAGE:
        // Maps and the types of protobuf itself have a JSON of their own, which proto/text/json_errors.h does not know.
        if (!field.is_map() && field.message_type()->file()->package() == field.file()->package()) return;
        faults_.push_back(absl::StrCat(field.full_name(), " is a ", field.message_type()->full_name(),
                                       ": must be a message of the service"));
        return;
      case FieldDescriptor::TYPE_BYTES:
        // Columns that foreign clients read at the speed of memory.
        return Match(field.full_name(), field.name(), "inputs|outputs|regimes|statuses|values");
      default:
        faults_.push_back(absl::StrCat(field.full_name(), " is a ", field.type_name(),
                                       ": must be double, bool, string, a signed integer, an enum or a message"));
    }
  }

  // SweepRequest.Combination and Regime have the prefixes COMBINATION_ and REGIME_.
  void Check(const EnumDescriptor& type) {
    Match(type.full_name(), type.name(), "([A-Z][a-z0-9]*)+");
    std::string prefix;
    for (const char c : type.name()) {
      if (c >= 'A' && c <= 'Z' && !prefix.empty()) prefix += '_';
      prefix += static_cast<char>(c >= 'a' ? c - 'a' + 'A' : c);
    }
    for (int i = 0; i < type.value_count(); ++i) {
      Match(type.value(i)->full_name(), type.value(i)->name(), prefix + "(_[A-Z0-9]+)+");
    }
    const auto* zero = type.FindValueByNumber(0);
    Match(type.full_name(), zero == nullptr ? "" : zero->name(), prefix + "_UNSPECIFIED");
  }

  void Check(const ServiceDescriptor& service) {
    for (int i = 0; i < service.method_count(); ++i) {
      const auto& method = *service.method(i);
      // A stream of batches has the messages of a single one.
      const std::string stem = method.name() == "SolveBatches" ? "SolveBatch" : method.name();
      Match(method.full_name(), method.input_type()->name(), stem + "Request");
      Match(method.full_name(), method.output_type()->name(), stem + "Response");
    }
  }

  void Match(const std::string& element, const std::string& name, const std::string& rule) {
    if (std::regex_match(name, std::regex(rule))) return;
    faults_.push_back(absl::StrCat(element, ": \"", name, "\" must match ", rule));
  }

  std::vector<std::string> faults_;
};

std::vector<std::string> FaultsOf(const FileDescriptorSet& files) {
  DescriptorPool pool;
  Lint lint;
  for (const FileDescriptor* file : Build(files, pool)) lint.Check(*file);
  return lint.faults();
}

TEST(ProtoStyleTest, HasNoFault) { EXPECT_THAT(FaultsOf(ProtosWithComments()), IsEmpty()); }

TEST(ProtoStyleTest, SeesEachKindOfFault) {
  FileDescriptorSet files;
  FileDescriptorProto& file = *files.add_file();
  file.set_name("a.proto");
  file.set_syntax("proto3");
  auto& message = *file.add_message_type();
  message.set_name("Bad_name");
  const auto add = [&message](const char* name, google::protobuf::FieldDescriptorProto::Type type) {
    auto& field = *message.add_field();
    field.set_name(name);
    field.set_number(message.field_size());
    field.set_type(type);
  };
  add("camelCase", google::protobuf::FieldDescriptorProto::TYPE_STRING);
  add("length", google::protobuf::FieldDescriptorProto::TYPE_DOUBLE);
  add("count", google::protobuf::FieldDescriptorProto::TYPE_UINT32);
  auto& kind = *file.add_enum_type();
  kind.set_name("Kind");
  kind.add_value()->set_name("NONE");
  const std::vector<std::string> faults = FaultsOf(files);
  EXPECT_THAT(faults, ElementsAre(testing::StartsWith("Bad_name: "), testing::StartsWith("Bad_name.camelCase: "),
                                  testing::StartsWith("Bad_name.length: "), testing::StartsWith("Bad_name.count is"),
                                  testing::StartsWith("NONE: "), testing::StartsWith("Kind: ")));
}

TEST(ProtoStyleTest, SeesAMessageThatContainsItself) {
  FileDescriptorSet files;
  FileDescriptorProto& file = *files.add_file();
  file.set_name("a.proto");
  file.set_syntax("proto3");
  const char* const names[] = {"Outer", "Inner"};
  for (size_t i = 0; i < 2; ++i) {
    auto& message = *file.add_message_type();
    message.set_name(names[i]);
    auto& field = *message.add_field();
    field.set_name("other");
    field.set_number(1);
    field.set_type_name(names[1 - i]);
  }
  EXPECT_THAT(FaultsOf(files), ElementsAre("Outer must not contain itself", "Inner must not contain itself"));
}

}  // namespace
}  // namespace ricochet
