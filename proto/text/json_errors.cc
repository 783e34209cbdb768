#include "proto/text/json_errors.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "core/base/nearest.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::OneofDescriptor;

// Follows the parser through a text, with the field of the proto at hand.
class Checker : public nlohmann::json_sax<nlohmann::json> {
 public:
  // The parser reads the text from `buffer`.
  Checker(const std::string& text, const Descriptor& type, std::streambuf& buffer)
      : text_(text), root_(&type), buffer_(buffer) {}

  const std::string& error() const { return error_; }

  // Null means that a field is not set. One that is always set would silently become 0, such as the friction of a
  // program that writes null for NaN.
  bool null() override {
    const FieldDescriptor* field = Field();
    const bool is_entry = !levels_.empty() && levels_.back().is_list;
    if (field == nullptr || field->has_presence() || (field->is_repeated() && !is_entry)) return Next();
    return Fail(absl::StrCat(Path(), " = null: must have a value, or be left out"));
  }
  bool boolean(bool) override { return Value(FieldDescriptor::CPPTYPE_BOOL) && Next(); }
  bool number_integer(int64_t) override { return Number() && Next(); }
  bool number_unsigned(uint64_t) override { return Number() && Next(); }
  bool number_float(double value, const std::string& token) override {
    const FieldDescriptor* field = Field();
    const bool is_whole = field != nullptr && (field->cpp_type() == FieldDescriptor::CPPTYPE_INT32 ||
                                               field->cpp_type() == FieldDescriptor::CPPTYPE_INT64);
    if (is_whole && value != std::trunc(value)) {
      return Fail(absl::StrCat(Path(), " = ", token, ": must be a whole number"));
    }
    return FitsDouble(token) && Number() && Next();
  }
  bool string(std::string& words) override {
    const FieldDescriptor* field = Field();
    double number = 0.0;
    if (field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      // The parser of the protos takes a hexadecimal number, which no other input does.
      if (!absl::SimpleAtod(words, &number) || words.find_first_of("xX") != std::string::npos) {
        return Fail(absl::StrCat(Path(), " = \"", words, "\": must be a number"));
      }
      if (!FitsDouble(words)) return false;
    }
    return Value(FieldDescriptor::CPPTYPE_STRING) && Next();
  }
  bool binary(nlohmann::json::binary_t&) override { return true; }

  bool start_object(size_t) override {
    if (levels_.empty()) {
      levels_.push_back({.type = root_});
      return true;
    }
    const FieldDescriptor* field = Field();
    if (!Value(FieldDescriptor::CPPTYPE_MESSAGE)) return false;
    return Descend({.type = field == nullptr ? nullptr : field->message_type()});
  }
  bool end_object() override { return Leave(); }
  bool start_array(size_t) override {
    if (levels_.empty()) return FailForNoObject();
    const FieldDescriptor* field = Field();
    // The parser of the protos would take the entries of a list in a list for entries of the outer one.
    const bool is_in_list = levels_.back().is_list;
    if (field != nullptr && (is_in_list || !field->is_repeated())) {
      return Fail(absl::StrCat(Path(), ": must not be a list"));
    }
    return Descend({.list = field, .is_list = true});
  }
  bool end_array() override { return Leave(); }

  bool key(std::string& name) override {
    Level& level = levels_.back();
    level.name = name;
    level.field = nullptr;
    for (int i = 0; level.type != nullptr && i < level.type->field_count(); ++i) {
      const FieldDescriptor* field = level.type->field(i);
      if (name == field->name() || name == field->json_name()) level.field = field;
    }
    if (level.type != nullptr && level.field == nullptr) {
      return Fail(absl::StrCat(Path(), ": is no field of ", level.type->name(), FieldHint(*level.type, name)));
    }
    const auto [before, is_first] = level.given.emplace(level.field == nullptr ? name : level.field->name(), name);
    if (is_first) return true;
    return Fail(
        absl::StrCat(Path(), ": is given twice", before->second == name ? "" : ", before as " + before->second));
  }

  bool parse_error(size_t /*position*/, const std::string& token, const nlohmann::json::exception& exception) override {
    if (constexpr int kOverflow = 406; exception.id == kOverflow) return FitsDouble(token);
    const absl::string_view what = exception.what();
    const size_t place = what.find("line ");
    error_ = std::string(place == absl::string_view::npos ? what : what.substr(place));
    return false;
  }

 private:
  struct Level {
    const Descriptor* type = nullptr;       // The message; null if it is not known.
    const FieldDescriptor* list = nullptr;  // The field of a list.
    bool is_list = false;
    size_t entries = 0;  // So many entries of a list precede the one at hand.
    const FieldDescriptor* field = nullptr;
    std::string name = {};
    std::map<std::string, std::string> given = {};  // How each field that was given before is spelled, by its name.
    std::map<const OneofDescriptor*, std::string> chosen = {};
  };

