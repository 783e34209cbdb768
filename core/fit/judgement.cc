#include "core/fit/judgement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/audit/audit_scene.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/contact/moved_contact.h"
#include "core/fit/search.h"
#include "core/numerics/elementary.h"
#include "core/scene/system_velocities.h"
#include "ricochet/solver.h"

namespace ricochet::fit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// A number is an outlier if normal errors would make any of all numbers one with less than this probability.
constexpr double kOutlierBelow = 0.05;
// Sides that differ by less than this part of the larger one differ by curvature and rounding.
constexpr double kSidesAgree = 0.01;
// Searches that end nearer to each other than this part of sigma, or of the unknown, end in the same place.
constexpr double kSamePlace = 0.1;
constexpr double kSamePart = 1e-3;

void SetRows(const Problem& problem, const std::vector<double>& best, Model& model, FitResponse& response) {
  std::vector<double> predicted;
  std::vector<Regime> regimes(problem.rows);
  model.PredictRows(best, regimes, predicted);
  const std::vector<double> sigmas = model.Sigmas(best);
  FitRow empty = {.predicted = std::vector<double>(problem.columns(), kNone),
                  .residuals = std::vector<double>(problem.columns(), kNone)};
  response.rows.assign(problem.rows, empty);
  for (size_t row = 0; row < problem.rows; ++row) response.rows[row].regime = regimes[row];
  for (size_t i = 0; i < predicted.size(); ++i) {
    const Number& number = problem.numbers[i];
    const double residual = (number.value - predicted[i]) / sigmas[i];
    response.rows[number.row].predicted[number.column] = predicted[i];
    response.rows[number.row].residuals[number.column] = residual;
    const double probability = ChiSquaredBeyond(residual * residual, 1.0);
    if (probability * static_cast<double>(predicted.size()) >= kOutlierBelow) continue;
    response.outliers.push_back({static_cast<int64_t>(number.row), problem.batch.columns[number.column], residual});
  }
  response.objective = ObjectiveAt(best, model);
  std::stable_sort(response.outliers.begin(), response.outliers.end(), [](const FitOutlier& a, const FitOutlier& b) {
    return std::fabs(a.residual) > std::fabs(b.residual);
  });
}

// Returns the largest error in sigmas that counts as possible: normal errors would make any of `rows` velocities exceed
// it with less than the probability at which the data refuse the physics.
double PossibleSigmas(size_t rows) {
  double low = 0.0, high = 40.0;
  constexpr int kEnough = 50;
  for (int i = 0; i < kEnough; ++i) {
    const double middle = 0.5 * (low + high);
    const bool is_possible = ChiSquaredBeyond(middle * middle, 1.0) * static_cast<double>(rows) >= kFitRefusedBelow;
    (is_possible ? low : high) = middle;
  }
  return high;
}

// The velocity of the contact after the impact of a row.
struct MeasuredVelocity {
  ContactVelocity velocity;
  double sigma = 0.0;  // The larger one of its components.
};

// Returns the places, among the problem's numbers, of those that a row measured at the paths, if it measured all.
std::vector<size_t> MeasuredAtAll(const Problem& problem, size_t row, const std::vector<std::string>& paths) {
  std::vector<size_t> places;
  for (const std::string& path : paths) {
    size_t i = problem.first_number[row];
    const size_t end = problem.first_number[row + 1];
    while (i < end && problem.batch.columns[problem.numbers[i].column] != path) ++i;
    if (i == end) return {};
    places.push_back(i);
  }
  return places;
}

std::optional<MeasuredVelocity> VelocityOfContact(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                                  const Scene& scene) {
  std::vector<std::string> paths;
  for (size_t i = 0; i < TangentialDirections(scene.system); ++i) {
    paths.push_back(absl::StrCat("contact_velocity_after.tangential_m_s[", i, "]"));
  }
  paths.emplace_back("contact_velocity_after.normal_m_s");
  const std::vector<size_t> places = MeasuredAtAll(problem, row, paths);
  if (places.empty()) return std::nullopt;
  MeasuredVelocity measured;
  for (const size_t place : places) {
    measured.sigma = std::max(measured.sigma, sigmas[place]);
    measured.velocity.tangential_m_s.push_back(problem.numbers[place].value);
  }
  measured.velocity.tangential_m_s.pop_back();
  measured.velocity.normal_m_s = problem.numbers[places.back()].value;
  return measured;
}

