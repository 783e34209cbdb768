// PlanarBodyLanes: scenes of one body or of two in a plane, each reduced to its contact, whose impact PlanarLanes
// solve.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/contact/planar_body_share.h"
#include "core/plan/demand.h"
#include "core/rows/scene_lanes.h"
#include "core/scene/numbers.h"
#include "ricochet/scene.h"

namespace ricochet {
namespace {

constexpr const char* kComponents[] = {"linear_m_s[0]", "linear_m_s[1]", "angular_rad_s[0]"};

// The bodies of a scene; none unless they are one body, or two, in a plane.
std::vector<const PlanarBody*> BodiesOf(const Scene& scene) {
  if (const auto* body = std::get_if<PlanarBody>(&scene.system)) return {body};
  const auto* pair = std::get_if<BodyPair>(&scene.system);
  const auto* planar = pair == nullptr ? nullptr : std::get_if<PlanarPair>(&pair->bodies);
  if (planar == nullptr) return {};
  return {&planar->body_1, &planar->body_2};
}

// The impulses act on the first body, their opposites on the second.
double SideOf(size_t body) { return body == 0 ? 1.0 : -1.0; }

PlanarBody BodyAt(const SceneLanes::Columns& columns, size_t body, size_t i) {
  PlanarBody one;
  const double* const* next = columns.of.data() + body * kNumbersOf<PlanarBody>;
  const auto set = [&](const NumberPath& /*path*/, double& number, NumberRule /*rule*/) { number = (*next++)[i]; };
  numbers::VisitPart(one, "", set);
  return one;
}

class PlanarBodyLanes : public SceneLanes {
 public:
  explicit PlanarBodyLanes(size_t bodies) : bodies_(bodies) {}
  // Returns false if lanes of the contact do not give every column that is not a velocity of a body.
  bool SetColumns(const Scene& scene, absl::Span<const std::string> columns, const Demand& demand);

  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  using Column = std::array<double, kBlock>;

  // A column of the answer that is a velocity of a body after the impact.
  struct AfterColumn {
    size_t column;
    size_t body;
    size_t component;  // 0 along t, 1 along n, 2 the rate.
  };
  struct ContactColumns {
    Column wtt, wtn, wnn, u0, v0;
  };

  size_t ContactColumn(const char* path);
  void Reduce(const Columns& columns, size_t count);
  Columns ContactOf(const Columns& columns) const;
  void SetAfter(const AfterColumn& after, const Columns& columns, size_t count, double* to) const;

  size_t bodies_;
  std::unique_ptr<SceneLanes> contact_lanes_;
  ContactColumns contact_ = {};

