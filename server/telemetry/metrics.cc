#include "server/telemetry/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "absl/algorithm/container.h"
#include "absl/strings/str_cat.h"
#include "ricochet/engine_info.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/base/telemetry_names.h"

namespace ricochet::server {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Histogram;
using Buckets = Histogram::BucketBoundaries;

// These two return the bucket boundaries of gRFC A66, for times in seconds and for sizes in bytes.
const Buckets& Seconds() {
  static const Buckets buckets = {0,     0.00001, 0.00005, 0.0001, 0.0003, 0.0006, 0.0008, 0.001, 0.002, 0.003, 0.004,
                                  0.005, 0.006,   0.008,   0.01,   0.013,  0.016,  0.02,   0.025, 0.03,  0.04,  0.05,
                                  0.065, 0.08,    0.1,     0.13,   0.16,   0.2,    0.25,   0.3,   0.4,   0.5,   0.65,
                                  0.8,   1,       2,       5,      10,     20,     50,     100};
  return buckets;
}

const Buckets& Bytes() {
  static const Buckets buckets = {0,       1024,    2048,     4096,     16384,     65536,      262144,
                                  1048576, 4194304, 16777216, 67108864, 268435456, 1073741824, 4294967296};
  return buckets;
}

// Returns the label of a method in gRFC A66; every method that is not the service's is "other".
std::string MethodLabel(const std::string& method) {
  static const auto* const service =
      v1::SolveRequest::descriptor()->file()->pool()->FindServiceByName(v1::ImpactService::service_full_name());
  if (service == nullptr || service->FindMethodByName(method) == nullptr) return "other";
  return absl::StrCat(v1::ImpactService::service_full_name(), "/", method);
}

// Returns the reason if this program names it, so that the label stays one of few.
std::string ReasonLabel(const std::string& reason) {
  return absl::c_linear_search(Reasons(), reason) ? reason : "OTHER";
}

// A metric whose value is asked for at each scrape.
struct Asked {
  std::string name;
  std::string help;
  prometheus::MetricType type;
  std::function<double()> value;
};

}  // namespace

// The metrics that calls count, and those that are asked for.
struct Metrics::State {
  void Ask(Asked metric) {
    const std::lock_guard lock(mutex);
    asked.push_back(std::move(metric));
  }
  Family<Counter>& AddCounters(const char* name, const char* help) {
    return BuildCounter().Name(name).Help(help).Register(registry);
  }
  Counter& AddCounter(const char* name, const char* help) { return AddCounters(name, help).Add({}); }
  Family<Histogram>& AddHistograms(const char* name, const char* help) {
    return BuildHistogram().Name(name).Help(help).Register(registry);
  }

  prometheus::Registry registry;
  Family<Counter>& started = AddCounters("grpc_server_call_started_total", "Calls that have started.");
  Family<Histogram>& duration = AddHistograms("grpc_server_call_duration_seconds",
                                              "Time from the start of a call to its end; its status is the caller's.");
  Family<Histogram>& received =
      AddHistograms("grpc_server_call_rcvd_total_compressed_message_size_bytes", "Bytes of the messages of a request.");
  Family<Histogram>& sent =
      AddHistograms("grpc_server_call_sent_total_compressed_message_size_bytes", "Bytes of the messages of an answer.");
  Histogram& queued =
      AddHistograms("ricochet_queue_wait_seconds", "Time that an admitted call waited for a place.").Add({}, Seconds());
  Counter& points = AddCounter("ricochet_points_total", "Points of sweeps and rows of batches.");
  Counter& chunks = AddCounter("ricochet_chunks_total", "Messages of streams that were sent.");
  Counter& chunk_bytes = AddCounter("ricochet_chunk_bytes_total", "Bytes in messages of streams that were sent.");
  Counter& stalls = AddCounter("ricochet_stalls_total", "Long waits for a caller to read.");
  Counter& resumes = AddCounter("ricochet_resumes_total", "Sweeps that were asked for from a point after the first.");
  Family<Counter>& refusals = AddCounters("ricochet_refusals_total", "Calls that failed with a reason.");
  Family<Counter>& solved = AddCounters("ricochet_solved_total", "Valid impacts by the model that the plan picked.");
  std::mutex mutex;
  std::vector<Asked> asked;  // Guarded by the mutex.
};

Metrics::Metrics() : state_(std::make_unique<State>()) {
  BuildGauge()
      .Name("ricochet_info")
      .Help("Always 1; the labels name the version and the engine's fingerprint.")
      .Register(state_->registry)
      .Add({{"version", ThisEngine().version}, {"engine", ThisEngine().fingerprint}})
      .Set(1);
  // A series that began with its first event would hide that event from rate() and increase().
  for (const std::string& reason : Reasons()) state_->refusals.Add({{"reason", reason}});
  for (size_t model = 1; model < size_t{kModelCount}; ++model) state_->solved.Add({{"model", ModelName(model)}});
}

Metrics::~Metrics() = default;

void Metrics::Started(const std::string& method) {
  state_->started.Add({{"grpc_method", MethodLabel(method)}}).Increment();
}

void Metrics::Ended(const CallRecord& call) {
  const std::map<std::string, std::string> labels = {{"grpc_method", MethodLabel(call.method)},
                                                     {"grpc_status", absl::StatusCodeToString(call.status)}};
  state_->duration.Add(labels, Seconds()).Observe(call.duration_s);
  state_->received.Add(labels, Bytes()).Observe(static_cast<double>(call.received_bytes));
  state_->sent.Add(labels, Bytes()).Observe(static_cast<double>(call.sent_bytes));
  state_->queued.Observe(call.queued_s);
  state_->points.Increment(static_cast<double>(call.points.value_or(0)));
  state_->chunks.Increment(static_cast<double>(call.chunks));
  state_->chunk_bytes.Increment(static_cast<double>(call.chunk_bytes));
  state_->stalls.Increment(static_cast<double>(call.stalls));
  if (call.first_index > 0) state_->resumes.Increment();
  if (!call.reason.empty()) Refused(call.reason);
  for (size_t model = 0; model < call.solved_by_model.size(); ++model) {
    const int64_t solved = call.solved_by_model[model];
    if (solved > 0) state_->solved.Add({{"model", ModelName(model)}}).Increment(static_cast<double>(solved));
  }
}

void Metrics::Refused(const std::string& reason) {
  state_->refusals.Add({{"reason", ReasonLabel(reason)}}).Increment();
}

void Metrics::AddGauge(const std::string& name, const std::string& help, std::function<double()> value) {
  state_->Ask({name, help, prometheus::MetricType::Gauge, std::move(value)});
}

void Metrics::AddCounter(const std::string& name, const std::string& help, std::function<double()> value) {
  state_->Ask({name, help, prometheus::MetricType::Counter, std::move(value)});
}

std::string Metrics::Text() const {
  std::vector<prometheus::MetricFamily> families = state_->registry.Collect();
  const std::lock_guard lock(state_->mutex);
  for (const Asked& asked : state_->asked) {
    prometheus::ClientMetric metric;
    metric.gauge.value = metric.counter.value = asked.value();
    families.push_back({asked.name, asked.help, asked.type, {metric}});
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace ricochet::server
