#include "core/engine/check_limits.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/scene/numbers.h"
#include "ricochet/audit_columns.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// Collects the fields of a request that are too large.
class SizeCheck {
 public:
  explicit SizeCheck(const Limits& limits) : limits_(limits) {}

  // Requires that the list at `field` has no more entries than the limit.
  void Entries(const std::string& field, size_t size, int64_t Limits::*limit) {
    if (static_cast<int64_t>(size) <= limits_.*limit) return;
    Exceeded(field, absl::StrCat("has ", size, " entries: must have at most ", limits_.*limit), limit);
  }

  // Requires that a number asked for by the field is no larger than the limit.
  void Number(const std::string& field, int64_t number, int64_t Limits::*limit) {
    if (number <= limits_.*limit) return;
    Exceeded(field, absl::StrCat("= ", number, ": must be at most ", limits_.*limit), limit);
  }

  // Requires that `count` times `each`, neither of them negative, is no larger than the limit.
  void Product(absl::string_view field, int64_t count, absl::string_view what, int64_t each, int64_t Limits::*limit) {
    if (count <= limits_.*limit / each) return;
    Exceeded(std::string(field),
             absl::StrCat("asks for ", count, what, each, ": the product must be at most ", limits_.*limit), limit);
  }

  void Scene(const ricochet::Scene& scene);
  void Coordinates(const Mechanism& mechanism, int64_t contacts = 1);

  absl::Status status() const { return exceeded_.empty() ? absl::OkStatus() : LimitExceeded(exceeded_); }

 private:
  void Exceeded(const std::string& field, const std::string& description, int64_t Limits::*limit) {
    if (IsFull(exceeded_)) return;
    const auto* const named =
        std::find_if(std::begin(kLimits), std::end(kLimits), [&](const NamedLimit& l) { return l.value == limit; });
    exceeded_.push_back({field, absl::StrCat(description, ", the limit ", named->name)});
  }

  const Limits& limits_;
  std::vector<Violation> exceeded_;
};

// The links of a linkage, or the coordinates of a mechanism; any other system counts as one.
int64_t LinksOf(const System& system) {
  size_t links = 1;
  if (const auto* const mechanism = std::get_if<Mechanism>(&system)) links = mechanism->rates.size();
  if (const auto* const linkage = std::get_if<Linkage>(&system)) links = linkage->links.size();
  return static_cast<int64_t>(std::max<size_t>(links, 1));
}

// Time grows with the cube of the coordinates, and so with the lists of numbers that they bring along.
void SizeCheck::Coordinates(const Mechanism& mechanism, int64_t contacts) {
  Entries("mechanism.rates", mechanism.rates.size(), &Limits::max_links);
  Entries("mechanism.kept_coordinates", mechanism.kept_coordinates.size(), &Limits::max_links);
  const int64_t most = std::clamp<int64_t>(limits_.max_links, 1, 1'000'000);
  const auto check = [&](const char* field, size_t entries, int64_t most_entries, const auto&... share) {
    if (static_cast<int64_t>(entries) <= most_entries) return;
    Exceeded(field,
             absl::StrCat("has ", entries, " entries: must have at most ", most_entries, ", ", share..., " the limit"),
             &Limits::max_links);
  };
  check("mechanism.mass_matrix", mechanism.mass_matrix.size(), most * most, "the square of");
  check("mechanism.jacobian", mechanism.jacobian.size(), 3 * contacts * most, 3 * contacts, " times");
}

void SizeCheck::Scene(const ricochet::Scene& scene) {
  const auto* const linkage = std::get_if<Linkage>(&scene.system);
  if (linkage != nullptr) Entries("linkage.links", linkage->links.size(), &Limits::max_links);
  const auto* const mechanism = std::get_if<Mechanism>(&scene.system);
  if (mechanism != nullptr) Coordinates(*mechanism);
  // Numbers are visited in order, so that the last one of a list tells its length.
  NumberPath last;
  const auto check_list = [&] {
    if (last.index < limits_.max_list_numbers) return;
    const std::string field = NumberPath{last.prefix, last.entry, last.name}.Text();
    Entries(field, static_cast<size_t>(last.index) + 1, &Limits::max_list_numbers);
  };
  VisitNumbers(scene, [&](const NumberPath& path, double /*number*/, NumberRule /*rule*/) {
    const bool in_list = path.index >= 0;
    if (!in_list || (mechanism != nullptr && std::strcmp(path.prefix, "mechanism") == 0)) return;
    if (path.index == 0) check_list();
    last = path;
  });
  check_list();
}

