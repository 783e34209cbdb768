#include "client/cli/conformance/cases.h"

#include <nlohmann/json.hpp>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/nearest.h"

namespace ricochet::cli {

// Made of conformance/impacts.json by the build.
extern const absl::string_view kConformanceCases;

namespace {

using Eigen::VectorXd;
using Json = nlohmann::ordered_json;

VectorXd VectorOf(const Json& json) {
  const std::vector<double> numbers = json;
  return VectorXd::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

Eigen::MatrixXd MatrixOf(const Json& rows) {
  Eigen::MatrixXd matrix(rows.size(), rows[0].size());
  for (size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = VectorOf(rows[i]).transpose();
  return matrix;
}

ConformanceCase FromJson(const Json& json) {
  ConformanceCase one{
      .name = json["name"],
      .family = json["family"],
      .shows = json["shows"],
      .source = json["source"],
      .json = json.dump(2) + "\n",
      .summary =
          Json{{"name", json["name"]}, {"family", json["family"]}, {"shows", json["shows"]}, {"source", json["source"]}}
              .dump(),
      .dimension = json["dimension"],
      .friction = VectorXd(json["contacts"].size()),
      .coefficient = VectorXd(json["contacts"].size()),
      .coordinates = json["coordinates"],
      .mass = MatrixOf(json["mass_matrix"]),
      .jacobian = MatrixOf(json["jacobian"]),
      .before = VectorOf(json["velocity_before"]),
      .frame = VectorOf(json.value("frame_velocity", Json(std::vector<double>(json["velocity_before"].size())))),
      .symmetries = json.value("symmetries", std::vector<std::vector<int>>())};
  for (Eigen::Index i = 0; i < one.friction.size(); ++i) {
    const Json& contact = json["contacts"][static_cast<size_t>(i)];
    one.friction(i) = contact["friction"];
    one.coefficient(i) = contact["coefficient"];
  }
  for (const Json& answer : json["answers"]) {
    one.answers.push_back({.law = answer["law"],
                           .also = answer.value("also", std::vector<std::string>()),
                           .velocity_after = VectorOf(answer["velocity_after"])});
  }
  return one;
}

ConformanceCases ReadAll() {
  const Json document = Json::parse(kConformanceCases);
  ConformanceCases all{.version = document["version"], .fingerprint = document["fingerprint"]};
  for (const Json& json : document["cases"]) all.cases.push_back(FromJson(json));
  return all;
}

}  // namespace

const ConformanceCases& AllConformanceCases() {
  static const ConformanceCases* const all = new ConformanceCases(ReadAll());
  return *all;
}

absl::StatusOr<const ConformanceCase*> FindConformanceCase(const std::string& name, const std::string& what) {
  std::vector<std::string> names;
  for (const ConformanceCase& one : AllConformanceCases().cases) {
    if (one.name == name) return &one;
    names.push_back(one.name);
  }
  return absl::InvalidArgumentError(
      absl::StrCat(what, " = ", name, ": must be a name of `ricochet conformance list`", DidYouMean(name, names)));
}

std::string ConformanceCasesJson() { return std::string(kConformanceCases); }

}  // namespace ricochet::cli
