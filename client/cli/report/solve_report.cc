#include "client/cli/report/solve_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/algorithm/container.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/report/plan_report.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "proto/wire/outcome.h"

namespace ricochet::cli {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// Ends a line, if there is one.
std::string LineOf(const std::string& text) { return text.empty() ? "" : text + "\n"; }

std::string IfKnown(const std::optional<double>& value) { return value.has_value() ? Rounded(*value) : "unknown"; }

const char* LimitText(LimitKind kind) {
  switch (kind) {
    case LimitKind::kSharp:
      return "energetic coefficient";
    case LimitKind::kEnergy:
      return "kinetic energy created [J]";
    case LimitKind::kFriction:
      return "work of friction [J]";
    case LimitKind::kUnspecified:
      break;
  }
  return "?";
}

const char* RegimeSentence(Regime regime) {
  switch (regime) {
    case Regime::kFrictionless:
      return "Frictionless: friction is left out, or does not couple normal and tangential motion.";
    case Regime::kRebound:
      return "Rebound: slip reverses at the end of compression; the contact parts if e > 0.";
    case Regime::kSliding:
      return "Sliding: slip never stops.";
    case Regime::kStickInCompression:
      return "Slip stops in compression and the contact sticks.";
    case Regime::kStickInRestitution:
      return "Slip stops in restitution and the contact sticks.";
    case Regime::kReversalInCompression:
      return "Slip reverses in compression.";
    case Regime::kReversalInRestitution:
      return "Slip reverses in restitution.";
    case Regime::kLocked:
      return "Locked: friction and the pin hold the body; it does not rebound.";
    case Regime::kWedged:
      return "Wedged: the contact had not separated when the computation ended.";
    case Regime::kSeparating:
      return "Separating: the contact does not approach; nothing changes.";
    case Regime::kByLaw:
      return "Impact law: it gives the end of the impact, but not its phases.";
    case Regime::kNoSolution:
      return "No solution: the impact law has no solution for this contact.";
    case Regime::kUnspecified:
    case Regime::kInvalid:
      break;
  }
  return "Unknown: the server answered with a regime that this build does not know.";
}

// `outcome` is an Outcome or a FreeEnd.
template <typename End>
std::string Verdict(const End& outcome) {
  // An impact without an end has no outcome to judge.
  if (!HasEnd(outcome.termination)) return "";
  if (outcome.admissible) return "Admissible.\n";
  const auto breaks = [&outcome](LimitKind kind) {
    return std::any_of(outcome.broken_limits.begin(), outcome.broken_limits.end(),
                       [kind](const BrokenLimit& broken) { return broken.kind == kind; });
  };
  std::vector<const char*> causes;
  if (breaks(LimitKind::kSharp)) causes.push_back("the coefficient would return more energy than the impact stored");
  if (breaks(LimitKind::kFriction)) causes.push_back("friction would push along the slip");
  if (causes.empty()) causes.push_back("the impact would create kinetic energy");
  const std::string text = absl::StrCat("INADMISSIBLE: ", absl::StrJoin(causes, ", and "), ".\n");
  Table table;
  table.Add({"broken limit", "value", "limit", "excess"});
  for (const BrokenLimit& broken : outcome.broken_limits) {
    table.Add({LimitText(broken.kind), Rounded(broken.value), Rounded(broken.limit), Rounded(broken.excess)});
  }
  return absl::StrCat(text, table.Render(2));
}

std::string CoefficientsText(const Outcome& outcome) {
  const Coefficients& coefficients = outcome.coefficients;
  const EffectiveCoefficients& effective = outcome.effective;
  // Nothing strikes, so that ratios of after and before are undefined; outcomes hold 0 there.
  if (outcome.regime == Regime::kSeparating) return "Coefficients\n  none: nothing strikes\n";
  if (!HasEnd(outcome.termination)) return "Coefficients\n  none: the impact has no end that is known\n";
  Table table;
  table.Add({"Newton      (velocities, -v+/v-)", Rounded(coefficients.newton)});
  table.Add({"Poisson     (normal impulses)", IfKnown(coefficients.poisson)});
  table.Add({"energetic   (normal works)", IfKnown(coefficients.energetic)});
  table.Add({"tangential  (Brach, f/tau)", Rounded(coefficients.tangential)});
  const std::string restitution = effective.restitution.has_value()
                                      ? absl::StrCat("restitution ", Rounded(*effective.restitution))
                                      : "the damping of the spring";
  const bool is_smooth = absl::c_linear_search(LeftOut(outcome.plan), EffectWord(Effect::kFriction));
  const std::string friction = is_smooth ? "out friction, "
                                         : absl::StrCat(" friction ", Rounded(effective.kinetic_friction), " (static ",
                                                        Rounded(effective.static_friction), "), ");
  return absl::StrCat("Coefficients\n", table.Render(2), "  computed with", friction, restitution, "\n");
}

// Appends the numbers of a list as cells, one for each tangential direction or angular velocity.
void AppendCells(const Components& values, std::vector<std::string>& cells) {
  for (const double value : values) cells.push_back(Rounded(value));
}

void AddMotion(const std::string& name, const Components& before, const Components& after, Table& table) {
  for (size_t i = 0; i < after.size(); ++i) {
    const std::string number = after.size() == 1 ? "" : absl::StrCat(" ", i + 1);
    const std::optional<double> known = i < before.size() ? std::optional(before[i]) : std::nullopt;
    table.Add({absl::StrCat(name, number), IfKnown(known), Rounded(after[i])});
  }
}

// Returns two significant digits of a number that is at least `value`.
std::string RoundedUp(double value) {
  if (!(value > 0.0) || std::isinf(value)) return Rounded(value);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return Rounded(std::ceil(value / unit * (1.0 - 1e-12)) * unit);  // The factor undoes the rounding of the quotient.
}

std::string AccuracyText(const Outcome& outcome) {
  const Accuracy& accuracy = outcome.accuracy;
  if (std::isinf(accuracy.relative_error)) return "  relative error of the contact velocity: not known\n";
  const double tolerance = outcome.plan.relative_tolerance;
  // The error excludes the rounding of W and of the contact velocity where these are computed from other numbers.
  const bool is_reduced =
      !outcome.bodies_after.empty() || !outcome.rates_after.empty() || outcome.rates_after_rad_s.size() > 1;
  std::string text = absl::StrCat("  relative error of the contact velocity <= ", RoundedUp(accuracy.relative_error),
                                  accuracy.kind != AccuracyKind::kBound ? " (estimated)"
                                  : is_reduced                          ? " (proved, for W as rounded)"
                                                                        : " (proved)");
  if (accuracy.steps > 0) absl::StrAppend(&text, ", ", accuracy.steps, " steps");
  // Tolerance 0 asks for all effects, in double precision.
  if (tolerance > 0.0 && accuracy.relative_error > tolerance) {
    absl::StrAppend(&text, ", above the tolerance of ", Rounded(tolerance));
  }
  return text + "\n";
}

std::string MotionText(const Outcome& outcome) {
  // A contact that separates has no timeline, and nothing changes.
  State before{.contact_velocity = outcome.contact_velocity_after, .rates_rad_s = outcome.rates_after_rad_s};
  if (!outcome.timeline.empty()) before = outcome.timeline.front().state;
  Table table;
  table.Add({"", "before", "after"});
  AddMotion("angular velocity [rad/s]", before.rates_rad_s, outcome.rates_after_rad_s, table);
  AddMotion("contact, tangential [m/s]", before.contact_velocity.tangential_m_s,
            outcome.contact_velocity_after.tangential_m_s, table);
  AddMotion("contact, normal [m/s]", {before.contact_velocity.normal_m_s}, {outcome.contact_velocity_after.normal_m_s},
            table);
  return absl::StrCat("Motion\n", table.Render(2), AccuracyText(outcome), LeftOutText(outcome.plan));
}

std::string BodiesText(absl::Span<const BodyVelocity> bodies) {
  if (bodies.empty()) return "";
  const bool in_space = bodies.front().linear_m_s.size() == 3;
  Table table;
  table.Add(in_space ? std::vector<std::string>{"", "v1 [m/s]", "v2 [m/s]", "vn [m/s]", "w1 [rad/s]", "w2 [rad/s]",
                                                "wn [rad/s]"}
                     : std::vector<std::string>{"", "vt [m/s]", "vn [m/s]", "w [rad/s]"});
  for (size_t i = 0; i < bodies.size(); ++i) {
    std::vector<std::string> cells = {absl::StrCat("body ", i + 1)};
    AppendCells(bodies[i].linear_m_s, cells);
    AppendCells(bodies[i].angular_rad_s, cells);
    table.Add(cells);
  }
  return absl::StrCat("\nBodies after\n", table.Render(2));
}

// The motion of a mechanism, in the units of its coordinates.
std::string CoordinatesText(const Outcome& outcome) {
  if (outcome.rates_after.empty()) return "";
  const bool has_free_end = outcome.free_end.has_value();
  Table table;
  table.Add({"coordinate", "rate", "error <=", "momentum taken", has_free_end ? "rate, none held" : ""});
  for (size_t i = 0; i < outcome.rates_after.size(); ++i) {
    const double error = outcome.errors.rates_after[i];
    table.Add({absl::StrCat(i), Rounded(outcome.rates_after[i]), std::isinf(error) ? "unknown" : RoundedUp(error),
               Rounded(outcome.momentum_change[i]), has_free_end ? Rounded(outcome.free_end->rates_after[i]) : ""});
  }
  return absl::StrCat("\nMechanism after\n", table.Render(2));
}

// Compares the end of the mechanism as stated with that in which no coordinate is held.
std::string EndsText(const Outcome& outcome) {
  if (!outcome.free_end.has_value()) return "";
  const FreeEnd& free = *outcome.free_end;
  Table table;
  table.Add({"", "as held", "none held"});
  AddMotion("contact, tangential [m/s]", outcome.contact_velocity_after.tangential_m_s,
            free.contact_velocity_after.tangential_m_s, table);
  AddMotion("contact, normal [m/s]", {outcome.contact_velocity_after.normal_m_s},
            {free.contact_velocity_after.normal_m_s}, table);
  AddMotion("tangential impulse [N s]", outcome.impulse.tangential_n_s, free.impulse.tangential_n_s, table);
  AddMotion("normal impulse [N s]", {outcome.impulse.normal_total_n_s}, {free.impulse.normal_total_n_s}, table);
  AddMotion("Newton's coefficient", {outcome.coefficients.newton}, {free.coefficients.newton}, table);
  return absl::StrCat("\nBoth ends\n", table.Render(2), "  With nothing held: ", RegimeSentence(free.regime), "\n",
                      LineOf(TerminationText(free.termination)), Verdict(free));
}

// Lists every solution of an impact law that can have several.
std::string AlternativesText(const Outcome& outcome) {
  const std::vector<ImpactSolution>& alternatives = outcome.alternatives;
  if (alternatives.empty()) return "";
  Table table;
  table.Add({"", "u [m/s]", "v [m/s]", "f [N s]", "tau [N s]"});
  for (size_t i = 0; i < alternatives.size(); ++i) {
    std::vector<std::string> cells = {absl::StrCat(i + 1)};
    AppendCells(alternatives[i].contact_velocity_after.tangential_m_s, cells);
    cells.push_back(Rounded(alternatives[i].contact_velocity_after.normal_m_s));
    AppendCells(alternatives[i].impulse.tangential_n_s, cells);
    cells.push_back(Rounded(alternatives[i].impulse.normal_total_n_s));
    table.Add(cells);
  }
  return absl::StrCat("\nEnds of the range of solutions\n", table.Render(2));
}

std::string ImpulseText(const Impulse& impulse) {
  Table table;
  table.Add({"normal, in compression [N s]", IfKnown(impulse.normal_compression_n_s)});
  table.Add({"normal, total [N s]", Rounded(impulse.normal_total_n_s)});
  const Components& tangential = impulse.tangential_n_s;
  for (size_t i = 0; i < tangential.size(); ++i) {
    const std::string number = tangential.size() == 1 ? "" : absl::StrCat(" ", i + 1);
    table.Add({absl::StrCat("tangential, total [N s]", number), Rounded(tangential[i])});
  }
  return absl::StrCat("Impulse on the body\n", table.Render(2));
}

std::string WorkText(const Outcome& outcome, bool surface_moves) {
  const WorkLedger& work = outcome.work;
  Table table;
  table.Add({"[J]", "compression", "restitution", "total"});
  table.Add(
      {"normal", IfKnown(work.normal_compression_j), IfKnown(work.normal_restitution_j), Rounded(work.normal_total_j)});
  table.Add({"tangential", IfKnown(work.tangential_compression_j), IfKnown(work.tangential_restitution_j),
             Rounded(work.tangential_total_j)});
  if (work.tangential_spring_j > 0.0) {
    table.Add({"  left in the spring", "", "", Rounded(-work.tangential_spring_j)});
    table.Add({"  lost to friction", "", "", Rounded(-work.friction_dissipation_j)});
  }
  const char* change = outcome.contact.has_value() ? "work of all contact forces"
                       : surface_moves             ? "change of kinetic energy, with the surface's"
                                                   : "change of kinetic energy";
  table.Add({change, "", "", Rounded(outcome.energy_change_j)});
  return absl::StrCat("Work on the body\n", table.Render(2));
}

std::string ContactText(const ContactDuration& contact) {
  Table table;
  table.Add({"duration [s]", Rounded(contact.duration_s)});
  table.Add({"largest normal force [N]", Rounded(contact.peak_normal_n)});
  table.Add({"largest tangential force [N]", Rounded(contact.peak_tangential_n)});
  table.Add({"largest indentation [m]", Rounded(contact.indentation_m)});
  std::string text = absl::StrCat("\nContact\n", table.Render(2));
  if (contact.history.empty()) return text;
  Table samples;
  samples.Add({"t [s]", "F [N]", "N [N]", "d [m]", "u [m/s]", "v [m/s]"});
  for (const ForceSample& sample : contact.history) {
    samples.Add({Rounded(sample.time_s), Rounded(sample.tangential_n), Rounded(sample.normal_n),
                 Rounded(sample.indentation_m), Rounded(sample.tangential_m_s), Rounded(sample.normal_m_s)});
  }
  return absl::StrCat(text, "\nForces\n", samples.Render(2));
}

std::vector<std::string> StateCells(const std::string& name, const State& state) {
  std::vector<std::string> cells = {name, Rounded(state.normal_impulse_n_s)};
  AppendCells(state.tangential_impulse_n_s, cells);
  AppendCells(state.contact_velocity.tangential_m_s, cells);
  cells.push_back(Rounded(state.contact_velocity.normal_m_s));
  AppendCells(state.rates_rad_s, cells);
  return cells;
}

std::string StatesText(const char* title, const Table& table) {
  return absl::StrCat("\n", title, "\n", table.Render(2));
}

// Appends the names of a list's entries: "u [m/s]" for one entry, "u1 [m/s]" and "u2 [m/s]" for two.
void AppendNames(const std::string& symbol, const std::string& unit, size_t count, std::vector<std::string>& names) {
  for (size_t i = 0; i < count; ++i) {
    names.push_back(absl::StrCat(symbol, count == 1 ? "" : absl::StrCat(i + 1), " [", unit, "]"));
  }
}

// Returns a table with the header for states like `state`.
Table StateTable(const State& state) {
  std::vector<std::string> names = {"", "tau [N s]"};
  AppendNames("f", "N s", state.tangential_impulse_n_s.size(), names);
  AppendNames("u", "m/s", state.contact_velocity.tangential_m_s.size(), names);
  names.emplace_back("v [m/s]");
  AppendNames("w", "rad/s", state.rates_rad_s.size(), names);
  Table table;
  table.Add(names);
  return table;
}

// Returns the notes, which say what no number of the outcome shows.
std::string NotesText(const std::vector<Note>& notes) {
  std::string text;
  for (const Note& note : notes) absl::StrAppend(&text, "Note: ", note.text, "\n");
  return text;
}

// --- CSV: reflection visits the fields of the outcome's proto, so that a new field gets its column automatically. ---

// Appends the fields of a message. Those of one that `is_unset` have empty cells.
void AppendFields(const Message& message, const std::string& prefix, bool is_unset, CsvRow& row);

void AppendSingle(const Message& message, const FieldDescriptor* field, const std::string& path, bool is_unset,
                  CsvRow& row) {
  const Reflection& reflection = *message.GetReflection();
  const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  is_unset = is_unset || ((is_message || field->has_optional_keyword()) && !reflection.HasField(message, field));
  if (is_message) {
    if (field->message_type() == v1::Certificate::descriptor()) return;
    // These columns exist only if the answer has a free end, which a request has to ask for.
    if (field->message_type() == v1::FreeEnd::descriptor() && !reflection.HasField(message, field)) return;
    return AppendFields(reflection.GetMessage(message, field), absl::StrCat(path, "."), is_unset, row);
  }
  if (is_unset) return row.Words(path, "");
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return row.Number(path, reflection.GetDouble(message, field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return row.Truth(path, reflection.GetBool(message, field));
    case FieldDescriptor::CPPTYPE_INT32:
      return row.Integer(path, reflection.GetInt32(message, field));
    case FieldDescriptor::CPPTYPE_INT64:
      return row.Integer(path, reflection.GetInt64(message, field));
    default:
      return row.Words(path, BareName(*reflection.GetEnum(message, field)));
  }
}

void AppendFields(const Message& message, const std::string& prefix, bool is_unset, CsvRow& row) {
  const Reflection& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor* field = message.GetDescriptor()->field(i);
    const std::string path = absl::StrCat(prefix, field->name());
    if (!field->is_repeated()) {
      AppendSingle(message, field, path, is_unset, row);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      for (int j = 0; j < reflection.FieldSize(message, field); ++j) {
        row.Number(absl::StrCat(path, "[", j, "]"), reflection.GetRepeatedDouble(message, field, j));
      }
    } else if (field->message_type() == v1::BodyVelocity::descriptor()) {
      // Other lists of messages are left out: their length depends on the events of the impact.
      for (int j = 0; j < reflection.FieldSize(message, field); ++j) {
        AppendFields(reflection.GetRepeatedMessage(message, field, j), absl::StrCat(path, "[", j, "]."), is_unset, row);
      }
    }
  }
}

CsvRow RowOf(const Message& message) {
  CsvRow row;
  AppendFields(message, "", /*is_unset=*/false, row);
  return row;
}

// Returns a header and one row for each message.
template <typename Messages>
std::string RowsOf(const Messages& messages) {
  std::vector<CsvRow> rows;
  for (const auto& message : messages) rows.push_back(RowOf(message));
  return CsvOf(rows);
}

}  // namespace