void CheckDigits(const System& system, int32_t digits, SizeCheck& check) {
  if (digits <= 0) return;
  check.Product("certified_digits", digits, " digits, times the number of links, ", LinksOf(system),
                &Limits::max_digits_times_links);
}

void CheckHistory(const SolveRequest& request, SizeCheck& check) {
  constexpr int64_t kNumbersBesideRates = 4;  // A state has two impulses and two velocities of the contact.
  const int64_t numbers = kNumbersBesideRates + LinksOf(request.scene.system);
  const char* const times = " states, times the numbers of a state, ";
  const auto listed = static_cast<int64_t>(request.history_at_n_s.size());
  check.Product("history_at_n_s", listed, times, numbers, &Limits::max_history_numbers);
  if (request.history_intervals <= 0 || request.history_intervals > kMostIntervals) return;  // Validation refuses it.
  check.Product("history_intervals", request.history_intervals + 1, times, numbers, &Limits::max_history_numbers);
}

void CheckObserved(std::monostate /*unset*/, SizeCheck& /*check*/) {}
void CheckObserved(const ContactVelocity& velocity, SizeCheck& check) {
  check.Entries("contact_velocity.tangential_m_s", velocity.tangential_m_s.size(), &Limits::max_list_numbers);
}
void CheckObserved(const ObservedRates& rates, SizeCheck& check) {
  check.Entries("rates.values", rates.values.size(), &Limits::max_links);
}

void CheckColumns(const AuditColumns& columns, SizeCheck& check) {
  const auto rows = [&](const std::string& field, const std::vector<double>& values) {
    check.Entries("columns." + field, values.size(), &Limits::max_audit_rows);
  };
  for (const NamedAuditColumn& column : kAuditColumns) rows(column.name, columns.*column.values);
  check.Entries("columns.rates_after", columns.rates_after.size(), &Limits::max_links);
  for (size_t i = 0; i < columns.rates_after.size(); ++i) {
    rows(absl::StrCat("rates_after[", i, "].values"), columns.rates_after[i]);
  }
}

void CheckInputs(const std::vector<InputColumn>& inputs, SizeCheck& check) {
  check.Entries("inputs", inputs.size(), &Limits::max_columns);
  for (size_t i = 0; i < inputs.size(); ++i) {
    check.Entries(absl::StrCat("inputs[", i, "].values"), inputs[i].values.size(), &Limits::max_audit_rows);
  }
}

void CheckAxes(const std::vector<Axis>& axes, SizeCheck& check) {
  check.Entries("axes", axes.size(), &Limits::max_axes);
  for (size_t i = 0; i < axes.size(); ++i) {
    const auto* const list = std::get_if<ListValues>(&axes[i].values);
    if (list == nullptr) continue;
    check.Entries(absl::StrCat("axes[", i, "].list.values"), list->values.size(), &Limits::max_axis_values);
  }
}

void CheckDerivatives(const std::optional<DerivativePaths>& paths, SizeCheck& check) {
  if (!paths.has_value() || paths->by.empty()) return;
  check.Product("derivatives.of", static_cast<int64_t>(paths->of.size()), " numbers, times those of by, ",
                static_cast<int64_t>(paths->by.size()), &Limits::max_derivatives);
}

}  // namespace

absl::Status CheckLimits(const SolveRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  CheckHistory(request, check);
  check.Number("force_intervals", request.force_intervals, &Limits::max_force_intervals);
  CheckDigits(request.scene.system, request.certified_digits, check);
  CheckDerivatives(request.derivatives, check);
  return check.status();
}

absl::Status CheckLimits(const PlanRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  return check.status();
}

absl::Status CheckLimits(const BoundsRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  check.Entries("ranges", request.ranges.size(), &Limits::max_ranges);
  CheckDigits(request.scene.system, request.certified_digits, check);
  CheckDerivatives(request.derivatives, check);
  return check.status();
}

