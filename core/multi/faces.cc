#include "core/multi/faces.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace ricochet::multi {
namespace {

constexpr int kMostDimensions = 2 * kMostContactsOfFaces;
using Point = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMostDimensions, 1>;
using Basis = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMostDimensions, kMostDimensions>;

// Tests of feasibility, of equal maxima and of dependent unit vectors allow for this much rounding.
constexpr double kTolerance = 1e-11;
constexpr size_t kMostProofs = 6;

// The flat y- + span of the rays, with some v_n = 0: the point nearest to 0 and orthonormal directions.
struct Flat {
  Point nearest;
  Basis directions;
};

class Search {
 public:
  Search(const Problem& problem, const EnergyMetric& metric, const std::vector<Eigen::VectorXd>& directions)
      : problem_(problem), metric_(metric), directions_(directions), y_(metric.y), energy_(metric.y.squaredNorm()) {
    for (int i = 0; i < problem.k; ++i) {
      const Point n = metric.g.row(problem.N(i));
      const Point t = metric.g.row(problem.T(i));
      const double mu = problem.laws[At(i)].mu;
      for (const double side : {mu, -mu}) {
        Eigen::VectorXd impulse = Eigen::VectorXd::Zero(problem.v.size());
        impulse(problem.N(i)) = 1.0;
        impulse(problem.T(i)) = side;
        const Point ray = n + side * t;
        const double length = ray.norm();
        if (length <= kTolerance * n.norm()) continue;
        rays_.push_back(ray / length);
        impulses_.push_back(impulse / length);
        if (mu == 0.0) break;
      }
      const double length = n.norm();
      normals_.push_back(length > 0.0 ? Point(n / length) : n);
      lengths_.push_back(length);
    }
    for (const Eigen::VectorXd& direction : directions) functions_.push_back(metric.g.transpose() * direction);
    maxima_.assign(2 * directions.size(), {.value = -std::numeric_limits<double>::infinity(), .proofs = {}});
    orthonormal_.resize(y_.size(), 0);
    factors_ = Basis::Zero(kMostDimensions, kMostDimensions);
  }

  std::vector<Maximum> Run() && {
    AddRays(0);
    return std::move(maxima_);
  }

 private:
  // Tries the flats of the rays chosen so far, and of these with further rays from `first` on.
  void AddRays(size_t first) {
    const Flat flat = {.nearest = y_ - orthonormal_ * (orthonormal_.transpose() * y_), .directions = orthonormal_};
    AddNormals(flat, 0);
    const auto count = static_cast<Eigen::Index>(chosen_.size());
    if (count == y_.size()) return;
    for (size_t i = first; i < rays_.size(); ++i) {
      Point rest = rays_[i];
      Point factors = Point::Zero(count);
      for (int pass = 0; pass < 2; ++pass) {
        const Point along = orthonormal_.transpose() * rest;
        rest -= orthonormal_ * along;
        factors += along;
      }
      const double length = rest.norm();
      if (length <= kTolerance) continue;
      orthonormal_.conservativeResize(y_.size(), count + 1);
      orthonormal_.col(count) = rest / length;
      factors_.col(count).head(count) = factors;
      factors_(count, count) = length;
      chosen_.push_back(i);
      AddRays(i + 1);
      chosen_.pop_back();
      orthonormal_.conservativeResize(y_.size(), count);
    }
  }

  // Tries a flat, and its parts where further contacts from `first` on keep v_n = 0.
  void AddNormals(const Flat& flat, size_t first) {
    if (flat.nearest.squaredNorm() > energy_ * (1.0 + kTolerance)) return;
    Try(flat);
    const Eigen::Index count = flat.directions.cols();
    for (size_t i = first; i < normals_.size() && count > 0; ++i) {
      const Point along = flat.directions.transpose() * normals_[i];
      const double length = along.norm();
      if (!(length > kTolerance)) continue;
      // Householder's reflection turns the first direction into the one that the contact bars.
      Point mirror = along / length;
      mirror(0) += mirror(0) < 0.0 ? -1.0 : 1.0;
      const Basis turned =
          flat.directions - (flat.directions * mirror) * (2.0 / mirror.squaredNorm() * mirror).transpose();
      const Point barred = flat.directions * (along / length);
      const Flat part = {.nearest = flat.nearest - barred * (normals_[i].dot(flat.nearest) / length),
                         .directions = turned.rightCols(count - 1)};
      held_.push_back(i);
      AddNormals(part, i + 1);
      held_.pop_back();
    }
  }

