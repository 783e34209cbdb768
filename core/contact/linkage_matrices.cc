#include "core/contact/linkage_matrices.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/numerics/elementary.h"

namespace ricochet {

Eigen::MatrixXd MassMatrix(const Linkage& linkage) {
  const std::vector<Link>& links = linkage.links;
  const auto n = static_cast<Eigen::Index>(links.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  double beyond = 0.0;  // Mass of all links between link k and the tip.
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    const Link& link = links[static_cast<size_t>(k)];
    const double moment = link.mass_kg * link.com_m + beyond * link.length_m;
    mass(k, k) =
        link.inertia_com_kg_m2 + link.mass_kg * link.com_m * link.com_m + beyond * link.length_m * link.length_m;
    for (Eigen::Index i = 0; i < k; ++i) {
      const Link& before = links[static_cast<size_t>(i)];
      mass(i, k) = mass(k, i) = moment * before.length_m * Cos(before.theta_rad - link.theta_rad);
    }
    beyond += link.mass_kg;
  }
  return mass;
}

Eigen::VectorXd RatesOf(const Linkage& linkage) {
  Eigen::VectorXd rates(static_cast<Eigen::Index>(linkage.links.size()));
  std::transform(linkage.links.begin(), linkage.links.end(), rates.begin(),
                 [](const Link& link) { return link.rate_rad_s; });
  return rates;
}

Eigen::MatrixXd TransposedJacobian(const Linkage& linkage) {
  Eigen::MatrixXd jt(static_cast<Eigen::Index>(linkage.links.size()), 2);
  Eigen::Index i = 0;
  for (const Link& link : linkage.links) {
    jt(i, 0) = link.length_m * Cos(link.theta_rad);
    jt(i, 1) = link.length_m * Sin(link.theta_rad);
    ++i;
  }
  return jt;
}

Eigen::MatrixXd MassMatrixTangent(const Linkage& linkage, const Linkage& direction) {
  const auto n = static_cast<Eigen::Index>(linkage.links.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  double beyond = 0.0, d_beyond = 0.0;  // Mass of all links between link k and the tip, and its change.
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    const Link& link = linkage.links[static_cast<size_t>(k)];
    const Link& d = direction.links[static_cast<size_t>(k)];
    const double moment = link.mass_kg * link.com_m + beyond * link.length_m;
    const double d_moment =
        d.mass_kg * link.com_m + link.mass_kg * d.com_m + d_beyond * link.length_m + beyond * d.length_m;
    mass(k, k) = d.inertia_com_kg_m2 + d.mass_kg * link.com_m * link.com_m + 2.0 * link.mass_kg * link.com_m * d.com_m +
                 d_beyond * link.length_m * link.length_m + 2.0 * beyond * link.length_m * d.length_m;
    for (Eigen::Index i = 0; i < k; ++i) {
      const Link& before = linkage.links[static_cast<size_t>(i)];
      const Link& d_before = direction.links[static_cast<size_t>(i)];
      const double angle = before.theta_rad - link.theta_rad;
      mass(i, k) = mass(k, i) = (d_moment * before.length_m + moment * d_before.length_m) * Cos(angle) -
                                moment * before.length_m * Sin(angle) * (d_before.theta_rad - d.theta_rad);
    }
    beyond += link.mass_kg;
    d_beyond += d.mass_kg;
  }
  return mass;
}

Eigen::MatrixXd TransposedJacobianTangent(const Linkage& linkage, const Linkage& direction) {
  Eigen::MatrixXd jt(static_cast<Eigen::Index>(linkage.links.size()), 2);
  for (Eigen::Index i = 0; i < jt.rows(); ++i) {
    const Link& link = linkage.links[static_cast<size_t>(i)];
    const Link& d = direction.links[static_cast<size_t>(i)];
    jt(i, 0) = d.length_m * Cos(link.theta_rad) - link.length_m * Sin(link.theta_rad) * d.theta_rad;
    jt(i, 1) = d.length_m * Sin(link.theta_rad) + link.length_m * Cos(link.theta_rad) * d.theta_rad;
  }
  return jt;
}

Eigen::VectorXd GravityMoments(const Linkage& linkage, const Gravity& gravity) {
  Eigen::VectorXd moments(static_cast<Eigen::Index>(linkage.links.size()));
  double beyond = 0.0;  // Mass of all links between link k and the tip.
  for (Eigen::Index k = moments.size() - 1; k >= 0; --k) {
    const Link& link = linkage.links[static_cast<size_t>(k)];
    const double moment = link.mass_kg * link.com_m + beyond * link.length_m;
    moments(k) = moment * (gravity.tangential_m_s2 * Cos(link.theta_rad) + gravity.normal_m_s2 * Sin(link.theta_rad));
    beyond += link.mass_kg;
  }
  return moments;
}

}  // namespace ricochet