const char* TerminationText(Termination termination) {
  switch (termination) {
    case Termination::kBudgetUsedUp:
      return "Not converged: the model's budget of steps ran out before the contact separated.";
    case Termination::kRefused:
      return "No answer: the impact has no end that is known, and what follows is the state that was reached.";
    case Termination::kLessAccurate:
      return "Less accurate than asked: the stated error exceeds the tolerance.";
    case Termination::kUnspecified:
    case Termination::kConverged:
      break;
  }
  return "";
}

const char* EventText(EventKind kind) {
  switch (kind) {
    case EventKind::kStart:
      return "contact starts";
    case EventKind::kSlipStops:
      return "slip stops";
    case EventKind::kCompressionEnds:
      return "compression ends";
    case EventKind::kRestitutionEnds:
      return "restitution ends";
    case EventKind::kSlipStarts:
      return "slip starts";
    case EventKind::kStickStarts:
      return "stick starts";
    case EventKind::kEndRecedes:
      return "the end recedes";
    case EventKind::kUnspecified:
      break;
  }
  return "?";
}

bool IsOnTangentialSpring(const Outcome& outcome) {
  const std::vector<PlannedEffect> effects = outcome.plan.effects.List();
  return std::any_of(effects.begin(), effects.end(), [](const PlannedEffect& effect) {
    return effect.effect == Effect::kTangentialCompliance &&
           (effect.decision == Decision::kSimulated || effect.decision == Decision::kRequired);
  });
}