  void Try(const Flat& flat) {
    const double radius = std::sqrt(std::max(energy_ - flat.nearest.squaredNorm(), 0.0));
    for (size_t f = 0; f < functions_.size(); ++f) {
      const Point along = flat.directions.transpose() * functions_[f];
      const double length = along.norm();
      const bool is_level = length <= kTolerance * functions_[f].norm();
      const double middle = functions_[f].dot(flat.nearest);
      const double rise = is_level ? 0.0 : radius * length;
      for (const double sign : {1.0, -1.0}) {
        const size_t place = 2 * f + (sign > 0.0 ? 0 : 1);
        const double value = sign * middle + rise;
        const double scale = kTolerance * std::sqrt(energy_) * functions_[f].norm();
        if (!(value >= maxima_[place].value - scale)) continue;
        Point y = flat.nearest;
        if (!is_level) y += flat.directions * (along * (sign * radius / length));
        Point multiples;
        if (!IsPossible(y, multiples)) continue;
        if (value > maxima_[place].value + scale) maxima_[place].proofs.clear();
        maxima_[place].value = std::max(value, maxima_[place].value);
        if (maxima_[place].proofs.size() >= kMostProofs) continue;
        const double rate = is_level ? 0.0 : length / std::max(radius, kTolerance * std::sqrt(energy_));
        maxima_[place].proofs.push_back(ProofAt(sign, f, y, multiples, rate));
      }
    }
  }

  // Gives the multiples of the rays that lead to the point.
  bool IsPossible(const Point& y, Point& multiples) const {
    const double tolerance = kTolerance * std::sqrt(energy_);
    for (const Point& normal : normals_) {
      if (normal.dot(y) < -tolerance) return false;
    }
    const auto count = static_cast<Eigen::Index>(chosen_.size());
    multiples = orthonormal_.transpose() * (y - y_);
    for (Eigen::Index i = count; i-- > 0;) {
      for (Eigen::Index j = i + 1; j < count; ++j) multiples(i) -= factors_(i, j) * multiples(j);
      multiples(i) /= factors_(i, i);
      if (multiples(i) < -tolerance) return false;
    }
    return true;
  }

  // The multipliers at a maximum: gamma + sum nu n + pi is `rate` times y+, and pi is perpendicular to the rays.
  DualPoint ProofAt(double sign, size_t function, const Point& y, const Point& multiples, double rate) const {
    DualPoint proof = {.nu = Eigen::VectorXd::Zero(problem_.k), .pi = rate * metric_.x};
    for (size_t i = 0; i < chosen_.size(); ++i) {
      proof.pi += rate * multiples(static_cast<Eigen::Index>(i)) * impulses_[chosen_[i]];
    }
    proof.pi -= sign * directions_[function];
    if (held_.empty()) return proof;
    Eigen::MatrixXd held(orthonormal_.cols(), static_cast<Eigen::Index>(held_.size()));
    for (size_t i = 0; i < held_.size(); ++i) {
      held.col(static_cast<Eigen::Index>(i)) = orthonormal_.transpose() * normals_[held_[i]];
    }
    const Eigen::VectorXd right = orthonormal_.transpose() * (rate * y - sign * functions_[function]);
    const Eigen::VectorXd solved = held.colPivHouseholderQr().solve(right);
    for (size_t i = 0; i < held_.size(); ++i) {
      const auto contact = static_cast<int>(held_[i]);
      const double nu = std::max(solved(static_cast<Eigen::Index>(i)) / lengths_[held_[i]], 0.0);
      proof.nu(contact) = nu;
      proof.pi(problem_.N(contact)) -= nu;
    }
    return proof;
  }

  const Problem& problem_;
  const EnergyMetric& metric_;
  const std::vector<Eigen::VectorXd>& directions_;
  const Point y_;
  const double energy_;  // |y-|^2
  std::vector<Point> rays_, normals_, functions_;
  std::vector<Eigen::VectorXd> impulses_;  // In contact space, for each ray.
  std::vector<double> lengths_;            // The normals had these lengths before they were scaled to 1.
  std::vector<size_t> chosen_, held_;      // Rays and normals of the flat that is tried.
  Basis orthonormal_, factors_;            // The chosen rays are orthonormal_ times the triangle factors_.
  std::vector<Maximum> maxima_;
};

}  // namespace

std::vector<Maximum> MaximaOnFaces(const Problem& problem, const EnergyMetric& metric,
                                   const std::vector<Eigen::VectorXd>& directions) {
  return Search(problem, metric, directions).Run();
}

}  // namespace ricochet::multi
