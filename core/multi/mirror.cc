#include "core/multi/mirror.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ricochet::multi {
namespace {

// The numbers of a contact that neither its place nor the sense of its tangential directions changes.
std::vector<double> KeyOf(const Problem& problem, int i) {
  const ContactLaw& law = problem.laws[At(i)];
  std::vector<double> key = {problem.v(problem.N(i)), law.mu, law.e, law.stiffness};
  for (int a = 0; a < problem.d; ++a) {
    key.push_back(std::abs(problem.v(problem.T(i) + a)));
    key.push_back(problem.w(problem.T(i) + a, problem.T(i) + a));
  }
  const size_t own = key.size();
  for (int a = 0; a < problem.d; ++a) {
    for (int j = 0; j < problem.v.size(); ++j) key.push_back(std::abs(problem.w(problem.T(i) + a, j)));
  }
  std::sort(key.begin() + static_cast<std::ptrdiff_t>(own), key.end());
  return key;
}

std::vector<std::vector<double>> KeysOf(const Problem& problem) {
  std::vector<std::vector<double>> keys;
  for (int i = 0; i < problem.k; ++i) keys.push_back(KeyOf(problem, i));
  return keys;
}

// Slip is not negative, or without slip the coupling to the contact's own normal direction.
double SignOf(const Problem& problem, int i) {
  const double slip = problem.v(2 * i);
  const double first = slip != 0.0 ? slip : problem.w(2 * i, 2 * i + 1);
  return first < 0.0 ? -1.0 : 1.0;
}

class MirrorSearch {
 public:
  MirrorSearch(const Problem& problem, const std::vector<std::vector<double>>& keys) : problem_(problem), keys_(keys) {
    mirror_.image.fill(-1);
  }

  // Assigns an image to each contact from `i` on, with images that are other contacts first. True if that works.
  bool Assign(int i, bool moved) {
    while (i < problem_.k && mirror_.image[At(i)] >= 0) ++i;
    if (i == problem_.k) return moved;
    for (int j = problem_.k - 1; j >= i; --j) {
      if (mirror_.image[At(j)] >= 0 || keys_[At(i)] != keys_[At(j)]) continue;
      for (const double sign : {1.0, -1.0}) {
        Set(i, j, sign);
        if (Fits(i) && Fits(j) && Assign(i + 1, moved || i != j || sign < 0.0)) return true;
        mirror_.image[At(i)] = mirror_.image[At(j)] = -1;
      }
    }
    return false;
  }

  const Mirror& mirror() const { return mirror_; }

 private:
  void Set(int i, int j, double sign) {
    mirror_.image[At(i)] = j;
    mirror_.image[At(j)] = i;
    mirror_.sign[At(i)] = mirror_.sign[At(j)] = sign;
  }
  // True if the block of W and the velocity of contact i are those of its image, with all contacts that have one.
  bool Fits(int i) const {
    const int image = mirror_.image[At(i)];
    const double sign = mirror_.sign[At(i)];
    if (problem_.v(2 * i) != sign * problem_.v(2 * image)) return false;
    for (int j = 0; j < problem_.k; ++j) {
      const int other = mirror_.image[At(j)];
      if (other < 0) continue;
      const double turn = mirror_.sign[At(j)];
      const auto w = [&](int a, int b) { return problem_.w(2 * i + a, 2 * j + b); };
      const auto of_image = [&](int a, int b) { return problem_.w(2 * image + a, 2 * other + b); };
      if (w(0, 0) != sign * turn * of_image(0, 0) || w(0, 1) != sign * of_image(0, 1) ||
          w(1, 0) != turn * of_image(1, 0) || w(1, 1) != of_image(1, 1)) {
        return false;
      }
    }
    return true;
  }

  const Problem& problem_;
  const std::vector<std::vector<double>>& keys_;
  Mirror mirror_;
};

}  // namespace

void Mirror::Average(Vector& x) const {
  const Vector before = x;
  for (int i = 0; i < x.size() / 2; ++i) {
    const int other = image[At(i)];
    x(2 * i) = 0.5 * (before(2 * i) + sign[At(i)] * before(2 * other));
    x(2 * i + 1) = 0.5 * (before(2 * i + 1) + before(2 * other + 1));
  }
}

void Mirror::Average(std::array<double, kMostContacts>& x) const {
  const std::array<double, kMostContacts> before = x;
  for (size_t i = 0; i < x.size(); ++i) x[i] = 0.5 * (before[i] + before[At(image[i])]);
}

Vector SortedProblem::InScene(const Vector& sorted) const {
  const int d = problem.d;
  Vector x(sorted.size());
  for (int i = 0; i < problem.k; ++i) {
    x.segment(d * from[At(i)], d) = sorted.segment(d * i, d);
    if (d == 2) x(2 * from[At(i)]) *= sign[At(i)];
  }
  return x;
}

Vector SortedProblem::FromScene(const Vector& scene) const {
  const int d = problem.d;
  Vector x(scene.size());
  for (int i = 0; i < problem.k; ++i) {
    x.segment(d * i, d) = scene.segment(d * from[At(i)], d);
    if (d == 2) x(2 * i) *= sign[At(i)];
  }
  return x;
}

std::optional<Mirror> MirrorOf(const Problem& problem) {
  if (problem.d != 2) return std::nullopt;
  const std::vector<std::vector<double>> keys = KeysOf(problem);
  MirrorSearch search(problem, keys);
  if (!search.Assign(0, false)) return std::nullopt;
  Mirror mirror = search.mirror();
  std::iota(mirror.image.begin() + problem.k, mirror.image.end(), problem.k);
  return mirror;
}

SortedProblem Sort(const Problem& problem) {
  const int d = problem.d;
  const std::vector<std::vector<double>> keys = KeysOf(problem);
  SortedProblem sorted = {.problem = {.d = d, .k = problem.k, .w = problem.w, .v = problem.v, .laws = {}}};
  std::iota(sorted.from.begin(), sorted.from.end(), 0);
  std::stable_sort(sorted.from.begin(), sorted.from.begin() + problem.k,
                   [&](int i, int j) { return keys[At(i)] < keys[At(j)]; });
  Vector turn = Vector::Ones(problem.v.size());
  for (int i = 0; i < problem.k; ++i) {
    const int from = sorted.from[At(i)];
    const double sign = d == 2 ? SignOf(problem, from) : 1.0;
    sorted.sign[At(i)] = sign;
    turn(d * i) = sign;
    sorted.problem.laws.push_back(problem.laws[At(from)]);
    sorted.problem.v.segment(d * i, d) = problem.v.segment(d * from, d);
    for (int j = 0; j < problem.k; ++j) {
      const int other = sorted.from[At(j)];
      sorted.problem.w.block(d * i, d * j, d, d) = problem.w.block(d * from, d * other, d, d);
    }
  }
  // Adding 0 makes -0 positive, so that both senses give the same bits.
  sorted.problem.v = (turn.asDiagonal() * sorted.problem.v).array() + 0.0;
  sorted.problem.w = (turn.asDiagonal() * sorted.problem.w * turn.asDiagonal()).array() + 0.0;
  sorted.mirror = MirrorOf(sorted.problem);
  return sorted;
}

}  // namespace ricochet::multi
