// Fuzzes the decoding of a sweep's stream in the client. The input gives a request and the chunks of a server. Each
// chunk is correct at first; the bits of its first byte say which of its numbers the following bytes replace.
//
// It checks that a stream passes up to the first wrong chunk and no further; that the points that pass are those of the
// range, once and in order; that the stream ends with OK only if the summary came at the end; and that a stream of
// correct chunks passes as a whole.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/sweep_reader.h"
#include "core/types/grid.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/sweep.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fail.h"

namespace ricochet {
namespace {

// The script of a whole call.
struct Script {
  SweepRequest request;
  int64_t end = 0;  // The end of the range, if the server and the client agree.
  std::vector<v1::SweepResponse> chunks;
  grpc::Status status;
  bool right = true;  // True if no number was replaced and the chunks reach the end.
  std::optional<size_t> stop_at;
};

SweepRequest RequestFrom(Bytes& bytes) {
  SweepRequest request;
  const uint8_t shape = bytes.Byte();
  request.columns.resize(shape % 4, "coefficients.newton");
  request.with_regime = (shape & 4U) != 0;
  if ((shape & 8U) != 0) request.first_index = bytes.Number();
  if ((shape & 16U) != 0) request.end_index = bytes.Number();
  request.grid.axes = {{"pendulum.a_m", Linspace{1.0, 2.0, bytes.Byte()}}};
  if ((shape & 32U) != 0) request.grid.axes[0].path = "nobody.knows";
  return request;
}

// Replaces the numbers whose bits are set in `spoilt`.
void Spoil(uint8_t spoilt, Bytes& bytes, v1::SweepResponse& chunk) {
  if ((spoilt & 1U) != 0) chunk.set_first_index(bytes.Number());
  if ((spoilt & 2U) != 0) chunk.set_count(bytes.Number());
  if ((spoilt & 4U) != 0) chunk.mutable_values()->resize(bytes.Byte(), '?');
  if ((spoilt & 8U) != 0) chunk.mutable_regimes()->resize(bytes.Byte(), 1);
  if ((spoilt & 16U) != 0) chunk.set_points_total(bytes.Number());
  if ((spoilt & 32U) != 0) chunk.has_summary() ? chunk.clear_summary() : chunk.mutable_summary()->Clear();
}

// Counts points that all have the regime and the model of number 1.
v1::SweepSummary TalliesOf(int64_t points, int64_t first_index) {
  SweepSummary tallies = {.points = points};
  tallies.by_regime[1] = tallies.by_model[1] = {points, first_index};
  return ToProto(tallies);
}

Script ScriptFrom(Bytes bytes) {
  Script script = {.request = RequestFrom(bytes)};
  const SweepRequest& request = script.request;
  const int64_t points = ValidateAxes(request.grid).empty() ? PointCount(request.grid) : 64;
  script.end = request.end_index.value_or(points);
  const ChunkSeal seal(request);
  v1::SweepSummary tallies;
  int64_t next = request.first_index;
  // A range that no server answers never counts as right.
  script.right = next >= 0 && next < script.end && script.end <= points;
  while (!bytes.empty()) {
    const uint8_t spoilt = bytes.Byte();
    if ((spoilt & 64U) != 0) script.stop_at = script.chunks.size();
    if ((spoilt & 128U) != 0) script.status = grpc::Status(grpc::StatusCode::INTERNAL, "broke down");
    const int64_t count = script.right ? std::min<int64_t>(bytes.Byte() % 32 + 1, script.end - next) : bytes.Byte();
    v1::SweepResponse chunk;
    chunk.set_first_index(next);
    chunk.set_count(count);
    chunk.mutable_values()->resize(static_cast<size_t>(count) * request.columns.size() * sizeof(double), '?');
    if (request.with_regime) {
      chunk.mutable_regimes()->resize(static_cast<size_t>(count), 1);
      chunk.mutable_statuses()->resize(static_cast<size_t>(count), 1);
    }
    if (script.right) {
      next += count;
      tallies = TalliesOf(next - request.first_index, request.first_index);
      chunk.set_points_total(script.end - request.first_index);
      if (next == script.end) *chunk.mutable_summary() = tallies;
    }
    *chunk.mutable_tallies() = tallies;
    Spoil(spoilt, bytes, chunk);
    // A damaged checksum would hide all other damage.
    seal.Put(chunk);
    script.right = script.right && (spoilt & ~64U) == 0;
    script.chunks.push_back(std::move(chunk));
    if (script.right && next == script.end) return script;
  }
  script.right = false;
  return script;
}

// A fake call that answers by the script.
class ScriptedCall final : public SweepReader::Call {
 public:
  ScriptedCall(const Script& script, std::stop_source stop) : script_(script), stop_(std::move(stop)) {}

  bool Read(v1::SweepResponse* message) override {
    if (next_ == script_.stop_at) stop_.request_stop();
    if (next_ == script_.chunks.size()) return false;
    *message = script_.chunks[next_++];
    return true;
  }
  bool NextMessageSize(uint32_t* size) override {
    *size = static_cast<uint32_t>(script_.chunks[next_].ByteSizeLong());
    return true;
  }
  void WaitForInitialMetadata() override {}
  grpc::Status Finish() override { return script_.status; }

 private:
  const Script& script_;
  std::stop_source stop_;
  size_t next_ = 0;
};

// Compares the chunks that pass with the request.
class Receiver {
 public:
  explicit Receiver(const Script& script) : script_(script), next_(script.request.first_index) {}

  void Take(const SweepChunk& chunk) {
    const auto columns = static_cast<int64_t>(script_.request.columns.size());
    if (chunk.first_index != next_) Fail(absl::StrCat("point ", chunk.first_index, " in place of ", next_));
    if (chunk.count < 0) Fail("a chunk of fewer than no points");
    if (static_cast<int64_t>(chunk.values.size()) != chunk.count * columns) Fail("another number of values");
    const int64_t regimes = script_.request.with_regime ? chunk.count : 0;
    if (static_cast<int64_t>(chunk.regimes.size()) != regimes) Fail("another number of regimes");
    if (static_cast<int64_t>(chunk.statuses.size()) != regimes) Fail("another number of statuses");
    next_ += chunk.count;
    summarised_ = chunk.summary.has_value();
  }

  void End() const {
    if (!summarised_) Fail("an end without a summary");
    if (script_.request.end_index.has_value() && next_ != script_.end) Fail("an end before the last point");
  }

  bool complete() const { return summarised_ && next_ == script_.end; }

 private:
  const Script& script_;
  int64_t next_;
  bool summarised_ = false;
};

void Run(const Script& script) {
  std::stop_source stop;
  PreferredServer server(1);
  SweepReader reader(script.request,
                     [&](size_t, grpc::ClientContext*, const v1::SweepRequest&) {
                       return std::make_unique<ScriptedCall>(script, stop);
                     },
                     server, {.max_attempts = 1, .max_resumes = 0}, std::chrono::hours(1), {.stop = stop.get_token()});
  Receiver receiver(script);
  for (size_t reads = 0;; ++reads) {
    if (reads > script.chunks.size()) Fail("more chunks than were sent");
    const std::optional<absl::StatusOr<SweepChunk>> chunk = reader.Next();
    if (!chunk.has_value()) return receiver.End();
    if (!chunk->ok()) break;
    receiver.Take(**chunk);
  }
  if (script.right && !script.stop_at.has_value()) Fail("a right stream is refused");
  if (receiver.complete() && script.status.ok() && script.right) Fail("a complete stream ends badly");
}

}  // namespace
}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::Run(ricochet::ScriptFrom(ricochet::Bytes(data, size)));
  return 0;
}
