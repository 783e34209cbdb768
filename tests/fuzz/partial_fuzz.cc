// Fuzzes what a sweep leaves on the disk for another run: the first part of its file, its shards, and the manifests of
// both. A sweep of 20 points is written in pieces; the input says how it is cut and in which format, and then which of
// the files are damaged where: a byte or a digit is changed, the end is cut off or added to, a file is removed or is
// that of another shard.
//
// It checks that a sweep that goes on after any damage, and shards that are merged after any damage, are refused with a
// message, or give the bytes of the whole sweep.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <CLI/App.hpp>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/cli/input/command_options.h"
#include "client/cli/io/used_files.h"
#include "client/cli/program.h"
#include "client/cli/sweep/shard.h"
#include "client/cli/sweep/sweep_output.h"
#include "ricochet/solver.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fail.h"
#include "tests/support/processes/temporary_directory.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet::cli {
namespace {

constexpr int64_t kPoints = 20;
constexpr int64_t kPiece = 4;

SweepRequest Request() {
  SweepRequest request = {.grid = {.scene = With(Contact()), .axes = {}},
                          .columns = {"coefficients.newton", "impulse.normal_total_n_s"},
                          .with_regime = true,
                          .end_index = kPoints};
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{-0.1, 1.0, kPoints}}};
  return request;
}

// The chunks of the range, as if a server had cut them at every kPiece points.
std::vector<SweepChunk> ComputeChunks(int64_t first, int64_t end) {
  std::vector<SweepChunk> chunks;
  SweepSummary counts;
  for (int64_t from = first; from < end; from += kPiece) {
    SweepRequest piece = Request();
    piece.first_index = from;
    piece.end_index = std::min(from + kPiece, end);
    for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(piece)) {
      counts = Joined(counts, chunk.value().tallies);
      SweepChunk& kept = chunks.emplace_back(*chunk);
      kept.points_done = counts.points;
      kept.points_total = end - first;
      kept.tallies = counts;
      kept.summary.reset();
    }
  }
  if (!chunks.empty()) chunks.back().summary = counts;
  return chunks;
}

const std::vector<SweepChunk>& ChunksOf(int64_t first, int64_t end) {
  static auto& computed = *new std::map<std::pair<int64_t, int64_t>, std::vector<SweepChunk>>();
  const auto [place, is_new] = computed.try_emplace({first, end});
  if (is_new) place->second = ComputeChunks(first, end);
  return place->second;
}

