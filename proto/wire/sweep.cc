#include "proto/wire/sweep.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <variant>

#include "proto/wire/engine.h"
#include "proto/wire/enums.h"
#include "proto/wire/outcome.h"
#include "proto/wire/overloaded.h"
#include "proto/wire/plan.h"
#include "proto/wire/repeated.h"
#include "proto/wire/scene.h"

namespace ricochet {

static_assert(kRegimeCount == v1::Regime_ARRAYSIZE, "SweepSummary::by_regime needs an entry for each regime");
static_assert(kModelCount == v1::Model_ARRAYSIZE, "SweepSummary::by_model needs an entry for each model");
static_assert(kRowStatusCount == v1::RowStatus_ARRAYSIZE);
static_assert(kEffectCount == v1::Effect_ARRAYSIZE);
static_assert(std::endian::native == std::endian::little, "a chunk has the bytes of its doubles from the lowest on");
static_assert(v1::Regime_MAX <= 255, "a chunk has one byte for each regime");

// Linspace and Logspace have the same fields.
template <typename Space, typename SpaceProto>
static void SetSpace(const Space& space, SpaceProto& proto) {
  proto.set_start(space.start);
  proto.set_stop(space.stop);
  proto.set_count(space.count);
}

template <typename Space, typename SpaceProto>
static Space SpaceOf(const SpaceProto& proto) {
  return {.start = proto.start(), .stop = proto.stop(), .count = proto.count()};
}

static v1::Axis ToProto(const Axis& axis) {
  v1::Axis proto;
  proto.set_path(axis.path);
  std::visit(Overloaded{
                 [](std::monostate) {},
                 [&](const ListValues& list) { AssignDoubles(list.values, *proto.mutable_list()->mutable_values()); },
                 [&](const Linspace& linspace) { SetSpace(linspace, *proto.mutable_linspace()); },
                 [&](const Logspace& logspace) { SetSpace(logspace, *proto.mutable_logspace()); },
             },
             axis.values);
  return proto;
}

static decltype(Axis::values) ValuesOf(const v1::Axis& proto) {
  switch (proto.values_case()) {
    case v1::Axis::kList:
      return ListValues{ToVector(proto.list().values())};
    case v1::Axis::kLinspace:
      return SpaceOf<Linspace>(proto.linspace());
    case v1::Axis::kLogspace:
      return SpaceOf<Logspace>(proto.logspace());
    case v1::Axis::VALUES_NOT_SET:
      break;
  }
  return std::monostate();
}

static Axis FromProto(const v1::Axis& proto) { return {.path = proto.path(), .values = ValuesOf(proto)}; }

// A number that this build does not know is kept, so that the request is refused.
v1::SweepRequest::Combination ToProto(Combination combination) {
  return static_cast<v1::SweepRequest::Combination>(combination);
}
Combination FromProto(v1::SweepRequest::Combination proto) { return static_cast<Combination>(proto); }

v1::SweepRequest ToProto(const SweepRequest& request) {
  v1::SweepRequest proto;
  *proto.mutable_scene() = ToProto(request.grid.scene);
  for (const Axis& axis : request.grid.axes) *proto.add_axes() = ToProto(axis);
  proto.set_combination(ToProto(request.grid.combination));
  proto.mutable_columns()->Assign(request.columns.begin(), request.columns.end());
  proto.set_with_regime(request.with_regime);
  proto.set_first_index(request.first_index);
  if (request.end_index.has_value()) proto.set_end_index(*request.end_index);
  SetDemand(request.demand, proto);
  return proto;
}

SweepRequest FromProto(const v1::SweepRequest& proto) {
  SweepRequest request;
  request.grid.scene = FromProto(proto.scene());
  for (const v1::Axis& axis : proto.axes()) request.grid.axes.push_back(FromProto(axis));
  request.grid.combination = FromProto(proto.combination());
  request.columns.assign(proto.columns().begin(), proto.columns().end());
  request.with_regime = proto.with_regime();
  request.first_index = proto.first_index();
  if (proto.has_end_index()) request.end_index = proto.end_index();
  request.demand = DemandOf(proto);
  return request;
}

v1::Tally ToProto(const Tally& tally) {
  v1::Tally proto;
  proto.set_count(tally.count);
  proto.set_first_index(tally.first_index);
  return proto;
}

Tally FromProto(const v1::Tally& proto) { return {proto.count(), proto.first_index()}; }

v1::RowStatus ToProto(RowStatus status) { return SameNumber<v1::RowStatus>(status, &v1::RowStatus_IsValid); }
RowStatus FromProto(v1::RowStatus proto) { return SameNumber<RowStatus>(proto, &v1::RowStatus_IsValid); }

v1::SweepSummary ToProto(const SweepSummary& summary) {
  v1::SweepSummary proto;
  proto.set_points(summary.points);
  for (size_t number = 0; number < summary.by_regime.size(); ++number) {
    const Tally& tally = summary.by_regime[number];
    if (tally.count == 0) continue;
    v1::RegimeTally& entry = *proto.add_by_regime();
    entry.set_regime(ToProto(static_cast<Regime>(number)));
    *entry.mutable_tally() = ToProto(tally);
  }
  for (size_t number = 0; number < summary.by_model.size(); ++number) {
    const Tally& tally = summary.by_model[number];
    if (tally.count == 0) continue;
    v1::ModelTally& entry = *proto.add_by_model();
    entry.set_model(ToProto(static_cast<Model>(number)));
    *entry.mutable_tally() = ToProto(tally);
  }
  *proto.mutable_inadmissible() = ToProto(summary.inadmissible);
  if (summary.elapsed_s.has_value()) proto.set_elapsed_s(*summary.elapsed_s);
  return proto;
}

SweepSummary FromProto(const v1::SweepSummary& proto) {
  SweepSummary summary;
  summary.points = proto.points();
  for (const v1::RegimeTally& entry : proto.by_regime()) {
    if (!entry.has_tally()) continue;
    Tally& tally = summary.by_regime[static_cast<size_t>(FromProto(entry.regime()))];
    tally = Joined(tally, FromProto(entry.tally()));
  }
  for (const v1::ModelTally& entry : proto.by_model()) {
    if (!entry.has_tally()) continue;
    Tally& tally = summary.by_model[static_cast<size_t>(FromProto(entry.model()))];
    tally = Joined(tally, FromProto(entry.tally()));
  }
  if (proto.has_inadmissible()) summary.inadmissible = FromProto(proto.inadmissible());
  if (proto.has_elapsed_s()) summary.elapsed_s = proto.elapsed_s();
  return summary;
}

void ToProto(const SweepChunk& chunk, v1::SweepResponse& proto) {
  proto.set_first_index(chunk.first_index);
  proto.set_count(chunk.count);
  proto.mutable_values()->assign(reinterpret_cast<const char*>(chunk.values.data()),
                                 chunk.values.size() * sizeof(double));
  proto.mutable_regimes()->resize(chunk.regimes.size());
  std::transform(chunk.regimes.begin(), chunk.regimes.end(), proto.mutable_regimes()->begin(),
                 [](Regime regime) { return static_cast<char>(ToProto(regime)); });
  proto.mutable_statuses()->resize(chunk.statuses.size());
  std::transform(chunk.statuses.begin(), chunk.statuses.end(), proto.mutable_statuses()->begin(),
                 [](RowStatus status) { return static_cast<char>(ToProto(status)); });
  proto.set_points_done(chunk.points_done);
  proto.set_points_total(chunk.points_total);
  *proto.mutable_tallies() = ToProto(chunk.tallies);
  proto.clear_summary();
  if (chunk.summary.has_value()) *proto.mutable_summary() = ToProto(*chunk.summary);
  *proto.mutable_engine() = ToProto(chunk.engine);
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
  std::transform(proto.regimes().begin(), proto.regimes().end(), chunk.regimes.begin(),
                 [](char number) { return FromProto(static_cast<v1::Regime>(static_cast<unsigned char>(number))); });
  chunk.statuses.resize(proto.statuses().size());
  std::transform(proto.statuses().begin(), proto.statuses().end(), chunk.statuses.begin(),
                 [](char number) { return FromProto(static_cast<v1::RowStatus>(static_cast<unsigned char>(number))); });
  chunk.points_done = proto.points_done();
  chunk.points_total = proto.points_total();
  if (proto.has_tallies()) chunk.tallies = FromProto(proto.tallies());
  if (proto.has_summary()) chunk.summary = FromProto(proto.summary());
  chunk.engine = FromProto(proto.engine());
  return chunk;
}

}  // namespace ricochet
