#include "client/cli/sweep/sweep_head.h"

#include "absl/strings/str_cat.h"
#include "client/cli/text/field_table.h"
#include "client/cli/text/json_text.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/engine.h"
#include "proto/wire/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet::cli {
namespace {

std::string MeaningOfColumn(const std::string& path) {
  if (path == "index") return "number of the point in the grid";
  if (path == "row") return "number of the row, from 0";
  if (path == "regime") return "how the contact behaved";
  if (path == "status") return "OK, INADMISSIBLE, or why there are no numbers";
  return MeaningOfPath(path);
}

// The axis as ricochet.v1.Axis has it, and its unit.
std::string AxisJson(const v1::Axis& axis) {
  std::string json = JsonOf(axis);
  json.pop_back();
  return absl::StrCat(json, ",", JsonMember("unit", UnitOfPath(axis.path())), "}");
}

}  // namespace

std::string ColumnsJson(const std::vector<std::string>& names) {
  std::string json = "[";
  for (const std::string& name : names) {
    absl::StrAppend(&json, json.back() == '[' ? "" : ",", "{", JsonMember("name", name), ",",
                    JsonMember("unit", UnitOfPath(name)), ",", JsonMember("meaning", MeaningOfColumn(name)), "}");
  }
  return json + "]";
}

std::string SweepHeadJson(const SweepRequest& request, const std::vector<std::string>& names,
                          const EngineInfo& engine) {
  const v1::SweepRequest proto = ToProto(request);
  std::string json = absl::StrCat(
      "{\"engine\":", JsonOf(ToProto(engine)), ",", JsonMember("grid_fingerprint", GridFingerprint(request)), ",",
      JsonMember("combination", v1::SweepRequest::Combination_Name(proto.combination())), ",\"axes\":[");
  for (const v1::Axis& axis : proto.axes()) {
    absl::StrAppend(&json, json.back() == '[' ? "" : ",", AxisJson(axis));
  }
  return absl::StrCat(json, "],\"columns\":", ColumnsJson(names), ",\"values\":");
}

}  // namespace ricochet::cli
