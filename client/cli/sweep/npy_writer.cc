#include <bit>
#include <cstdint>
#include <memory>

#include "absl/strings/str_cat.h"
#include "client/cli/sweep/sweep_writer.h"
#include "client/cli/text/axis_cursor.h"

namespace ricochet::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they lie in memory");

// The header and the bytes before it fill a multiple of this.
constexpr size_t kAlignment = 64;

template <typename Number>
void AppendBytes(Number number, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

// Paths of fields have no quotes and no backslashes.
std::string Field(const std::string& name, const char* type) { return absl::StrCat("('", name, "', '", type, "'), "); }

std::string Header(const SweepRequest& request, int64_t points) {
  std::string fields = Field("index", "<i8");
  for (const Axis& axis : request.grid.axes) fields += Field(axis.path, "<f8");
  for (const std::string& column : request.columns) fields += Field(column, "<f8");
  if (request.with_regime) absl::StrAppend(&fields, Field("regime", "|u1"), Field("status", "|u1"));
  std::string text = absl::StrCat("{'descr': [", fields, "], 'fortran_order': False, 'shape': (", points, ",), }");
  // Version 2.0 of the format: a length of four bytes.
  const std::string magic("\x93NUMPY\x02\x00", 8);
  const size_t before = magic.size() + sizeof(uint32_t);
  text.append(kAlignment - 1 - (before + text.size()) % kAlignment, ' ');
  text.push_back('\n');
  std::string bytes = magic;
  AppendBytes(static_cast<uint32_t>(text.size()), bytes);
  return bytes + text;
}

class NpyWriter {
 public:
  explicit NpyWriter(const SweepRequest& request)
      : request_(std::make_shared<SweepRequest>(request)), cursor_(request_->grid) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk) {
    std::string bytes;
    if (chunk.first_index == request_->first_index) bytes = Header(*request_, chunk.points_total);
    for (int64_t i = 0; i < chunk.count; ++i) {
      AppendBytes(chunk.first_index + i, bytes);
      for (const double value : cursor_.At(chunk.first_index + i)) AppendBytes(value, bytes);
      for (size_t c = 0; c < request_->columns.size(); ++c) {
        AppendBytes(chunk.values[c * static_cast<size_t>(chunk.count) + static_cast<size_t>(i)], bytes);
      }
      if (!request_->with_regime) continue;
      AppendBytes(static_cast<uint8_t>(chunk.regimes[static_cast<size_t>(i)]), bytes);
      AppendBytes(static_cast<uint8_t>(chunk.statuses[static_cast<size_t>(i)]), bytes);
    }
    return bytes;
  }

 private:
  std::shared_ptr<const SweepRequest> request_;  // Shared, because a writer is copied and the cursor points to it.
  AxisCursor cursor_;
};

}  // namespace

SweepWriter MakeNpyWriter(const SweepRequest& request) { return NpyWriter(request); }

}  // namespace ricochet::cli