  bool Descend(Level level) {
    constexpr size_t kMostLevels = 100;  // Protobuf's own parsers take as many.
    if (levels_.size() >= kMostLevels) return Fail(absl::StrCat("must not nest more than ", kMostLevels, " levels"));
    levels_.push_back(std::move(level));
    return true;
  }

  // The field whose value is at hand; null if it is not known.
  const FieldDescriptor* Field() const {
    if (levels_.empty()) return nullptr;
    return levels_.back().is_list ? levels_.back().list : levels_.back().field;
  }

  std::string Path() const {
    std::string path;
    for (const Level& level : levels_) {
      if (level.is_list) {
        absl::StrAppend(&path, "[", level.entries, "]");
      } else {
        absl::StrAppend(&path, path.empty() ? "" : ".", level.name);
      }
    }
    return path;
  }

  // Appends the place that the parser has reached.
  bool Fail(const std::string& message) {
    const std::string before = text_.substr(0, static_cast<size_t>(buffer_.pubseekoff(0, std::ios::cur, std::ios::in)));
    const size_t start = before.rfind('\n');
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t column = start == std::string::npos ? before.size() : before.size() - start - 1;
    error_ = absl::StrCat("line ", line, ", column ", column, ": ", message);
    return false;
  }

  bool FitsDouble(const std::string& token) {
    const std::string rule = WhyNoDouble(token);
    return rule.empty() || Fail(absl::StrCat(Path(), " = ", token, ": must ", rule));
  }

  bool Number() {
    const FieldDescriptor* field = Field();
    if (field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
      return Fail(absl::StrCat(Path(), ": must be true or false"));
    }
    return Value(FieldDescriptor::CPPTYPE_DOUBLE);
  }

  bool FailForNoObject() {
    if (root_->field_count() == 0) return Fail("must be an object: {}");
    return Fail(absl::StrCat("must be an object: {\"", root_->field(0)->name(), "\": ..., ...}"));
  }

  // Takes note of a value of the kind that JSON has. A field that is a choice may be chosen once.
  bool Value(FieldDescriptor::CppType kind) {
    if (levels_.empty()) return FailForNoObject();
    Level& level = levels_.back();
    const FieldDescriptor* field = Field();
    if (field == nullptr) return true;
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && kind != FieldDescriptor::CPPTYPE_MESSAGE) {
      return Fail(absl::StrCat(Path(), ": must be an object {...} with the fields of ", field->message_type()->name()));
    }
    const bool is_number = field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
    if (is_number && (kind == FieldDescriptor::CPPTYPE_MESSAGE || kind == FieldDescriptor::CPPTYPE_BOOL)) {
      return Fail(absl::StrCat(Path(), ": must be a number"));
    }
    if (level.is_list) return true;
    if (field->is_repeated()) return Fail(absl::StrCat(Path(), ": must be a list [...]"));
    const OneofDescriptor* choice = field->real_containing_oneof();
    if (choice == nullptr) return true;
    const auto [other, is_first] = level.chosen.emplace(choice, field->name());
    if (is_first) return true;
    return Fail(absl::StrCat(Path(), ": cannot be given beside ", other->second, ": there is one ",
                             absl::StrReplaceAll(choice->name(), {{"_", " "}}), " only"));
  }

  bool Leave() {
    levels_.pop_back();
    return Next();
  }

  // Goes on after a value.
  bool Next() {
    if (!levels_.empty() && levels_.back().is_list) ++levels_.back().entries;
    return true;
  }

  const std::string& text_;
  const Descriptor* root_;
  std::streambuf& buffer_;
  std::vector<Level> levels_;
  std::string error_;
};

}  // namespace

std::string WhyNoDouble(absl::string_view decimal) {
  double value = 0.0;
  absl::ConsumePrefix(&decimal, "+");
  const auto [end, error] = std::from_chars(decimal.data(), decimal.data() + decimal.size(), value);
  if (error != std::errc::result_out_of_range) return "";
  return "be 0, or a number of a size from 4.95e-324 to 1.7976931348623157e+308";
}

std::string FieldHint(const Descriptor& type, const std::string& name) {
  std::vector<std::string> known;
  for (int i = 0; i < type.field_count(); ++i) known.push_back(type.field(i)->name());
  const std::string nearest = DidYouMean(name, known);
  return nearest.empty() ? absl::StrCat("; its fields are ", absl::StrJoin(known, ", ")) : nearest;
}

std::string ExplainJson(const std::string& text, const Descriptor& type) {
  std::istringstream stream(text);
  Checker checker(text, type, *stream.rdbuf());
  nlohmann::json::sax_parse(stream, &checker);
  return checker.error();
}

}  // namespace ricochet