absl::Status CheckLimits(const AuditRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  std::visit([&check](const auto& observed) { CheckObserved(observed, check); }, request.observed);
  return check.status();
}

absl::Status CheckLimits(const AuditBatchRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  CheckColumns(request.columns, check);
  CheckInputs(request.inputs, check);
  return check.status();
}

// An iteration of a search computes every measured number and its derivatives by all unknowns and by the inputs that
// have errors. These take memory even in a short fit, so fewer than kFewIterations count as that many.
absl::Status CheckLimits(const FitRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.scene);
  check.Entries("unknowns", request.unknowns.size(), &Limits::max_columns);
  check.Entries("inputs", request.inputs.size(), &Limits::max_columns);
  check.Entries("measured", request.measured.size(), &Limits::max_columns);
  constexpr int32_t kFewIterations = 16;
  int64_t numbers = 0;
  for (const FitMeasured& measured : request.measured) numbers += static_cast<int64_t>(measured.values.size());
  const int64_t starts = std::clamp(request.starts.value_or(kFitStarts), 1, kMostFitStarts);
  const int64_t iterations =
      std::clamp(request.max_iterations.value_or(kFitIterations), kFewIterations, kMostFitIterations);
  check.Product("measured", numbers,
                " numbers, times one, the unknowns and four for each input with errors, starts and max_iterations, ",
                FitSolvesOfARow(request) * starts * iterations, &Limits::max_fit_work);
  return check.status();
}

// The size of an answer and the time for it grow with the cube of the contacts. A curve of outcomes counts as so many
// states.
absl::Status CheckLimits(const MultiContactRequest& request, const Limits& limits) {
  constexpr int64_t kStatesOfCurve = 16;
  SizeCheck check(limits);
  const auto* const free = std::get_if<FreeBodies>(&request.scene.system);
  if (free != nullptr) check.Entries("free_bodies.bodies", free->bodies.size(), &Limits::max_links);
  const auto* const mechanism = std::get_if<Mechanism>(&request.scene.system);
  if (mechanism != nullptr) check.Coordinates(*mechanism, kMostContacts);
  check.Entries("outputs", request.outputs.size(), &Limits::max_columns);
  const auto contacts = static_cast<int64_t>(std::min<size_t>(request.scene.contacts.size(), kMostContacts));
  const int64_t states = std::max<int64_t>(static_cast<int64_t>(request.states.size()), 1);
  const int64_t times = request.stiffness_range.has_value() ? kStatesOfCurve : 1;
  check.Product("states", states * times, " states, times the cube of the number of contacts, ",
                std::max<int64_t>(contacts * contacts * contacts, 1), &Limits::max_contact_states);
  return check.status();
}

absl::Status CheckLimits(const BatchSetup& setup, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(setup.scene);
  check.Entries("fields", setup.fields.size(), &Limits::max_columns);
  check.Entries("columns", setup.columns.size(), &Limits::max_columns);
  return check.status();
}

absl::Status CheckBatchSize(size_t rows, size_t columns, const Limits& limits) {
  SizeCheck check(limits);
  check.Product("inputs", static_cast<int64_t>(rows), " rows, times the columns in or out, ",
                static_cast<int64_t>(columns), &Limits::max_batch_numbers);
  return check.status();
}

absl::Status CheckLimits(const SweepRequest& request, const Limits& limits) {
  SizeCheck check(limits);
  check.Scene(request.grid.scene);
  CheckAxes(request.grid.axes, check);
  check.Entries("columns", request.columns.size(), &Limits::max_columns);
  return check.status();
}

absl::Status CheckLimits(const CostRequest& request, const Limits& limits) {
  if (request.multi_contact.has_value()) {
    return CheckLimits(MultiContactRequest{.scene = *request.multi_contact}, limits);
  }
  SizeCheck check(limits);
  check.Scene(request.scene);
  return check.status();
}

absl::Status CheckPoints(int64_t points, const Limits& limits) {
  if (points <= limits.max_points_per_sweep) return absl::OkStatus();
  return MakeError(
      absl::StatusCode::kResourceExhausted, ErrorReason::kSweepTooLarge,
      absl::StrCat("the sweep has ", points, " points: one call may have at most ", limits.max_points_per_sweep,
                   "; ask for sub-ranges by first_index and end_index (--range)"));
}

}  // namespace ricochet
