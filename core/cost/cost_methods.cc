#include "core/cost/cost_methods.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/answer/scene_outcome.h"
#include "core/cost/methods_by_model.h"
#include "core/plan/planned_scene.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace {

// True if the contact of a pendulum may have lost digits, because a number of it is subnormal or 0.
bool HasLostDigits(const planar::Problem& problem) {
  return std::min({problem.w.tt, problem.w.nn, std::fabs(problem.v0)}) < std::numeric_limits<double>::min();
}

// Returns the error, over V, that the rounded W of a pendulum causes in the planar models: x has a relative error of a
// few 2^-53, which moves kappa_hat by at most kappa_hat/(1 - x^2) times that. `newton` is at least kappa_hat.
double ReductionError(const planar::Problem& problem) {
  const double x = problem.mu_static * std::fabs(problem.w.tn) / problem.w.nn;
  const double distance = std::fabs(1.0 - x);
  if (!(distance > 0x1p-40)) return std::numeric_limits<double>::infinity();
  const double newton =
      problem.law == RestitutionLaw::kEnergetic ? std::min(problem.coefficient, 1.0) : problem.coefficient;
  return 0x1p-50 * (1.0 + newton / distance);
}

double SpeedOf(double u0, double v0) { return std::max(std::fabs(u0), std::fabs(v0)); }

ReferencePointer NoImpact(const Velocity3& before) {
  return MakeReference(
      [before](Stopped) { return ReferenceAt(before, 0.0, "the velocity before, because the contact separates"); });
}

// A planar scene with all that its methods need.
class PlanarStudy {
 public:
  PlanarStudy(const Scene& scene, const PlanarReduction& reduction, const EffectiveCoefficients& effective)
      : scene_(scene),
        closed_form_(HasClosedForm(scene) ? std::optional(ClosedFormProblem(scene)) : std::nullopt),
        problem_(planar::MakeProblem(reduction, scene.restitution, effective)),
        physics_(PhysicsOf(scene, reduction)) {}

  StudiedScene Run() && {
    study_.speed = SpeedOf(problem_.u0, problem_.v0);
    study_.v0 = problem_.v0;
    if (std::holds_alternative<std::monostate>(scene_.impact_law)) {
      AddCoulomb();
    } else {
      AddImpactLaw(scene_.impact_law, problem_, study_.methods);
    }
    if (closed_form_.has_value() && HasLostDigits(problem_)) ClaimNothingFromContact();
    return std::move(study_);
  }

 private:
  // A result computed from a contact that has lost its digits may have any error. The closed forms do not use it.
  void ClaimNothingFromContact() {
    for (StudiedMethod& method : study_.methods) {
      const Model model = method.method.model;
      const bool is_form = model == Model::kPendulum || model == Model::kFrictionless || model == Model::kFirstOrder;
      if (!is_form) method.claimed_reduction = std::numeric_limits<double>::infinity();
    }
  }

  bool Approaches() const { return problem_.v0 < 0.0; }
  bool IsDamped() const { return std::holds_alternative<HuntCrossleySpring>(physics_.spring); }

  // False if the plan proves that tangential compliance changes nothing.
  bool ComplianceMatters() const {
    return Approaches() && PlanarSizes(problem_, physics_)[Effect::kTangentialCompliance].value != 0.0;
  }

  void AddCoulomb() {
    const ReferencePointer rigid = RigidReference();
    if (!IsDamped()) AddRigid(rigid);
    study_.truth = rigid;
    if (physics_.ratio_squared > 0.0) {
      const ReferencePointer compliant = AddCompliant(problem_, physics_, study_.methods);
      if (ComplianceMatters()) study_.truth = compliant;
    }
    if (problem_.law == RestitutionLaw::kEnergetic && Approaches()) AddTimed(study_.truth);
    if (closed_form_.has_value() && Approaches()) ClaimReductionOfTimed(rigid);
  }

  // The exact answer of a pendulum does not use W, so these methods claim the rounding of W, which counts near a jam.
  void ClaimReductionOfTimed(const ReferencePointer& rigid) {
    for (StudiedMethod& method : study_.methods) {
      const bool is_timed = method.method.model == Model::kFiniteDuration;
      if (is_timed && method.exact == rigid) method.claimed_reduction = ReductionError(problem_);
    }
  }

