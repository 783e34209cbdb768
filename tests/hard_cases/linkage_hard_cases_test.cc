// The W of long chains is compared with the same matrices in ball arithmetic.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "core/contact/reduction.h"
#include "tests/hard_cases/hard_case_table.h"
#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr slong kBits = 400;

// M and J of a chain over T. Angles are exact doubles; `sin` and `cos` give their sines and cosines.
template <typename T>
struct Chain {
  std::vector<std::vector<T>> mass;
  std::vector<std::array<T, 2>> jacobian;  // Transposed.
};

template <typename T, typename Sine, typename Cosine, typename Exactly>
Chain<T> MakeChain(const Linkage& linkage, const Sine& sin, const Cosine& cos, const Exactly& exactly) {
  const auto& links = linkage.links;
  const size_t n = links.size();
  Chain<T> chain;
  chain.mass.assign(n, std::vector<T>(n, exactly(0.0)));
  for (size_t j = 0; j < n; ++j) {
    for (size_t k = 0; k < n; ++k) {
      T moment = exactly(0.0);
      for (size_t i = std::max(j, k); i < n; ++i) {
        const T arm_j = exactly(i == j ? links[i].com_m : links[j].length_m);
        const T arm_k = exactly(i == k ? links[i].com_m : links[k].length_m);
        moment = moment + exactly(links[i].mass_kg) * arm_j * arm_k;
      }
      chain.mass[j][k] = moment * cos(exactly(links[j].theta_rad) - exactly(links[k].theta_rad));
    }
    chain.mass[j][j] = chain.mass[j][j] + exactly(links[j].inertia_com_kg_m2);
    const T length = exactly(links[j].length_m);
    const T angle = exactly(links[j].theta_rad);
    chain.jacobian.push_back({length * cos(angle), length * sin(angle)});
  }
  return chain;
}

// Computes W = J M^-1 J^T by Gaussian elimination without pivoting: tt, tn, nn.
template <typename T>
std::array<T, 3> DelassusMatrix(Chain<T> chain, const T& zero) {
  auto& m = chain.mass;
  const size_t n = m.size();
  std::vector<std::array<T, 2>> x = chain.jacobian;
  for (size_t k = 0; k < n; ++k) {
    for (size_t i = k + 1; i < n; ++i) {
      const T factor = m[i][k] / m[k][k];
      for (size_t j = k; j < n; ++j) m[i][j] = m[i][j] - factor * m[k][j];
      for (size_t d = 0; d < 2; ++d) x[i][d] = x[i][d] - factor * x[k][d];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t d = 0; d < 2; ++d) {
      for (size_t j = k + 1; j < n; ++j) x[k][d] = x[k][d] - m[k][j] * x[j][d];
      x[k][d] = x[k][d] / m[k][k];
    }
  }
  std::array<T, 3> w = {zero, zero, zero};
  for (size_t k = 0; k < n; ++k) {
    w[0] = w[0] + chain.jacobian[k][0] * x[k][0];
    w[1] = w[1] + chain.jacobian[k][0] * x[k][1];
    w[2] = w[2] + chain.jacobian[k][1] * x[k][1];
  }
  return w;
}

Chain<double> InDoubles(const Linkage& linkage) {
  return MakeChain<double>(
      linkage, [](double x) { return std::sin(x); }, [](double x) { return std::cos(x); }, [](double x) { return x; });
}

std::array<Ball, 3> Exact(const Linkage& linkage) {
  const auto exactly = [](double x) { return Ball(x, kBits); };
  return DelassusMatrix(
      MakeChain<Ball>(
          linkage, [](const Ball& x) { return Sin(x); }, [](const Ball& x) { return Cos(x); }, exactly),
      exactly(0.0));
}

// J M^-1 J^T through the inverse itself.
std::array<double, 3> Naive(const Linkage& linkage) {
  const Chain<double> chain = InDoubles(linkage);
  const auto n = static_cast<Eigen::Index>(linkage.links.size());
  Eigen::MatrixXd mass(n, n), jacobian(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) mass(i, j) = chain.mass[static_cast<size_t>(i)][static_cast<size_t>(j)];
    for (Eigen::Index d = 0; d < 2; ++d)
      jacobian(d, i) = chain.jacobian[static_cast<size_t>(i)][static_cast<size_t>(d)];
  }
  const Eigen::MatrixXd w = jacobian * mass.inverse() * jacobian.transpose();
  return {w(0, 0), w(0, 1), w(1, 1)};
}

