#include "client/cli/text/field_table.h"

#include <google/protobuf/descriptor.h>

#include <array>
#include <map>

#include "absl/algorithm/container.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "core/base/derivative_name.h"
#include "proto/comments/commented_protos.h"

namespace ricochet::cli {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

struct Unit {
  const char* ending;
  const char* text;
};

// Fields whose ending means something else than in other names: "n_m" are newtons per metre, newton metres, or metres
// along n.
constexpr std::array kUnitsByName = {
    Unit{"LinearSpring.stiffness_n_m", "N/m"},
    Unit{"PinMoment.moment_n_m", "N m"},
    Unit{"HuntCrossleySpring.damping_s_m", "s/m"},
    Unit{"PowerLaw.alpha", "1/(m/s)^exponent"},
};

// A longer ending stands before the shorter ones that it ends in, so that it is found first.
constexpr std::array kUnitsByEnding = {
    Unit{"_n_m1_5", "N/m^1.5"},
    Unit{"_n_m_p", "N/m^p"},
    Unit{"_per_kg", "1/kg"},
    Unit{"_kg_m2", "kg m²"},
    Unit{"_rad_s", "rad/s"},
    Unit{"_m_s2", "m/s²"},
    Unit{"_m_s", "m/s"},
    Unit{"_n_s", "N s"},
    Unit{"_rad", "rad"},
    Unit{"_kg", "kg"},
    Unit{"_m", "m"},
    Unit{"_s", "s"},
    Unit{"_j", "J"},
    Unit{"_n", "N"},
};

// The numbers of a mechanism in its generalised coordinates.
constexpr std::array<absl::string_view, 5> kInCoordinates = {"jacobian", "mass_matrix", "momentum_change", "rates",
                                                             "rates_after"};

// Returns the first sentence of a comment, without its unit.
std::string MeaningOf(const std::string& comment, const std::string& unit) {
  absl::string_view sentence = absl::string_view(comment).substr(0, comment.find(". "));
  absl::ConsumeSuffix(&sentence, ".");
  if (unit.empty()) return std::string(sentence);
  const std::string spelled = absl::StrCat(", ", unit);
  for (const char* after : {":", ","}) {
    const size_t at = sentence.find(spelled + after);
    if (at == absl::string_view::npos) continue;
    return absl::StrCat(sentence.substr(0, at), sentence.substr(at + spelled.size()));
  }
  absl::ConsumeSuffix(&sentence, spelled);
  return std::string(sentence);
}

FieldInfo InfoOf(const std::string& path, const FieldDescriptor& field) {
  FieldInfo info{.path = path, .unit = UnitOf(field), .meaning = "", .range = "", .comment = CommentOf(field)};
  info.meaning = MeaningOf(info.comment, info.unit);
  info.range = RangeOf(info.comment);
  return info;
}

void AddNumbers(const Descriptor& message, const std::string& prefix, std::vector<FieldInfo>& table) {
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    const std::string path = absl::StrCat(prefix, field.name());
    if (field.message_type() != nullptr) {
      AddNumbers(*field.message_type(), path + ".", table);
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      table.push_back(InfoOf(path, field));
    }
  }
}

std::vector<FieldInfo> NumbersOf(const char* message) {
  std::vector<FieldInfo> table;
  AddNumbers(*CommentedProtos().FindMessageTypeByName(message), "", table);
  return table;
}

std::string WithoutIndices(absl::string_view path) {
  std::string text;
  bool is_index = false;
  for (const char c : path) {
    is_index = c == '[' || (is_index && c != ']');
    if (!is_index && c != ']') text.push_back(c);
  }
  return text;
}

}  // namespace

std::string UnitOf(const FieldDescriptor& field) {
  for (const Unit& unit : kUnitsByName) {
    if (field.full_name() == absl::StrCat("ricochet.v1.", unit.ending)) return unit.text;
  }
  for (const Unit& unit : kUnitsByEnding) {
    if (absl::EndsWith(field.name(), unit.ending)) return unit.text;
  }
  return "";
}

