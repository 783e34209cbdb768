#include "core/cost/reference_velocity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/invariant.h"
#include "core/certified/certified.h"
#include "core/certified/residual.h"
#include "core/models/pendulum/nearly_vertical_forms.h"
#include "core/models/spatial/solver-inl.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace {

constexpr char kCompensatedSource[] = "double-double arithmetic, which is right to 1 ulp";

// The errors of double-double arithmetic once it is rounded, and of Wide arithmetic.
constexpr double kUlp = 0x1p-52;
constexpr double kWide = 0x1p-96;

Wide Exactly(double value) { return Wide::Exactly(value); }

// The velocity of a contact of rank one, whose two components change by the same factor.
ReferenceVelocity RankOne(const Wide& newton, const Wide& u0, const Wide& v0, double error, const std::string& source) {
  return {.of = {-newton * u0, Exactly(0.0), -newton * v0}, .error = error, .source = source};
}

// A pendulum that has the W of a contact of rank one, exactly: W = (1/J) (b^2, a b, a^2) with a = J = Wnn and b = Wtn.
pendulum::Problem PendulumOf(const planar::Problem& problem) {
  return {.inertia = problem.w.nn,
          .a = problem.w.nn,
          .b = problem.w.tn,
          .omega_minus = -1.0,
          .mu = problem.mu,
          .mu_static = problem.mu_static,
          .law = problem.law,
          .coefficient = problem.coefficient};
}

struct NewtonCoefficientOf {
  Wide value;
  bool certified = false;
};

NewtonCoefficientOf NewtonOf(const pendulum::Problem& problem, Stopped stopped) {
  const std::optional<Certificate> certificate = CertifyContact(SceneOf(problem), kReferenceDigits, stopped);
  if (certificate.has_value()) return {.value = ExactNumber(*certificate, "coefficients.newton"), .certified = true};
  return {.value = Exactly(pendulum::Solve(problem)[pendulum::Output::kNewton])};
}

constexpr char kTangentialPath[] = "contact_velocity_after.tangential_m_s[0]";
constexpr char kNormalPath[] = "contact_velocity_after.normal_m_s";

const CertifiedNumber& NumberOf(const Certificate& certificate, const std::string& path) {
  const auto found = std::find_if(certificate.numbers.begin(), certificate.numbers.end(),
                                  [&path](const CertifiedNumber& number) { return number.path == path; });
  CheckInvariant(found != certificate.numbers.end(), "a certificate has the numbers of an outcome");
  return *found;
}

}  // namespace

ReferenceVelocity ReferenceAt(const Velocity3& velocity, double error, std::string source) {
  return {.of = {Exactly(velocity[0]), Exactly(velocity[1]), Exactly(velocity[2])},
          .error = error,
          .source = std::move(source)};
}

Scene CertifiableScene(const planar::Problem& problem) {
  return problem.w.UFollowsV(problem.u0, problem.v0) ? SceneOf(PendulumOf(problem)) : SceneOf(problem);
}

ReferenceVelocity ExactRigid(const pendulum::Problem& problem, Stopped stopped) {
  const NewtonCoefficientOf newton = NewtonOf(problem, stopped);
  const Wide omega = Exactly(problem.omega_minus);
  return RankOne(newton.value, Exactly(problem.b) * omega, Exactly(problem.a) * omega, newton.certified ? kWide : kUlp,
                 newton.certified ? kCertifiedSource : kCompensatedSource);
}

ReferenceVelocity ExactRigid(const planar::Problem& problem, Stopped stopped) {
  if (problem.w.UFollowsV(problem.u0, problem.v0)) {
    const NewtonCoefficientOf newton = NewtonOf(PendulumOf(problem), stopped);
    // The rounding of u0 and v0 leaves open which of them lies in the range of W: u1 may be -newton u0 or
    // u0 - (1 + newton) v0 Wtn/Wnn.
    const double beside = std::fabs(problem.u0 - problem.v0 * (problem.w.tn / problem.w.nn));
    const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
    const double open = (1.0 + Rounded(newton.value)) * beside / speed;
    return RankOne(newton.value, Exactly(problem.u0), Exactly(problem.v0), kUlp + open,
                   newton.certified ? kCertifiedSource : kCompensatedSource);
  }
  // A contact of rank one beside its range has no certificate.
  const std::optional<Certificate> certificate =
      problem.w.Rank() == 1 ? std::nullopt : CertifyContact(SceneOf(problem), kReferenceDigits, stopped);
  if (certificate.has_value()) return ReferenceVelocityOf(*certificate);
  const planar::Impact impact = planar::Solve(problem);
  // A wedged contact has no end, and so no answer.
  const double error = impact.regime == Regime::kWedged ? std::numeric_limits<double>::infinity() : kUlp;
  return ReferenceAt({impact.u1, 0.0, impact.v1}, error, kCompensatedSource);
}