  // The columns that the lanes of the contact give, with the place of each in the answer; kOwn for one that is not in
  // it.
  static constexpr size_t kOwn = static_cast<size_t>(-1);
  std::vector<std::string> contact_paths_;
  std::vector<size_t> column_of_;
  std::vector<AfterColumn> after_;
  size_t tangential_impulse_ = kOwn, normal_impulse_ = kOwn;  // Their numbers among contact_paths_.
  std::array<Column, 2> own_ = {};
  std::vector<double*> contact_places_;
};

bool PlanarBodyLanes::SetColumns(const Scene& scene, absl::Span<const std::string> columns, const Demand& demand) {
  for (size_t c = 0; c < columns.size(); ++c) {
    const size_t known = after_.size();
    for (size_t body = 0; body < bodies_; ++body) {
      for (size_t k = 0; k < std::size(kComponents); ++k) {
        if (columns[c] == absl::StrCat("bodies_after[", body, "].", kComponents[k])) after_.push_back({c, body, k});
      }
    }
    if (after_.size() > known) continue;
    contact_paths_.push_back(columns[c]);
    column_of_.push_back(c);
  }
  if (!after_.empty()) {
    tangential_impulse_ = ContactColumn("impulse.tangential_n_s[0]");
    normal_impulse_ = ContactColumn("impulse.normal_total_n_s");
  }
  contact_places_.resize(contact_paths_.size());
  Scene contact = scene;
  contact.system = PlanarContact();
  contact_lanes_ = MakePlanarLanes(contact, contact_paths_, demand);
  return contact_lanes_ != nullptr;
}

// Returns the number of a column among those of the contact, to which it is added unless it is there.
size_t PlanarBodyLanes::ContactColumn(const char* path) {
  const auto found = std::find(contact_paths_.begin(), contact_paths_.end(), path);
  const auto number = static_cast<size_t>(found - contact_paths_.begin());
  if (found == contact_paths_.end()) {
    contact_paths_.emplace_back(path);
    column_of_.push_back(kOwn);
  }
  return number;
}

// Computes W and the contact velocities as core/contact/reduction.cc does. Rows whose W may have rank one are not
// solved here, nor those with an invalid body, for which W is NaN: the caller solves them one by one.
void PlanarBodyLanes::Reduce(const Columns& columns, size_t count) {
  contact_ = {};
  for (size_t body = 0; body < bodies_; ++body) {
    const double side = SideOf(body);
    for (size_t i = 0; i < count; ++i) {
      const PlanarBody one = BodyAt(columns, body, i);
      const PlanarBodyShare share = ShareOf(one);
      const bool keeps_rules =
          Holds(one.mass_kg, NumberRule::kPositive) && Holds(one.inertia_com_kg_m2, NumberRule::kPositive);
      contact_.wtt[i] += keeps_rules ? share.wtt : std::numeric_limits<double>::quiet_NaN();
      contact_.wtn[i] += share.wtn;
      contact_.wnn[i] += share.wnn;
      contact_.u0[i] += side * share.u0;
      contact_.v0[i] += side * share.v0;
    }
  }
}

// The columns of the contact's numbers, in the order of PlanarLanes.
SceneLanes::Columns PlanarBodyLanes::ContactOf(const Columns& columns) const {
  Columns contact;
  size_t n = 0;
  for (const Column* number : {&contact_.wtt, &contact_.wtn, &contact_.wnn, &contact_.u0, &contact_.v0}) {
    contact.of[n] = number->data();
    contact.varies[n++] = true;
  }
  for (size_t from = bodies_ * kNumbersOf<PlanarBody>; n < kNumbersOf<PlanarContact> + 3; ++n, ++from) {
    contact.of[n] = columns.of[from];
    contact.varies[n] = columns.varies[from];
  }
  return contact;
}

// The sums are those of Reduction::After.
void PlanarBodyLanes::SetAfter(const AfterColumn& after, const Columns& columns, size_t count, double* to) const {
  const double* const tangential = contact_places_[tangential_impulse_];
  const double* const normal = contact_places_[normal_impulse_];
  const double side = SideOf(after.body);
  for (size_t i = 0; i < count; ++i) {
    const PlanarBody body = BodyAt(columns, after.body, i);
    const std::array<double, 3> before = {body.velocity_t_m_s, body.velocity_n_m_s, body.rate_rad_s};
    const std::array<double, 6> response = ResponseOf(body, side);
    double change = response[2 * after.component + 1] * normal[i];
    change += response[2 * after.component] * tangential[i];
    to[i] = before[after.component] + change;
  }
}

void PlanarBodyLanes::Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) {
  Column* own = own_.data();
  for (size_t k = 0; k < column_of_.size(); ++k) {
    contact_places_[k] = column_of_[k] == kOwn ? (own++)->data() : places[column_of_[k]];
  }
  Reduce(columns, count);
  contact_lanes_->Solve(ContactOf(columns), count, contact_places_, block);
  for (const AfterColumn& after : after_) {
    SetAfter(after, columns, count, places[after.column]);
    block.is_complete = block.is_complete && AreFinite(places.subspan(after.column, 1), 0, count);
  }
}

}  // namespace

std::unique_ptr<SceneLanes> MakePlanarBodyLanes(const Scene& scene, absl::Span<const std::string> columns,
                                                const Demand& demand) {
  const size_t bodies = BodiesOf(scene).size();
  if (bodies == 0 || !IsPlain(scene)) return nullptr;
  auto lanes = std::make_unique<PlanarBodyLanes>(bodies);
  if (!lanes->SetColumns(scene, columns, demand)) return nullptr;
  return lanes;
}

}  // namespace ricochet
