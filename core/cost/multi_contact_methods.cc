// The methods of several contacts at once: orders, springs and possible.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/contact/multi_reduction.h"
#include "core/cost/methods_by_model.h"
#include "core/multi/solve_multi_contact.h"
#include "core/scene/validate_multi.h"
#include "core/types/multi_contact.h"

namespace ricochet {
namespace {

struct Problem {
  std::shared_ptr<const MultiContactRequest> request;  // One method, and no states: the velocity is the reduction's.
  MultiReduction reduction;
};

Problem Scaled(Problem problem, double factor) {
  problem.reduction.velocity *= factor;
  return problem;
}

// V of a problem: the largest contact velocity before.
double SpeedOf(const MultiReduction& reduction) {
  return reduction.ContactVelocity(reduction.velocity).lpNorm<Eigen::Infinity>();
}

// Returns 0 if nothing moves, and then all numbers are 0.
double Over(double speed, double number) { return number == 0.0 ? 0.0 : number / speed; }

KernelAnswer ReadPossible(const MultiContactAnswer& answer, double speed) {
  double widest = 0.0;
  for (size_t i = 0; i < answer.contact_velocity_before_m_s.size(); ++i) {
    widest = std::max(widest, answer.possible[i].upper - answer.possible[i].lower);
  }
  const double modelling = Over(speed, widest);
  return {.modelling = modelling,
          .note = absl::StrFormat("It proves that every outcome lies in ranges at most %.2g wide.", modelling)};
}

KernelAnswer ReadOutcomes(const std::vector<const AttainedOutcome*>& outcomes, double speed) {
  if (outcomes.empty()) return {.failure = "No outcome was found within the budget."};
  double error = 0.0;
  double apart = 0.0;
  for (size_t i = 0; i < outcomes.front()->contact_velocity_m_s.size(); ++i) {
    const auto [low, high] = std::minmax_element(outcomes.begin(), outcomes.end(),
                                                 [i](const AttainedOutcome* one, const AttainedOutcome* other) {
                                                   return one->contact_velocity_m_s[i] < other->contact_velocity_m_s[i];
                                                 });
    apart = std::max(apart, (*high)->contact_velocity_m_s[i] - (*low)->contact_velocity_m_s[i]);
    for (const AttainedOutcome* one : outcomes) error = std::max(error, one->contact_velocity_error_m_s[i]);
  }
  KernelAnswer read = {.claimed = Over(speed, error), .modelling = kNotKnown};
  const std::string known = absl::StrFormat("known to within %.1e", read.claimed);
  read.note = outcomes.size() == 1 ? absl::StrCat("It finds one outcome, ", known, ".")
                                   : absl::StrFormat("It finds %d outcomes up to %.2g apart, each %s.", outcomes.size(),
                                                     Over(speed, apart), known);
  return read;
}

KernelAnswer Read(const MultiContactAnswer& answer, MultiContactMethod method, double speed) {
  if (method == MultiContactMethod::kPossible) return ReadPossible(answer, speed);
  std::vector<const AttainedOutcome*> outcomes;
  const auto add = [&outcomes](const AttainedOutcome& one) {
    if (HasEnd(one.end)) outcomes.push_back(&one);
  };
  std::for_each(answer.orders.begin(), answer.orders.end(), add);
  if (answer.springs.has_value()) add(*answer.springs);
  return ReadOutcomes(outcomes, speed);
}

Kernel KernelOf(const Problem& problem, double speed) {
  const auto solve = [](const Problem& of, Stopped stopped) {
    return SolveMultiContact(*of.request, of.reduction, stopped);
  };
  const auto read = [speed](const Problem& of, const absl::StatusOr<std::vector<MultiContactAnswer>>& answers) {
    if (absl::IsCancelled(answers.status())) return KernelAnswer{.stopped = true};
    if (!answers.ok()) return KernelAnswer{.failure = "A number of the answer lies above the largest double."};
    return Read(answers->front(), of.request->methods.front(), speed);
  };
  return MakeKernel(problem, solve, read);
}

}  // namespace

StudiedScene StudyMultiContact(const MultiContactScene& scene, const MultiReduction& reduction) {
  StudiedScene study = {.speed = SpeedOf(reduction), .directions = 0};
  for (const MultiContactMethod method : kMultiContactMethods) {
    if (!WhyNot(method, reduction.directions, static_cast<int>(scene.contacts.size())).empty()) continue;
    const Problem problem = {
        .request = std::make_shared<MultiContactRequest>(MultiContactRequest{.scene = scene, .methods = {method}}),
        .reduction = reduction};
    study.methods.push_back(
        {.name = NameOf(method), .method = {.multi_contact = method}, .kernel = KernelOf(problem, study.speed)});
  }
  return study;
}

}  // namespace ricochet