std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteAll(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

// Changes the file as the bytes say.
void Damage(const std::string& path, const std::string& other, Bytes& bytes) {
  std::string text = ReadAll(path);
  const uint8_t how = bytes.Byte() % 6;
  const size_t place = text.empty() ? 0 : static_cast<size_t>(bytes.Byte() << 8U | bytes.Byte()) % text.size();
  switch (how) {
    case 0:
      if (!text.empty()) text[place] = static_cast<char>(text[place] ^ bytes.Byte());
      break;
    case 1: {  // A digit, so that a manifest stays one.
      const auto digit = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(place), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
      if (digit != text.end()) *digit = static_cast<char>('0' + bytes.Byte() % 10);
      break;
    }
    case 2:
      text.resize(place);
      break;
    case 3:
      for (int i = bytes.Byte(); i > 0; --i) text.push_back(static_cast<char>(bytes.Byte()));
      break;
    case 4:
      std::filesystem::remove(path);
      return;
    default:
      text = ReadAll(other);
  }
  WriteAll(path, text);
}

void CheckRefusal(const absl::Status& status) {
  const bool is_promised = absl::IsInvalidArgument(status) || absl::IsDataLoss(status) || absl::IsNotFound(status) ||
                           absl::IsFailedPrecondition(status);
  if (!is_promised || status.message().empty()) Fail(status.ToString());
}

constexpr Format kFormats[] = {Format::kCsv, Format::kJson, Format::kJsonLines, Format::kNpy};

// Options of a run of its own, which has used no file yet.
CommonOptions OptionsFor(const std::string& path, uint8_t format) {
  ForgetUsedFiles();
  CommonOptions options;
  options.output = path;
  options.format = kFormats[format];
  return options;
}

// Writes the sweep from where `output` is; stops after `most` chunks. Returns false if it stopped.
absl::StatusOr<bool> Write(SweepOutput& output, size_t most) {
  const int64_t first = output.next_index();
  if (first % kPiece != 0 || first < 0 || first > kPoints) Fail(absl::StrCat("a sweep goes on at point ", first));
  for (SweepChunk chunk : ChunksOf(first, kPoints)) {
    if (most-- == 0) return false;
    if (absl::Status status = output.Join(chunk); !status.ok()) return status;
    if (absl::Status status = output.Write(chunk); !status.ok()) return status;
  }
  return true;
}

std::string WriteWhole(const std::string& path, const CommonOptions& options) {
  absl::StatusOr<SweepOutput> output = SweepOutput::OpenPartial(Request(), options, /*resume=*/false);
  if (!output.ok()) Fail(output.status().ToString());
  const absl::StatusOr<bool> written = Write(*output, kPoints);
  if (!written.ok() || !*written || !output->Commit().ok()) Fail("a sweep cannot be written");
  return ReadAll(path);
}

// The file of a sweep that nobody disturbed.
const std::string& WholeText(uint8_t format) {
  static auto& texts = *new std::map<uint8_t, std::string>();
  std::string& text = texts[format];
  if (!text.empty()) return text;
  const TemporaryDirectory directory;
  const std::string path = directory / "whole";
  return text = WriteWhole(path, OptionsFor(path, format));
}

void CheckResume(Bytes bytes) {
  const TemporaryDirectory directory;
  const auto format = static_cast<uint8_t>(bytes.Byte() % std::size(kFormats));
  const std::string path = directory / "sweep";
  const CommonOptions options = OptionsFor(path, format);
  {
    absl::StatusOr<SweepOutput> output = SweepOutput::OpenPartial(Request(), options, /*resume=*/false);
    if (!output.ok()) Fail(output.status().ToString());
    const uint8_t stop = bytes.Byte();
    const absl::StatusOr<bool> written = Write(*output, stop % (kPoints / kPiece));
    if (!written.ok()) Fail(written.status().ToString());
    // Else the run was killed, and its last points are those of its last checkpoint.
    if ((stop & 128U) != 0) output->LeaveForResume(absl::CancelledError(), "ricochet");
  }
  const std::string part = path + ".part";
  while (!bytes.empty()) {
    const bool is_manifest = bytes.Byte() % 2 != 0;
    // The counts of JSON's summary are those of the manifest, which has no other copy of them.
    if (is_manifest && options.format == Format::kJson) continue;
    Damage(is_manifest ? part + ".json" : part, is_manifest ? part : part + ".json", bytes);
  }
  ForgetUsedFiles();
  absl::StatusOr<SweepOutput> output = SweepOutput::OpenPartial(Request(), options, /*resume=*/true);
  if (!output.ok()) return CheckRefusal(output.status());
  const absl::StatusOr<bool> written = Write(*output, kPoints);
  if (!written.ok()) return CheckRefusal(written.status());
  if (!output->Commit().ok()) Fail("a sweep cannot be committed");
  if (ReadAll(path) != WholeText(format)) Fail("a sweep that went on is another than one that ran through");
}

std::vector<std::string> WriteShards(const std::string& file, int64_t count) {
  std::vector<std::string> paths;
  for (int64_t i = 0; i < count; ++i) {
    ForgetUsedFiles();
    const absl::StatusOr<SweepShard> shard = MakeShard(Request(), {.index = i, .count = count}, file);
    if (!shard.ok()) Fail(shard.status().ToString());
    absl::StatusOr<SweepOutput> output = SweepOutput::OpenShard(*shard);
    if (!output.ok()) Fail(output.status().ToString());
    for (SweepChunk chunk : ChunksOf(shard->part.first_index, *shard->part.end_index)) {
      if (!output->Join(chunk).ok() || !output->Write(chunk).ok()) Fail("a shard cannot be written");
    }
    if (!output->Commit().ok()) Fail("a shard cannot be committed");
    paths.push_back(shard->path);
  }
  return paths;
}

absl::Status RunProgram(const std::vector<std::string>& arguments) {
  ForgetUsedFiles();
  Command command;
  const std::unique_ptr<CLI::App> app = MakeProgram(arguments, command);
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend() - 1);
  app->parse(reversed);
  return command();
}

void CheckMerge(Bytes bytes) {
  const TemporaryDirectory directory;
  const std::string file = directory / "sweep";
  const uint8_t shape = bytes.Byte();
  const std::vector<std::string> paths = WriteShards(file, shape % 4 + 1);
  while (!bytes.empty()) {
    const uint8_t which = bytes.Byte();
    const std::string ending = (which & 1U) != 0 ? ".json" : "";
    const auto path = [&](size_t i) { return paths[i % paths.size()] + ending; };
    Damage(path(which >> 1U), path((which >> 1U) + 1), bytes);
  }
  std::vector<std::string> arguments = {"ricochet", "merge", file, "--format", "csv", "-o", directory / "merged.csv"};
  if ((shape & 128U) != 0) arguments.push_back("--verify");
  if (const absl::Status status = RunProgram(arguments); !status.ok()) return CheckRefusal(status);
  if (ReadAll(directory / "merged.csv") != WholeText(0)) Fail("shards are merged into another sweep");
}

}  // namespace
}  // namespace ricochet::cli

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const ricochet::Bytes bytes(data + 1, size - 1);
  if (data[0] % 2 == 0) {
    ricochet::cli::CheckResume(bytes);
  } else {
    ricochet::cli::CheckMerge(bytes);
  }
  return 0;
}