// The contact velocity is linear in the rates, so that the sigma of a rate changes it as the rate itself would.
std::optional<MeasuredVelocity> VelocityByRates(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                                const Scene& scene) {
  const std::vector<size_t> places = MeasuredAtAll(problem, row, SystemVelocityPaths(scene.system));
  if (places.empty()) return std::nullopt;
  std::vector<double> rates;
  for (const size_t place : places) rates.push_back(problem.numbers[place].value);
  MeasuredVelocity measured = {.velocity = ContactVelocityAt(scene, rates)};
  const Components& tangential = measured.velocity.tangential_m_s;
  std::vector<double> spread(tangential.size() + 1);
  for (size_t k = 0; k < rates.size(); ++k) {
    const double rate = rates[k];
    rates[k] += sigmas[places[k]];
    const ContactVelocity beside = ContactVelocityAt(scene, rates);
    rates[k] = rate;
    for (size_t i = 0; i < tangential.size(); ++i) {
      spread[i] = Hypot(spread[i], beside.tangential_m_s[i] - tangential[i]);
    }
    spread.back() = Hypot(spread.back(), beside.normal_m_s - measured.velocity.normal_m_s);
  }
  measured.sigma = *std::max_element(spread.begin(), spread.end());
  return measured;
}

// Returns the velocity if the row measured enough to tell it: that of the contact, those of all bodies or links in a
// plane, or all rates of a mechanism. `sigmas` belong to all measured numbers minus the predicted ones.
std::optional<MeasuredVelocity> VelocityOf(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                           const Scene& scene) {
  std::optional<MeasuredVelocity> measured = VelocityOfContact(problem, sigmas, row, scene);
  return measured.has_value() ? measured : VelocityByRates(problem, sigmas, row, scene);
}

void AuditRows(const Problem& problem, const std::vector<double>& best, Model& model, FitResponse& response) {
  const double possible = PossibleSigmas(problem.rows);
  const std::vector<double> sigmas = model.Sigmas(best);
  for (size_t row = 0; row < problem.rows && !model.Stops(); ++row) {
    const Scene& scene = model.SceneOf(row, best);
    const std::optional<MeasuredVelocity> velocity = VelocityOf(problem, sigmas, row, scene);
    if (!velocity.has_value()) continue;
    const absl::StatusOr<AuditResponse> audit = AuditScene(
        {.scene = scene, .observed = velocity->velocity, .velocity_uncertainty_m_s = possible * velocity->sigma},
        [&model] { return model.Stops(); });
    if (!audit.ok()) continue;
    for (int limit = 1; limit < kAuditLimitCount; ++limit) {
      if (audit->report[static_cast<AuditLimit>(limit)].verdict != Verdict::kBroken) continue;
      response.rows[row].broken_limits.push_back(static_cast<AuditLimit>(limit));
    }
  }
}

void SetThresholds(const Problem& problem, const std::vector<double>& best, Model& model, FitResponse& response) {
  std::vector<double> below, above;
  if (!model.Sides(best, std::vector<bool>(best.size(), true), below, above)) return;
  for (size_t i = 0; i < problem.numbers.size(); ++i) {
    const Number& number = problem.numbers[i];
    for (size_t k = 0; k < best.size(); ++k) {
      const size_t place = i * best.size() + k;
      const double larger = std::max(std::fabs(below[place]), std::fabs(above[place]));
      // A slope that moves the number by less than a small part of its sigma counts as 0.
      const bool matters = larger * problem.scale[k] > kSidesAgree * number.sigma;
      if (!matters || !(std::fabs(above[place] - below[place]) > kSidesAgree * larger)) continue;
      response.thresholds.push_back({static_cast<int64_t>(number.row), problem.batch.columns[number.column],
                                     problem.batch.fields[k], below[place], above[place]});
    }
  }
}