// A range is a sentence of its own.
std::string RangeOf(const std::string& comment) {
  for (absl::string_view sentence : absl::StrSplit(comment, ". ")) {
    absl::ConsumeSuffix(&sentence, ".");
    const bool is_comparison = sentence == "> 0" || sentence == ">= 0";
    if (is_comparison || absl::StrContains(sentence, " <= value <= ") || absl::StartsWith(sentence, "In [") ||
        absl::StartsWith(sentence, "In (")) {
      return std::string(sentence);
    }
  }
  return "";
}

const std::vector<FieldInfo>& SceneFieldTable() {
  static const auto* const table = [] {
    auto* made = new std::vector<FieldInfo>(NumbersOf("ricochet.v1.Scene"));
    const std::string meaning = "phi = arctan(a/b), the angle of the contact seen from the pin";
    made->push_back({.path = "pendulum.phi_rad",
                     .unit = "rad",
                     .meaning = meaning,
                     .range = "In (0, pi)",
                     .comment = meaning + ", rad. It moves the contact at its distance from the pin. In (0, pi). Only "
                                          "an axis or a range can drive it."});
    return made;
  }();
  return *table;
}

const std::vector<FieldInfo>& OutcomeFieldTable() {
  static const auto* const table = new std::vector<FieldInfo>(NumbersOf("ricochet.v1.Outcome"));
  return *table;
}

const FieldInfo* FindFieldInfo(absl::string_view path) {
  static const auto* const by_path = [] {
    auto* made = new std::map<std::string, const FieldInfo*>();
    for (const auto* table : {&SceneFieldTable(), &OutcomeFieldTable()}) {
      for (const FieldInfo& info : *table) made->emplace(info.path, &info);
    }
    return made;
  }();
  const auto found = by_path->find(WithoutIndices(path));
  return found == by_path->end() ? nullptr : found->second;
}

std::string UnitOfPath(const std::string& path) {
  if (const auto derivative = ReadDerivativeName(path)) {
    const std::string of = UnitOfPath(derivative->of), by = UnitOfPath(derivative->by);
    const auto grouped = [](const std::string& unit) {
      return absl::StrContains(unit, '/') || absl::StrContains(unit, ' ') ? absl::StrCat("(", unit, ")") : unit;
    };
    return by.empty() ? of : absl::StrCat(of.empty() ? "1" : grouped(of), "/", grouped(by));
  }
  const FieldInfo* const info = FindFieldInfo(path);
  return info == nullptr ? "" : info->unit;
}

std::string MeaningOfPath(const std::string& path) {
  if (const auto derivative = ReadDerivativeName(path)) {
    return absl::StrCat("derivative of ", derivative->of, " by ", derivative->by);
  }
  const FieldInfo* const info = FindFieldInfo(path);
  return info == nullptr ? "" : info->meaning;
}

bool IsInCoordinates(const std::string& path) {
  if (const auto derivative = ReadDerivativeName(path))
    return IsInCoordinates(derivative->of) || IsInCoordinates(derivative->by);
  const std::string name = WithoutIndices(path);
  const absl::string_view last = absl::string_view(name).substr(name.rfind('.') + 1);
  return FindFieldInfo(path) != nullptr && absl::c_linear_search(kInCoordinates, last);
}

std::string WithoutUnit(const std::string& path) {
  const FieldInfo* info = FindFieldInfo(path);
  if (info == nullptr || info->unit.empty()) return path;
  const std::string ending = absl::StrCat(
      "_",
      absl::StrReplaceAll(absl::AsciiStrToLower(info->unit), {{"1/", "per_"}, {"/", "_"}, {" ", "_"}, {"²", "2"}}));
  const size_t index = absl::EndsWith(path, "]") ? path.rfind('[') : path.size();
  absl::string_view stem(path.data(), index);
  absl::ConsumeSuffix(&stem, ending);
  return absl::StrCat(stem, path.substr(index));
}

}  // namespace ricochet::cli
