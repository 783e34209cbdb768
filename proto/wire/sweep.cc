#include "proto/wire/sweep.h"

#include <algorithm>
#include <cstddef>

#include "proto/wire/demand.h"
#include "proto/wire/engine.h"
#include "proto/wire/map.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/scene.h"

namespace ricochet {

static_assert(kRegimeCount == v1::Regime_ARRAYSIZE, "SweepSummary::by_regime needs an entry for each regime");
static_assert(kModelCount == v1::Model_ARRAYSIZE, "SweepSummary::by_model needs an entry for each model");
static_assert(kRowStatusCount == v1::RowStatus_ARRAYSIZE);
static_assert(kEffectCount == v1::Effect_ARRAYSIZE);
static_assert(v1::Regime_MAX <= 255, "a chunk has one byte for each regime");

RICOCHET_MAP(ListValues, values);
RICOCHET_MAP(Linspace, start, stop, count);
RICOCHET_MAP(Logspace, start, stop, count);

template <>
struct Map<Axis> : Between<Axis, v1::Axis> {
  static constexpr auto kFields =
      Entries(RICOCHET_FIELD(path),
              Flat(&T::values, OneOf(RICOCHET_ACCESS(list), RICOCHET_ACCESS(linspace), RICOCHET_ACCESS(logspace))));
};

template <>
struct Map<SweepRequest> : Between<SweepRequest, v1::SweepRequest> {
  static constexpr auto kFields =
      Entries(Flat(&T::grid, Entries(RICOCHET_FIELD(scene), RICOCHET_FIELD(axes), RICOCHET_FIELD(combination))),
              RICOCHET_FIELD(columns), RICOCHET_FIELD(with_regime), RICOCHET_FIELD(first_index),
              RICOCHET_FIELD(end_index), Flat(&T::demand, kDemandEntries));
};

RICOCHET_MAP(Tally, count, first_index);

RICOCHET_CONVERT_IN_PLACE(Tally);

// The tallies that are not empty, each with the number that it has in its array. Tallies of numbers that this build
// does not know are joined.
template <typename Enum, typename Tallies, typename Message, typename Number>
struct TalliesField {
  Tallies SweepSummary::*member;
  const google::protobuf::RepeatedPtrField<Message>& (v1::SweepSummary::*get)() const;
  google::protobuf::RepeatedPtrField<Message>* (v1::SweepSummary::*edit)();
  Number (Message::*number)() const;
  void (Message::*set_number)(Number);

  void Write(const SweepSummary& summary, v1::SweepSummary& proto) const {
    const Tallies& tallies = summary.*member;
    for (size_t i = 0; i < tallies.size(); ++i) {
      if (tallies[i].count == 0) continue;
      Message& entry = *(proto.*edit)()->Add();
      (entry.*set_number)(static_cast<Number>(i));
      ToProto(tallies[i], *entry.mutable_tally());
    }
  }
  void Read(const v1::SweepSummary& proto, SweepSummary& summary) const {
    for (const Message& entry : (proto.*get)()) {
      if (!entry.has_tally()) continue;
      Tally& tally = (summary.*member)[static_cast<size_t>(FromProto<Enum>((entry.*number)()))];
      tally = Joined(tally, Received<Tally>(entry.tally()));
    }
  }
};

template <typename Enum, typename Tallies, typename Message, typename Number>
static constexpr TalliesField<Enum, Tallies, Message, Number> TalliesEntry(
    Tallies SweepSummary::*member, const google::protobuf::RepeatedPtrField<Message>& (v1::SweepSummary::*get)() const,
    google::protobuf::RepeatedPtrField<Message>* (v1::SweepSummary::*edit)(), Number (Message::*number)() const,
    void (Message::*set_number)(Number)) {
  return {member, get, edit, number, set_number};
}

template <>
struct Map<SweepSummary> : Between<SweepSummary, v1::SweepSummary> {
  static constexpr auto kFields = Entries(RICOCHET_FIELD(points),
                                          TalliesEntry<Regime>(&T::by_regime, &P::by_regime, &P::mutable_by_regime,
                                                               &v1::RegimeTally::regime, &v1::RegimeTally::set_regime),
                                          TalliesEntry<Model>(&T::by_model, &P::by_model, &P::mutable_by_model,
                                                              &v1::ModelTally::model, &v1::ModelTally::set_model),
                                          Defaulted(RICOCHET_FIELD(inadmissible)),
                                          Defaulted(RICOCHET_FIELD(not_converged)), RICOCHET_FIELD(elapsed_s));
};

RICOCHET_CONVERT_IN_PLACE(SweepSummary);
RICOCHET_CONVERT(SweepRequest);
RICOCHET_CONVERT(SweepSummary);

void ToProto(const SweepChunk& chunk, v1::SweepResponse& proto) {
  proto.set_first_index(chunk.first_index);
  proto.set_count(chunk.count);
  proto.mutable_values()->assign(reinterpret_cast<const char*>(chunk.values.data()),
                                 chunk.values.size() * sizeof(double));
  SetCodes(chunk.regimes, *proto.mutable_regimes());
  SetCodes(chunk.statuses, *proto.mutable_statuses());
  proto.set_points_done(chunk.points_done);
  proto.set_points_total(chunk.points_total);
  proto.mutable_tallies()->Clear();
  ToProto(chunk.tallies, *proto.mutable_tallies());
  proto.clear_summary();
  if (chunk.summary.has_value()) ToProto(*chunk.summary, *proto.mutable_summary());
  ToProto(chunk.engine, *proto.mutable_engine());
  proto.clear_crc32c();
  proto.clear_grid_fingerprint();
}

SweepChunk FromProto(const v1::SweepResponse& proto) {
  SweepChunk chunk;
  chunk.first_index = proto.first_index();
  chunk.count = proto.count();
  chunk.values.resize(proto.values().size() / sizeof(double));
  CopyDoubles(proto.values(), absl::MakeSpan(chunk.values));
  chunk.regimes.resize(proto.regimes().size());
  std::transform(proto.regimes().begin(), proto.regimes().end(), chunk.regimes.begin(), CodeOf<Regime>);
  chunk.statuses.resize(proto.statuses().size());
  std::transform(proto.statuses().begin(), proto.statuses().end(), chunk.statuses.begin(), CodeOf<RowStatus>);
  chunk.points_done = proto.points_done();
  chunk.points_total = proto.points_total();
  if (proto.has_tallies()) chunk.tallies = FromProto(proto.tallies());
  if (proto.has_summary()) chunk.summary = FromProto(proto.summary());
  chunk.engine = FromProto(proto.engine());
  return chunk;
}

}  // namespace ricochet