bool StartsDiffer(const Problem& problem, const FitResponse& response) {
  const FitStart* first = nullptr;
  for (const FitStart& start : response.starts) {
    if (!start.converged) continue;
    if (first == nullptr) first = &start;
    for (size_t k = 0; k < problem.unknowns(); ++k) {
      const FitEstimate& estimate = response.unknowns[k];
      const double distance = std::fabs(start.to[k] - first->to[k]);
      if (!estimate.sigma.has_value()) continue;
      if (distance > kSamePlace * *estimate.sigma && distance > kSamePart * std::fabs(first->to[k])) return true;
    }
  }
  return false;
}

bool Chi2IsTooLarge(const FitResponse& response) {
  return response.p_value.has_value() && *response.p_value < kFitRefusedBelow;
}

// --- In sentences ---

std::string WhyUnseen(const FitEstimate& estimate, const std::vector<FitRow>& rows) {
  if (!estimate.row_shares.empty()) return "only a combination with other unknowns changes the measured numbers";
  const auto all = [&rows](std::initializer_list<Regime> regimes) {
    return std::all_of(rows.begin(), rows.end(), [&regimes](const FitRow& row) {
      return std::find(regimes.begin(), regimes.end(), row.regime) != regimes.end();
    });
  };
  if (all({Regime::kSeparating})) return "no row approaches";
  if (all({Regime::kStickInCompression, Regime::kStickInRestitution, Regime::kLocked})) return "all rows stick";
  return "no measured number changes with it";
}

void NoteEnd(const FitEstimate& estimate, const char* which, const FitEnd& end, std::vector<std::string>& notes) {
  if (end.kind != FitEndKind::kCutByBound) return;
  notes.push_back(absl::StrCat("The ", which, " end of the interval of ", estimate.path, " is cut by a bound at ",
                               ShortestDecimal(*end.value), "."));
}

std::string Limits(const FitRow& row) {
  constexpr std::array<const char*, kAuditLimitCount> kNames = {"",
                                                                "energetic coefficient <= 1",
                                                                "kinetic energy gained <= 0",
                                                                "normal impulse >= 0",
                                                                "normal velocity after >= 0",
                                                                "the friction cone"};
  std::string text;
  for (const AuditLimit limit : row.broken_limits) {
    absl::StrAppend(&text, text.empty() ? "" : ", ", kNames[static_cast<size_t>(limit)]);
  }
  return text;
}

// Notes rows in which nothing strikes, because a wrong sign in a table has that effect.
void NoteSeparating(const std::vector<FitRow>& rows, std::vector<std::string>& notes) {
  const auto separates = [](const FitRow& row) { return row.regime == Regime::kSeparating; };
  const auto first = std::find_if(rows.begin(), rows.end(), separates);
  if (first == rows.end()) return;
  const auto count = static_cast<size_t>(std::count_if(first, rows.end(), separates));
  notes.push_back(absl::StrCat("Nothing strikes in ", Counted(count, "row"), ", first in row ", first - rows.begin(),
                               ": the normal velocity before is not negative there."));
}

// An error that all rows share, such as that of a mass weighed once, is not an independent error of each row.
void NoteSharedInputs(const Problem& problem, std::vector<std::string>& notes) {
  for (size_t i = 0; i < problem.inputs.size(); ++i) {
    const std::vector<double>& values = problem.inputs[i];
    const bool is_one = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
    if (problem.input_sigmas[i].empty() || problem.rows < 2 || !is_one) continue;
    notes.push_back(absl::StrCat("The errors of ", problem.batch.fields[problem.unknowns() + i],
                                 " count as independent from row to row, although its value is the same in all."));
  }
}