template <size_t kTangential>
ReferenceVelocity ExactSliding(const sliding::Problem<kTangential>& problem) {
  const double mu = problem.mu;
  // e = u0/|u0|
  std::array<Wide, kTangential> e;
  e.fill(Exactly(0.0));
  if (mu > 0.0) {
    Wide square = Exactly(0.0);
    for (const double u : problem.u0) square = square + Exactly(u) * Exactly(u);
    const Wide inverse = Inverse(Sqrt(square));
    for (size_t i = 0; i < kTangential; ++i) e[i] = Exactly(problem.u0[i]) * inverse;
  }
  const auto wtn = problem.Wtn();
  // f' = -mu e, v' = Wnn - mu wtn . e
  Wide slope = Exactly(problem.Wnn());
  for (size_t i = 0; i < kTangential; ++i) slope = slope - Exactly(mu) * Exactly(wtn[i]) * e[i];
  const Wide c = Exactly(problem.coefficient);
  const Wide v0 = Exactly(problem.v0);
  const Wide tau1 = (Exactly(1.0) + c) * -v0 / slope;
  ReferenceVelocity exact = {.of = {Exactly(0.0), Exactly(0.0), -c * v0}, .error = kWide, .source = ""};
  const auto wtt = [&problem](size_t i, size_t k) {
    return Exactly(kTangential == 1 ? problem.w[0] : problem.w[i + k == 2 ? 3 : i + k]);
  };
  for (size_t i = 0; i < kTangential; ++i) {
    Wide change = Exactly(wtn[i]);
    for (size_t k = 0; k < kTangential; ++k) change = change - Exactly(mu) * wtt(i, k) * e[k];
    exact.of[i] = Exactly(problem.u0[i]) + change * tau1;
  }
  return exact;
}

template ReferenceVelocity ExactSliding(const sliding::Problem<1>& problem);
template ReferenceVelocity ExactSliding(const sliding::Problem<2>& problem);

ReferenceVelocity ExactFrictionless(const pendulum::Problem& problem) {
  const Wide omega = Exactly(problem.omega_minus);
  return RankOne(Exactly(problem.coefficient), Exactly(problem.b) * omega, Exactly(problem.a) * omega, kWide, "");
}

ReferenceVelocity ExactFirstOrder(const pendulum::Problem& problem) {
  const Wide omega = Exactly(problem.omega_minus);
  const Wide one = Exactly(1.0);
  const Wide x = Exactly(problem.mu) * Exactly(std::fabs(problem.b)) / Exactly(problem.a);
  const auto forms = pendulum::CoefficientForms(problem.law, Exactly(problem.coefficient), x, one - x, one + x);
  return RankOne(forms.newton.value, Exactly(problem.b) * omega, Exactly(problem.a) * omega, kWide, "");
}

ReferenceVelocity ExactSpatial(const spatial::Problem& problem) {
  using Real = long double;
  spatial::HWY_NAMESPACE::Solver<Real> solver(problem, problem.Delassus().Rank(), Real{1e-16L});
  const spatial::Impact impact = solver.Run();
  // The answer is rounded to doubles in the end.
  const double error = impact.error_estimate + kUlp / 2.0;
  return ReferenceAt({impact.u1[0], impact.u1[1], impact.v1},
                     impact.Converged() ? error : std::numeric_limits<double>::infinity(),
                     "the spatial model in long double arithmetic, at a tolerance of 1e-16");
}

Velocity3 RoundedVelocity(const ReferenceVelocity& exact) {
  return {Rounded(exact.of[0]), Rounded(exact.of[1]), Rounded(exact.of[2])};
}

double Distance(const Velocity3& velocity, const ReferenceVelocity& exact) {
  double most = 0.0;
  for (size_t i = 0; i < velocity.size(); ++i) {
    most = std::max(most, std::fabs(Rounded(Exactly(velocity[i]) - exact.of[i])));
  }
  return most;
}

double Distance(const ReferenceVelocity& one, const ReferenceVelocity& other) {
  double most = 0.0;
  for (size_t i = 0; i < one.of.size(); ++i) most = std::max(most, std::fabs(Rounded(one.of[i] - other.of[i])));
  return most;
}

std::optional<Certificate> CertifyContact(const Scene& scene, int digits, Stopped stopped) {
  if (!CheckCertifiable(scene, digits).empty()) return std::nullopt;
  absl::StatusOr<Certificate> certificate = CertifySolve(scene, {.digits = digits}, stopped);
  if (!certificate.ok() || certificate->is_set) return std::nullopt;
  return *std::move(certificate);
}

Wide ExactNumber(const Certificate& certificate, const std::string& path) {
  const CertifiedNumber& number = NumberOf(certificate, path);
  return Wide::Exactly(number.value) + Wide::Exactly(certified::Residual(number.decimal, number.value));
}

ReferenceVelocity ReferenceVelocityOf(const Certificate& certificate) {
  return {.of = {ExactNumber(certificate, kTangentialPath), Wide::Exactly(0.0), ExactNumber(certificate, kNormalPath)},
          .error = 0x1p-104,
          .source = kCertifiedSource};
}

Velocity3 RoundedVelocityOf(const Certificate& certificate) {
  return {NumberOf(certificate, kTangentialPath).value, 0.0, NumberOf(certificate, kNormalPath).value};
}

double Distance(const Certificate& one, const Certificate& other) {
  double most = 0.0;
  for (const char* path : {kTangentialPath, kNormalPath}) {
    most = std::max(most, std::fabs(certified::Residual(NumberOf(one, path).decimal, NumberOf(other, path).decimal)));
  }
  return most;
}

}  // namespace ricochet
