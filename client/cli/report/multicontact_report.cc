#include "client/cli/report/multicontact_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/types/multi_contact.h"
#include "proto/wire/multi_contact.h"

namespace ricochet::cli {
namespace {

constexpr char kSprings[] = "springs";
// A table of text has no more outcomes than these.
constexpr size_t kMostRows = 12;

std::string EndText(MultiContactEnd end) {
  switch (end) {
    case MultiContactEnd::kSeparated:
      return "separated";
    case MultiContactEnd::kEndless:
      return "endless, its limit";
    case MultiContactEnd::kEndlessEstimate:
      return "endless, estimated";
    case MultiContactEnd::kWedged:
      return "wedged";
    case MultiContactEnd::kBudgetUsedUp:
      return "not ended, on the way";
    case MultiContactEnd::kUndetermined:
      return "undetermined, on the way";
    case MultiContactEnd::kUnspecified:
      break;
  }
  return "";
}

std::string WithUnit(const std::string& name, double value) {
  // A function of the velocities may have any other name.
  const auto has_number_after = [&name](absl::string_view head) {
    absl::string_view rest = name;
    return absl::ConsumePrefix(&rest, head) && !rest.empty() && absl::ascii_isdigit(static_cast<uint8_t>(rest[0]));
  };
  const bool is_of_body = has_number_after("body_");
  const bool is_speed = is_of_body || has_number_after("contact_");
  const bool is_rate = is_of_body && absl::StrContains(name, ".rate");
  return absl::StrCat(Rounded(value), is_rate ? " rad/s" : is_speed ? " m/s" : "");
}

// True if an outcome is known to its end.
bool KnowsAnEnd(const MultiContactAnswer& answer) {
  const auto has_end = [](const AttainedOutcome& outcome) { return HasEnd(outcome.end); };
  return std::any_of(answer.orders.begin(), answer.orders.end(), has_end) ||
         (answer.springs.has_value() && has_end(*answer.springs));
}

// True if the outcomes show that no contact strikes; each order shows it alone.
bool NothingStrikes(const MultiContactAnswer& answer) {
  return !answer.orders.empty() && answer.orders.front().events == 0;
}

std::string VerdictText(const MultiContactAnswer& answer) {
  const bool are_orders =
      !absl::StartsWith(answer.outcome_1, kSprings) && !absl::StartsWith(answer.outcome_2, kSprings);
  const std::string difference = absl::StrCat(
      answer.differing_output, " differs by ", WithUnit(answer.differing_output, answer.difference), " between the ",
      are_orders ? "orders " : "order ", answer.outcome_1, " and ", answer.outcome_2, ".\n");
  switch (answer.verdict) {
    case MultiContactVerdict::kSingle:
      return NothingStrikes(answer) ? "SINGLE: no contact strikes, and nothing changes.\n"
                                    : "SINGLE: only one outcome is possible.\n";
    case MultiContactVerdict::kOrderMatters:
      return absl::StrCat("ORDER_MATTERS: ", difference);
    case MultiContactVerdict::kOrdersAgreeSpringsDiffer:
      return absl::StrCat("ORDERS_AGREE_SPRINGS_DIFFER: all orders end alike, but ", difference);
    case MultiContactVerdict::kOrdersAgree:
      return "ORDERS_AGREE: all outcomes that were computed are alike. This does not prove that no other is "
             "possible.\n";
    case MultiContactVerdict::kUnspecified:
      break;
  }
  if (answer.orders.empty() && !answer.springs.has_value()) return "Undecided: no outcome was computed.\n";
  if (answer.orders.empty() && KnowsAnEnd(answer)) return "Undecided: springs alone were followed.\n";
  if (!answer.differing_output.empty()) {
    return absl::StrCat("Undecided: some orders were not followed to their end, or the errors are large; ", difference);
  }
  return KnowsAnEnd(answer)
             ? "Undecided: the outcomes that ended do not differ by more than their errors, but others could "
               "not be found, or the errors are large.\n"
             : "Undecided: no outcome was followed to its end.\n";
}

// Returns every outcome with its name, those of orders first.
std::vector<std::pair<std::string, const AttainedOutcome*>> OutcomesOf(const MultiContactAnswer& answer) {
  std::vector<std::pair<std::string, const AttainedOutcome*>> all;
  for (const AttainedOutcome& outcome : answer.orders) {
    std::string name = absl::StrJoin(outcome.orders, ", ");
    const auto more = outcome.order_count - static_cast<int64_t>(outcome.orders.size());
    if (more > 0) absl::StrAppend(&name, " and ", more, " more");
    all.emplace_back(std::move(name), &outcome);
  }
  if (answer.springs.has_value()) all.emplace_back(kSprings, &*answer.springs);
  return all;
}

double LargestError(const AttainedOutcome& outcome) {
  const std::vector<double>& errors =
      outcome.velocity.empty() ? outcome.contact_velocity_error_m_s : outcome.velocity_error;
  return *std::max_element(errors.begin(), errors.end());
}

// The numbers that the text shows: the velocities of the system, or of the contacts alone.
std::vector<double> Shown(const AttainedOutcome& outcome) {
  return outcome.velocity.empty() ? outcome.contact_velocity_m_s : outcome.velocity;
}

// Returns the outcomes that the text shows: the first ones, and springs in any case.
std::vector<std::pair<std::string, const AttainedOutcome*>> ShownOutcomes(const MultiContactAnswer& answer) {
  auto outcomes = OutcomesOf(answer);
  if (outcomes.size() <= kMostRows) return outcomes;
  if (answer.springs.has_value()) std::swap(outcomes[kMostRows - 1], outcomes.back());
  outcomes.resize(kMostRows);
  return outcomes;
}

std::string OutcomesText(const MultiContactRequest& request, const MultiContactAnswer& answer) {
  const auto outcomes = ShownOutcomes(answer);
  if (outcomes.empty()) return "";
  const std::vector<std::string> names = OutputNames(request);
  const auto shown = static_cast<std::ptrdiff_t>(Shown(*outcomes.front().second).size());
  std::vector<std::string> header = {"", "ends", "events"};
  header.insert(header.end(), names.end() - shown, names.end());
  header.emplace_back("error");
  Table table;
  table.Add(header);
  for (const auto& [name, outcome] : outcomes) {
    std::vector<std::string> row = {name, EndText(outcome->end), absl::StrCat(outcome->events)};
    for (const double value : Shown(*outcome)) row.push_back(Rounded(value));
    row.push_back(absl::StrFormat("%s%.1e", outcome->error_is_proved ? "<= " : "about ", LargestError(*outcome)));
    table.Add(row);
  }
  std::string text = absl::StrCat("\nOutcomes (velocities after, m/s and rad/s)\n", table.Render(2));
  const size_t all = answer.orders.size() + (answer.springs.has_value() ? 1 : 0);
  if (all > outcomes.size()) absl::StrAppend(&text, "  and ", all - outcomes.size(), " more: --format json has all\n");
  return text;
}

std::string LedgerText(const MultiContactAnswer& answer) {
  Table table;
  table.Add({"", "contact", "normal impulse [N s]", "compression [J]", "restitution [J]", "friction [J]", "Newton",
             "Poisson"});
  const auto outcomes = ShownOutcomes(answer);
  for (const auto& [name, shown] : outcomes) {
    const AttainedOutcome& outcome = *shown;
    const size_t directions =
        outcome.contacts.empty() ? 2 : outcome.contact_velocity_m_s.size() / outcome.contacts.size();
    const auto cell = [](std::optional<double> value) { return value.has_value() ? Rounded(*value) : ""; };
    for (size_t c = 0; c < outcome.contacts.size(); ++c) {
      const ContactLedger& ledger = outcome.contacts[c];
      table.Add({c == 0 ? name : "", absl::StrCat(c + 1), Rounded(outcome.impulse_n_s[directions * (c + 1) - 1]),
                 Rounded(ledger.work_compression_j), Rounded(ledger.work_restitution_j),
                 Rounded(ledger.work_friction_j), cell(ledger.newton), cell(ledger.poisson)});
    }
  }
  std::string text = outcomes.empty() ? "" : absl::StrCat("\nWhat each contact did\n", table.Render(2));
  for (const auto& [name, outcome] : outcomes) {
    const bool are_known = std::isfinite(outcome->work_error_j) && !outcome->normal_impulse_error_n_s.empty();
    if (!outcome->contacts.empty() && !are_known) {
      absl::StrAppend(&text, "  The impulses and works of ", name, " have errors that are not known.\n");
    }
  }
  return text;
}

std::string PossibleText(const MultiContactAnswer& answer) {
  if (answer.possible.empty()) return "";
  Table table;
  for (const PossibleRange& range : answer.possible) {
    // An end of a range that is only rounding beside the other end is shown as 0.
    const double rounding = 1e-12 * std::max(std::abs(range.lower), std::abs(range.upper));
    const auto shown = [&](double end) { return std::abs(end) <= rounding ? 0.0 : end; };
    table.Add(
        {range.output, absl::StrCat(Rounded(shown(range.lower)), " ... ", WithUnit(range.output, shown(range.upper)))});
  }
  return absl::StrCat("\nNo outcome lies outside\n", table.Render(2));
}

std::string PairsText(const MultiContactAnswer& answer) {
  std::string text;
  for (const ContactPair& pair : answer.pairs) {
    absl::StrAppend(&text, "  contacts ", pair.contact_1, " and ", pair.contact_2,
                    ": cos(theta) = ", Rounded(pair.cosine));
    if (pair.divisor.has_value()) absl::StrAppend(&text, ", theta = pi/", *pair.divisor);
    text += "\n";
  }
  return text.empty() ? "" : absl::StrCat("\nHow the contacts are coupled\n", text);
}

std::string CurveText(const MultiContactAnswer& answer) {
  if (answer.stiffness_samples.empty()) return "";
  std::string text =
      absl::StrCat("\nOver relative stiffnesses from ", Rounded(answer.stiffness_samples.front().relative_stiffness),
                   " to ", Rounded(answer.stiffness_samples.back().relative_stiffness), ": ",
                   answer.stiffness_samples.size(), " outcomes of springs, which csv and json have");
  const auto unended = std::count_if(answer.stiffness_samples.begin(), answer.stiffness_samples.end(),
                                     [](const StiffnessSample& sample) { return !HasEnd(sample.outcome.end); });
  if (unended > 0) absl::StrAppend(&text, "; ", unended, " of them have not ended, and count for no jump");
  for (const StiffnessJump& jump : answer.stiffness_jumps) {
    absl::StrAppend(&text, "; a jump between ", ShortestDecimal(jump.low), " and ", ShortestDecimal(jump.high));
  }
  return text + (answer.stiffness_jumps.empty() ? "; no jump\n" : "\n");
}

std::string RefusedText(const MultiContactAnswer& answer) {
  std::string text;
  for (const RefusedMethod& refused : answer.refused) absl::StrAppend(&text, "Left out: ", refused.reason, ".\n");
  if (answer.jams) text += "The contacts may jam: impulses within the cones of friction exist that move nothing.\n";
  return text.empty() ? "" : "\n" + text;
}

// Adds the names and the values of a row of numbers.
void AddNumbers(const std::vector<std::string>& names, const std::string& ending, const std::vector<double>& values,
                CsvRow& row) {
  for (size_t i = 0; i < names.size(); ++i) {
    row.Number(names[i] + ending, i < values.size() ? std::optional(values[i]) : std::nullopt);
  }
}

// Adds a row with the columns of an outcome. `numbers` are the values of the outputs, and then those of the functions
// that the request asks for, which an end of the bounds alone has. Such an end has no other numbers: its outcome is
// empty.
void AddRow(const MultiContactRequest& request, size_t state, const std::string& name, std::optional<double> stiffness,
            const AttainedOutcome& outcome, const std::vector<double>& numbers, std::vector<CsvRow>& rows) {
  CsvRow& row = rows.emplace_back();
  row.Integer("state", static_cast<int64_t>(state));
  row.Quoted("outcome", name);
  row.Number("relative_stiffness", stiffness);
  const bool is_outcome = outcome.end != MultiContactEnd::kUnspecified;
  row.Words("end", is_outcome ? EnumName(outcome.end) : "");
  row.Integer("events", is_outcome ? std::optional(outcome.events) : std::nullopt);
  row.Words("error_is_proved", !is_outcome ? "" : outcome.error_is_proved ? "true" : "false");
  std::vector<double> errors = outcome.contact_velocity_error_m_s;
  errors.insert(errors.end(), outcome.velocity_error.begin(), outcome.velocity_error.end());
  const std::vector<std::string> names = OutputNames(request);
  AddNumbers(names, "", numbers, row);
  AddNumbers(names, ".error", errors, row);
  AddNumbers(ContactOutputNames(request.scene.contacts.size(), DirectionsOf(request.scene)), ".impulse_n_s",
             outcome.impulse_n_s, row);
  std::vector<std::string> contacts;
  for (size_t i = 1; i <= request.scene.contacts.size(); ++i) contacts.push_back(absl::StrCat("contact_", i));
  AddNumbers(contacts, ".n.impulse_n_s.error", outcome.normal_impulse_error_n_s, row);
  row.Number("work_error_j", is_outcome ? std::optional(outcome.work_error_j) : std::nullopt);
  row.Number("energy_change_j", is_outcome ? std::optional(outcome.energy_change_j) : std::nullopt);
  std::vector<std::string> functions;
  for (const LinearOutput& output : request.outputs) AppendCsv(output.name, functions.emplace_back());
  const auto outputs = static_cast<std::ptrdiff_t>(std::min(names.size(), numbers.size()));
  AddNumbers(functions, "", {numbers.begin() + outputs, numbers.end()}, row);
}

void AddAnswer(const MultiContactRequest& request, const MultiContactAnswer& answer, size_t state,
               std::vector<CsvRow>& rows) {
  for (const auto& [name, outcome] : OutcomesOf(answer)) {
    AddRow(request, state, name, std::nullopt, *outcome, NumbersOf(*outcome), rows);
  }
  for (const auto& [stiffness, outcome] : answer.stiffness_samples) {
    AddRow(request, state, kSprings, stiffness, outcome, NumbersOf(outcome), rows);
  }
  if (answer.possible.empty()) return;
  std::vector<double> lower, upper;
  for (const PossibleRange& range : answer.possible) {
    lower.push_back(range.lower);
    upper.push_back(range.upper);
  }
  AddRow(request, state, "possible, lower", std::nullopt, {}, lower, rows);
  AddRow(request, state, "possible, upper", std::nullopt, {}, upper, rows);
}

}  // namespace

std::vector<std::string> OutputNames(const MultiContactRequest& request) {
  const int directions = DirectionsOf(request.scene);
  std::vector<std::string> names = ContactOutputNames(request.scene.contacts.size(), directions);
  for (std::string& name : SystemOutputNames(request.scene.system, directions)) names.push_back(std::move(name));
  return names;
}

std::vector<double> NumbersOf(const AttainedOutcome& outcome) {
  std::vector<double> numbers = outcome.contact_velocity_m_s;
  numbers.insert(numbers.end(), outcome.velocity.begin(), outcome.velocity.end());
  return numbers;
}

std::string MultiContactText(const MultiContactRequest& request, const MultiContactResponse& response) {
  std::string text;
  if (!std::holds_alternative<FreeBodies>(request.scene.system)) {
    // Six rows may be those of three contacts in a plane or of two in space.
    const bool in_plane = DirectionsOf(request.scene) == 2;
    text = absl::StrCat(Counted(request.scene.contacts.size(), "contact"),
                        in_plane ? " in a plane: rows t, n of each.\n\n" : " in space: rows t1, t2, n of each.\n\n");
  }
  for (size_t state = 0; state < response.answers.size(); ++state) {
    const MultiContactAnswer& answer = response.answers[state];
    if (response.answers.size() > 1) absl::StrAppend(&text, state > 0 ? "\n" : "", "State ", state + 1, "\n\n");
    absl::StrAppend(&text, VerdictText(answer), OutcomesText(request, answer), LedgerText(answer), PossibleText(answer),
                    PairsText(answer), CurveText(answer), RefusedText(answer));
  }
  return text;
}

std::string MultiContactCsv(const MultiContactRequest& request, const MultiContactResponse& response) {
  std::vector<CsvRow> rows;
  for (size_t state = 0; state < response.answers.size(); ++state) {
    AddAnswer(request, response.answers[state], state, rows);
  }
  return CsvOf(rows);
}

}  // namespace ricochet::cli