// The largest error of an entry over sqrt(Wtt Wnn), or over its own size on the diagonal.
double ErrorOf(const std::array<double, 3>& w, const std::array<Ball, 3>& exact) {
  const std::array<Ball, 3> scales = {exact[0], Sqrt(exact[0] * exact[2]), exact[2]};
  double worst = 0.0;
  for (size_t i = 0; i < w.size(); ++i) {
    worst = std::max(worst, (Abs(Ball(w[i], kBits) - exact[i]) / scales[i]).UpperBound());
  }
  return worst;
}

Linkage MakeLinkage(size_t count, double spread, double mass_ratio) {
  std::mt19937_64 random(50);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
  };
  Linkage linkage;
  for (size_t i = 0; i < count; ++i) {
    const double mass = std::pow(mass_ratio, uniform(0.0, 1.0));
    linkage.links.push_back({.length_m = uniform(0.5, 1.5),
                             .mass_kg = mass,
                             .com_m = uniform(0.2, 0.8),
                             .inertia_com_kg_m2 = mass * uniform(0.01, 0.1),
                             .theta_rad = 0.4 + spread * uniform(-1.0, 1.0),
                             .rate_rad_s = uniform(-1.0, 1.0)});
  }
  return linkage;
}

// A mass at the end of links that are lighter by `lightness`.
Linkage LoadedChain(size_t count, double spread, double lightness) {
  Linkage linkage = MakeLinkage(count, spread, 1.0);
  for (Link& link : linkage.links) {
    link.mass_kg *= lightness;
    link.inertia_com_kg_m2 *= lightness;
  }
  Link& load = linkage.links.back();
  load.mass_kg = 1.0;
  load.com_m = load.length_m;
  return linkage;
}

struct HardCase {
  const char* name;
  const char* why;
  Linkage linkage;
};

// n ulp times the condition of M with a unit diagonal, core/contact/reduction.h.
double Promised(const Linkage& linkage) {
  const auto n = static_cast<Eigen::Index>(linkage.links.size());
  const Chain<double> chain = InDoubles(linkage);
  Eigen::MatrixXd scaled(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = [&chain](Eigen::Index row, Eigen::Index column) {
        return chain.mass[static_cast<size_t>(row)][static_cast<size_t>(column)];
      };
      scaled(i, j) = entry(i, j) / std::sqrt(entry(i, i) * entry(j, j));
    }
  }
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues();
  return 0x1p-52 * static_cast<double>(n) * values.maxCoeff() / values.minCoeff();
}

HardCaseResult ResultOf(const HardCase& hard) {
  const auto reduction = std::get<PlanarReduction>(Reduce({.system = hard.linkage}));
  const std::array<Ball, 3> exact = Exact(hard.linkage);
  return {.name = hard.name,
          .why = hard.why,
          .naive = ErrorOf(Naive(hard.linkage), exact),
          .promised = Promised(hard.linkage),
          .seen = ErrorOf(reduction.w, exact)};
}

TEST(LinkageHardCasesTest, KeepTheirPromise) {
  const HardCase cases[] = {
      {"50 links at all angles", "50 x 50 matrix of masses", MakeLinkage(50, 3.0, 1.0)},
      {"50 links, nearly straight", "rows of M are nearly parallel", MakeLinkage(50, 1e-3, 1.0)},
      {"50 links, masses up to 1 : 10⁶", "rows of M of unequal size", MakeLinkage(50, 3.0, 1e6)},
      {"10 links, 10⁻⁶ of the load at their end", "M is of rank two but for the links", LoadedChain(10, 3.0, 1e-6)},
      {"10 links, 10⁻¹⁰ of the load", "M is of rank two but for the links, and M⁻¹ cancels in W",
       LoadedChain(10, 3.0, 1e-10)},
      {"10 links, 10⁻⁸ of the load, nearly straight", "M and W are all but singular", LoadedChain(10, 1e-2, 1e-8)},
      {"2 links in a line", "M is singular but for the links' own inertia", MakeLinkage(2, 1e-9, 1.0)},
  };
  std::vector<HardCaseResult> results;
  for (const HardCase& hard : cases) results.push_back(ResultOf(hard));
  CheckTable("linkage", "of W", results);
}

}  // namespace
}  // namespace ricochet