void SetNotes(const Problem& problem, const Information& information, FitResponse& response) {
  std::vector<std::string>& notes = response.notes;
  NoteSeparating(response.rows, notes);
  NoteSharedInputs(problem, notes);
  if (!response.starts.front().converged) {
    notes.emplace_back("The search from the first start did not converge; more iterations or another start may help.");
  }
  for (size_t k = 0; k < response.unknowns.size(); ++k) {
    const FitEstimate& estimate = response.unknowns[k];
    if (!estimate.seen) {
      notes.push_back(
          absl::StrCat(estimate.path, " is not seen in these data: ", WhyUnseen(estimate, response.rows), "."));
    }
    if (estimate.seen && !estimate.sigma.has_value()) {
      notes.push_back(absl::StrCat(estimate.path,
                                   " has no sigma: at the best fit its derivatives vanish, or are those of a "
                                   "combination with others. The interval holds."));
    }
    if (information.is_at_bound[k]) {
      notes.push_back(absl::StrCat(estimate.path,
                                   " would fit better beyond its bound. Sigma and covariance do not hold there; the "
                                   "interval does."));
    }
    NoteEnd(estimate, "lower", estimate.low, notes);
    NoteEnd(estimate, "upper", estimate.high, notes);
  }
  if (!response.p_value.has_value() && response.chi2 > kAsGood) {
    notes.push_back(
        absl::StrCat("There are no more measured numbers than unknowns, and yet none of the values tried "
                     "gives these numbers: chi2 is ",
                     ShortestDecimal(response.chi2), "."));
  }
  if (Chi2IsTooLarge(response)) {
    notes.push_back(absl::StrCat("The data refuse the physics or the stated errors: chi2 has the probability ",
                                 *response.p_value, "."));
  }
  for (size_t row = 0; row < response.rows.size(); ++row) {
    if (response.rows[row].broken_limits.empty()) continue;
    notes.push_back(absl::StrCat("Row ", row, " breaks what no impact can break: ", Limits(response.rows[row]), "."));
  }
  if (!response.thresholds.empty()) {
    const FitThreshold& first = response.thresholds.front();
    notes.push_back(absl::StrCat("The best fit lies on a threshold: the derivatives of ", first.of, " by ", first.by,
                                 " in row ", first.row,
                                 " differ below and above it. Sigma and covariance do not hold "
                                 "there; the intervals do."));
  }
  if (response.starts_differ) {
    notes.emplace_back(
        "Searches from different starts ended in different places; the best of them is the answer. "
        "Intervals reach over the others that fit within their rise.");
  }
  if (!response.exact_derivatives) {
    notes.push_back(absl::StrCat("Derivatives are central differences, because of ", response.why_differences, "."));
  }
}

void NoteInadmissible(const std::vector<size_t>& rows, FitResponse& response) {
  if (rows.empty()) return;
  response.notes.push_back(absl::StrCat("The best fit itself is inadmissible in ", Counted(rows.size(), "row"),
                                        ", first in row ", rows.front(),
                                        ": there its outcome creates energy, or breaks another limit of mechanics."));
}

}  // namespace

void Judge(const Problem& problem, const std::vector<double>& best, const Information& information, Model& model,
           FitResponse& response) {
  if (model.is_stopped()) return;
  response.covariance = information.covariance;
  response.correlation = information.correlation;
  response.why_differences = problem.why_differences;
  response.exact_derivatives = problem.why_differences.empty();
  SetRows(problem, best, model, response);
  response.interval_rise = kFitRiseOfInterval * information.rise;
  response.degrees_of_freedom = information.degrees_of_freedom;
  response.chi2 = information.chi2;
  response.p_value = PValueOf(information);
  AuditRows(problem, best, model, response);
  response.refused =
      Chi2IsTooLarge(response) || std::any_of(response.rows.begin(), response.rows.end(),
                                              [](const FitRow& row) { return !row.broken_limits.empty(); });
  SetThresholds(problem, best, model, response);
  response.starts_differ = StartsDiffer(problem, response);
  SetNotes(problem, information, response);
  NoteInadmissible(model.Inadmissible(best), response);
}

}  // namespace ricochet::fit