// On a tangential spring the contact moves on after the particle that touches the surface has stuck.
std::string WhatHappens(const Outcome& outcome) {
  const bool sticks = outcome.regime == Regime::kStickInCompression || outcome.regime == Regime::kStickInRestitution;
  if ((!sticks && outcome.regime != Regime::kSliding) || !IsOnTangentialSpring(outcome)) {
    return RegimeSentence(outcome.regime);
  }
  if (!sticks) return "Sliding: the contact particle, which the tangential spring holds, never sticks.";
  return absl::StrCat(RegimeSentence(outcome.regime), " Its tangential spring moves it on.");
}

std::string SolveText(const Outcome& outcome, bool surface_moves) {
  std::string text = absl::StrCat(WhatHappens(outcome), "\n", LineOf(TerminationText(outcome.termination)),
                                  Verdict(outcome), NotesText(outcome.notes), "\n", CoefficientsText(outcome), "\n",
                                  MotionText(outcome), BodiesText(outcome.bodies_after), CoordinatesText(outcome), "\n",
                                  ImpulseText(outcome.impulse), "\n", WorkText(outcome, surface_moves));
  if (outcome.contact.has_value()) text += ContactText(*outcome.contact);
  text += EndsText(outcome);
  text += AlternativesText(outcome);
  if (!outcome.timeline.empty()) {
    const State& start = outcome.timeline.front().state;
    Table table = StateTable(start);
    for (const Event& event : outcome.timeline) table.Add(StateCells(EventText(event.kind), event.state));
    absl::StrAppend(
        &text,
        StatesText(IsLinearBetweenEvents(outcome.plan.model) ? "Timeline (linear between events)" : "Timeline", table));
  }
  if (!outcome.history.empty()) {
    Table table = StateTable(outcome.history.front());
    for (const State& state : outcome.history) table.Add(StateCells("", state));
    absl::StrAppend(&text, StatesText("History", table));
  }
  return text;
}

std::string SolveCsv(const Outcome& outcome) { return CsvOf({RowOf(ToProto(outcome))}); }

std::string HistoryCsv(const Outcome& outcome) { return RowsOf(ToProto(outcome).history()); }

std::string ForceHistoryCsv(const Outcome& outcome) { return RowsOf(ToProto(outcome).contact().history()); }

}  // namespace ricochet::cli