  ReferencePointer RigidReference() const {
    // A pendulum can approach at a speed that is below the smallest double at its contact.
    const bool approaches = closed_form_.has_value() ? closed_form_->omega_minus < 0.0 : Approaches();
    if (!approaches) return NoImpact({problem_.u0, 0.0, problem_.v0});
    if (closed_form_.has_value()) {
      return MakeReference([problem = *closed_form_](Stopped stopped) { return ExactRigid(problem, stopped); });
    }
    return MakeReference([problem = problem_](Stopped stopped) { return ExactRigid(problem, stopped); });
  }

  void AddRigid(const ReferencePointer& rigid) {
    Methods& methods = study_.methods;
    if (closed_form_.has_value()) AddClosedForms(*closed_form_, physics_, rigid, methods);
    if (Approaches()) AddOnePiece();
    AddPlanar(problem_, physics_, rigid, closed_form_.has_value() && Approaches() ? ReductionError(problem_) : 0.0,
              methods);
    if (!Approaches()) return;
    AddCertified(closed_form_.has_value() ? SceneOf(*closed_form_) : CertifiableScene(problem_), study_.speed,
                 NeglectedBy(Model::kPlanar, problem_, physics_), rigid, methods);
  }

  void AddOnePiece() {
    const sliding::Problem<1> sliding_problem = SlidingProblemOf(problem_);
    for (const Model model : {Model::kFrictionless, Model::kSliding}) {
      // A pendulum has a frictionless form of its own.
      if (model == Model::kFrictionless && closed_form_.has_value()) continue;
      AddStraight(model, sliding_problem, ChoosePlanar(problem_, physics_, DemandFor(model)), study_.methods);
    }
  }

  // Finite forces do not act in a scene without a spring, but they act with the springs that the study gives it.
  void AddTimed(const ReferencePointer& impulses) {
    const bool same = !IsDamped() && physics_.tangential_acceleration == 0.0 && physics_.normal_acceleration == 0.0;
    const ReferencePointer own = AddFiniteDuration(problem_, physics_, same ? impulses : nullptr, study_.methods);
    if (own != nullptr) study_.truth = own;
  }

  const Scene& scene_;
  const std::optional<pendulum::Problem> closed_form_;
  const planar::Problem problem_;
  const ContactPhysics physics_;
  StudiedScene study_;
};

StudiedScene StudySpatial(const Scene& scene, const SpatialReduction& reduction,
                          const EffectiveCoefficients& effective) {
  const spatial::Problem problem =
      spatial::MakeProblem(reduction, scene.restitution, effective, spatial::kLeastTolerance);
  StudiedScene study = {
      .truth = problem.v0 < 0.0 ? MakeReference([problem](Stopped) { return ExactSpatial(problem); })
                                : NoImpact({problem.u0[0], problem.u0[1], problem.v0}),
      .speed = SpeedOf(std::sqrt(problem.u0[0] * problem.u0[0] + problem.u0[1] * problem.u0[1]), problem.v0),
      .v0 = problem.v0,
      .directions = 2};
  if (problem.v0 < 0.0) {
    const sliding::Problem<2> sliding_problem = SlidingProblemOf(problem);
    for (const Model model : {Model::kFrictionless, Model::kSliding}) {
      AddStraight(model, sliding_problem, ChooseSpatial(problem, DemandFor(model)), study.methods);
    }
  }
  AddSpatial(problem, study.truth, study.methods);
  return study;
}

}  // namespace

const ReferenceVelocity* Reference::Get(Stopped stopped) {
  if (!known_.has_value()) {
    ReferenceVelocity computed = compute_(stopped);
    if (stopped()) return nullptr;
    known_ = std::move(computed);
  }
  return known_->error < kNotKnown ? &*known_ : nullptr;
}

absl::StatusOr<StudiedScene> StudyScene(const Scene& scene, std::optional<SceneContact>& contact) {
  if (!contact.has_value()) contact.emplace(scene);
  if (!FitsDoubles(contact->reduction)) return ContactOverflow();
  if (const auto* plane = std::get_if<PlanarReduction>(&contact->reduction)) {
    return PlanarStudy(scene, *plane, contact->coefficients).Run();
  }
  return StudySpatial(scene, std::get<SpatialReduction>(contact->reduction), contact->coefficients);
}

}  // namespace ricochet
