#include "server/admission/request_cost.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/base/derivative_name.h"
#include "ricochet/audit_columns.h"

namespace ricochet::server {
namespace {

// Up to these sizes a call takes less than half a millisecond.
constexpr int64_t kFewLinks = 32;
constexpr int64_t kShortHistory = 2048;
constexpr int64_t kFewRows = 64;
constexpr size_t kImpactsOfSearch = 200;  // The impacts that a search for a threshold takes on each side of a number.
constexpr size_t kFewSides = 16;          // Derivatives take two sides of each number of the scene.
constexpr size_t kImpactsOfDifference = 64;
constexpr double kFewContacts = 27;    // States times the cube of the contacts, in a plane.
constexpr size_t kFewVelocities = 32;  // Several contacts have those of the system, and the outputs asked for.

RequestCost Expensive(CostCause cause, double size) {
  constexpr double kMostSize = 1e300;  // Sizes are products of what a caller sends, and no limit has been applied yet.
  return {.cause = cause, .octave = static_cast<int>(std::log2(std::clamp(size, 1.0, kMostSize)))};
}

// The links of a linkage, or the coordinates of a mechanism.
int64_t Links(const Scene& scene) {
  if (const auto* const mechanism = std::get_if<Mechanism>(&scene.system)) {
    return static_cast<int64_t>(mechanism->rates.size());
  }
  const auto* const linkage = std::get_if<Linkage>(&scene.system);
  return linkage == nullptr ? 1 : static_cast<int64_t>(linkage->links.size());
}

double Cube(int64_t number) { return std::pow(static_cast<double>(number), 3); }

RequestCost CostOf(const Scene& scene) {
  return Links(scene) > kFewLinks ? Expensive(CostCause::kLinks, Cube(Links(scene))) : RequestCost();
}

RequestCost CertificateCost(const Scene& scene, int32_t digits) {
  return Expensive(CostCause::kCertificate, digits * Cube(Links(scene)));
}

bool TakesTime(const Scene& scene, const DemandFields& demand) {
  return TakesTime(scene) ||
         std::find(demand.required.begin(), demand.required.end(), Effect::kFiniteDuration) != demand.required.end();
}

bool IsDerivative(const std::string& column) { return ReadDerivativeName(column).has_value(); }

bool TakesTime(const SolveRequest& request) {
  return request.force_intervals > 0 || TakesTime(request.scene, request.demand);
}

size_t Rows(const AuditBatchRequest& request) {
  const AuditColumns& columns = request.columns;
  size_t rows = 0;
  for (const InputColumn& input : request.inputs) rows = std::max(rows, input.values.size());
  for (const NamedAuditColumn& column : kAuditColumns) rows = std::max(rows, (columns.*column.values).size());
  for (const std::vector<double>& column : columns.rates_after) rows = std::max(rows, column.size());
  return rows;
}

}  // namespace

RequestCost CostOf(const SolveRequest& request) {
  if (request.certified_digits > 0) return CertificateCost(request.scene, request.certified_digits);
  if (TakesTime(request)) return Expensive(CostCause::kDuration, static_cast<double>(request.force_intervals));
  const int64_t states = std::max(request.history_intervals, static_cast<int64_t>(request.history_at_n_s.size()));
  if (states > kShortHistory) {
    return Expensive(CostCause::kHistory, static_cast<double>(states) * static_cast<double>(4 + Links(request.scene)));
  }
  // Each number of the scene takes two impacts in double-double arithmetic, and M is factored for each; or differences.
  size_t sides = request.derivatives.has_value() ? 2 * request.derivatives->by.size() : 0;
  if (sides > 0 && request.derivatives->find_thresholds) sides *= kImpactsOfSearch;
  if (WhyNotExact(request.scene) != nullptr) sides *= kImpactsOfDifference;
  if (sides > kFewSides) {
    return Expensive(CostCause::kDerivatives, static_cast<double>(sides) * Cube(Links(request.scene)));
  }
  return CostOf(request.scene);
}

RequestCost CostOf(const PlanRequest& request) { return CostOf(request.scene); }

RequestCost CostOf(const BoundsRequest& request) {
  if (!request.ranges.empty()) return Expensive(CostCause::kEnclosure, std::exp2(request.ranges.size()));
  if (request.certified_digits > 0) return CertificateCost(request.scene, request.certified_digits);
  if (request.derivatives.has_value()) {
    const auto sides = static_cast<double>(2 * request.derivatives->by.size() * kImpactsOfDifference);
    return Expensive(CostCause::kDerivatives, sides * Cube(Links(request.scene)));
  }
  return CostOf(request.scene);
}

RequestCost CostOf(const AuditRequest& request) { return CostOf(request.scene); }

RequestCost CostOf(const AuditBatchRequest& request) {
  const size_t rows = Rows(request);
  if (rows > kFewRows) {
    // Beside inputs each row has a mass matrix of its own, which is factored.
    const int64_t links = Links(request.scene);
    const auto of_a_row = request.inputs.empty() ? static_cast<double>(links) : Cube(links);
    return Expensive(CostCause::kRows, static_cast<double>(rows) * of_a_row);
  }
  return CostOf(request.scene);
}

// The iterations that a search takes are not known.
RequestCost CostOf(const FitRequest& request) {
  size_t rows = 1;
  for (const FitMeasured& measured : request.measured) rows = std::max(rows, measured.values.size());
  const double searches = request.starts.value_or(kFitStarts) * static_cast<double>(FitSolvesOfARow(request));
  const double size = static_cast<double>(rows) * searches * request.max_iterations.value_or(kFitIterations);
  return Expensive(CostCause::kFit, size * Cube(Links(request.scene)));
}

namespace {

size_t Velocities(const MultiContactSystem& system) {
  struct Counter {
    size_t operator()(std::monostate) const { return 0; }
    size_t operator()(const ContactMatrix& matrix) const { return matrix.velocity_m_s.size(); }
    size_t operator()(const FreeBodies& free) const { return 3 * free.bodies.size(); }
    size_t operator()(const Mechanism& mechanism) const { return mechanism.rates.size(); }
  };
  return std::visit(Counter(), system);
}

}  // namespace

RequestCost CostOf(const MultiContactRequest& request) {
  // A curve of outcomes takes as long as so many states.
  constexpr double kStatesOfCurve = 16.0;
  const auto states = static_cast<double>(std::max<size_t>(request.states.size(), 1));
  const double size = states * Cube(static_cast<int64_t>(request.scene.contacts.size())) *
                      (request.stiffness_range.has_value() ? kStatesOfCurve : 1.0);
  const bool has_few_velocities = Velocities(request.scene.system) + request.outputs.size() <= kFewVelocities;
  const bool is_cheap = DirectionsOf(request.scene) == 2 && size <= kFewContacts && has_few_velocities;
  return is_cheap ? RequestCost() : Expensive(CostCause::kContacts, size);
}

RequestCost CostOf(const BatchSetup& setup, size_t rows) {
  const auto derivatives = static_cast<double>(std::count_if(setup.columns.begin(), setup.columns.end(), IsDerivative));
  const double size = static_cast<double>(rows) * static_cast<double>(Links(setup.scene)) *
                      (1.0 + 2.0 * derivatives * (WhyNotExact(setup.scene) != nullptr ? kImpactsOfDifference : 1));
  if (TakesTime(setup.scene, setup.demand)) return Expensive(CostCause::kDuration, size);
  if (derivatives > 0.0) return Expensive(CostCause::kDerivatives, size);
  return rows > kFewRows ? Expensive(CostCause::kRows, size) : CostOf(setup.scene);
}

RequestCost CostOf(const InfoRequest& /*request*/) { return {}; }

}  // namespace ricochet::server
