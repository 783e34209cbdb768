// Batches of planar contacts: the numbers against an independent implementation, and the bits against Solve on both
// ways that a row can go.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/batch_table.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet {
namespace {

const std::vector<std::string>& Fields() {
  static const std::vector<std::string> fields = {"planar_contact.w_tt_per_kg", "planar_contact.w_tn_per_kg",
                                                  "planar_contact.w_nn_per_kg", "planar_contact.tangential_m_s",
                                                  "planar_contact.normal_m_s",  "friction.kinetic_coefficient"};
  return fields;
}

// Rows of planar contacts under one law of restitution.
BatchTable Contacts(const std::string& law) {
  BatchTable contacts;
  contacts.setup.scene = {.system = PlanarContact{}, .restitution = EnergeticCoefficient{}};
  contacts.setup.fields = Fields();
  contacts.setup.fields.push_back("restitution." + law);
  return contacts;
}

double Number(const VectorRow& row, const std::string& name) { return std::stod(row.at(name)); }

TEST(BatchTest, MatchesTheIndependentVectorsOfPlanarContacts) {
  const std::vector<std::pair<std::string, std::string>> columns = {
      {"contact_velocity_after.tangential_m_s[0]", "u1"},
      {"contact_velocity_after.normal_m_s", "v1"},
      {"impulse.normal_compression_n_s", "tau_compression"},
      {"impulse.normal_total_n_s", "tau1"},
      {"impulse.tangential_n_s[0]", "friction_impulse"}};
  size_t compared = 0;
  for (const std::string law : {"newton", "poisson", "energetic"}) {
    BatchTable contacts = Contacts(law);
    for (const auto& [path, name] : columns) contacts.setup.columns.push_back(path);
    std::vector<VectorRow> expected;
    for (const VectorRow& row : ReadVectors("planar.csv")) {
      if (row.at("law") != law) continue;
      contacts.Add({Number(row, "wtt"), Number(row, "wtn"), Number(row, "wnn"), Number(row, "u0"), Number(row, "v0"),
                    Number(row, "mu"), Number(row, "coefficient")});
      expected.push_back(row);
    }
    ASSERT_TRUE(contacts.Solve().ok());
    for (size_t i = 0; i < expected.size(); ++i) {
      const double speed = std::max(std::fabs(contacts.in[3][i]), std::fabs(contacts.in[4][i]));
      for (size_t c = 0; c < 2; ++c, ++compared) {
        EXPECT_NEAR(contacts.out[c][i], Number(expected[i], columns[c].second), 1e-12 * speed) << law << " " << i;
      }
      for (size_t c = 2; c < columns.size(); ++c, ++compared) {
        const double mobility = c == 4 ? contacts.in[0][i] : contacts.in[2][i];
        EXPECT_NEAR(mobility * contacts.out[c][i], mobility * Number(expected[i], columns[c].second), 1e-12 * speed)
            << law << " " << i << " " << columns[c].second;
      }
    }
  }
  EXPECT_EQ(compared, 240U * columns.size());
}

// Every column that goes in lanes.
std::vector<std::string> PlainColumns() {
  std::vector<std::string> columns;
  for (std::string& column : Columns({.system = PlanarContact{}})) {
    if (column.rfind("effective", 0) == 0 || column.rfind("accuracy", 0) == 0 || column.rfind("errors", 0) == 0 ||
        column == "work.tangential_spring_j") {
      continue;
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

// Contacts of every kind: moderate and extreme, of full rank and nearly not, at rest, separating, without friction.
std::vector<double> RandomRow(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> one_in(0, 9);
  const double scale = one_in(random) == 0 ? std::exp2(200.0 * unit(random)) : 1.0;
  const double tt = scale * std::exp2(2.0 * unit(random));
  const double nn = scale * std::exp2(2.0 * unit(random));
  const double share = one_in(random) == 0 ? 1.0 : unit(random);
  std::vector<double> row = {tt,
                             share * std::sqrt(tt * nn),
                             nn,
                             unit(random),
                             -std::fabs(unit(random)),
                             std::fabs(unit(random)),
                             std::fabs(unit(random))};
  if (one_in(random) == 0) row[3] = 0.0;
  if (one_in(random) == 0) row[4] = -row[4];
  if (one_in(random) == 0) row[5] = 0.0;
  if (one_in(random) == 0) row[5] *= 1e-13;
  if (one_in(random) == 0) row[5] *= 20.0;
  if (one_in(random) == 0) row[6] = one_in(random) < 5 ? 0.0 : 1.0;
  if (one_in(random) == 0) row[static_cast<size_t>(one_in(random)) % 7] = one_in(random) < 5 ? -1.0 : NAN;
  return row;
}

Scene SceneOf(const BatchTable& contacts, const std::string& law, size_t i) {
  const auto at = [&](size_t k) { return contacts.in[k][i]; };
  Scene scene = {.system = PlanarContact{at(0), at(1), at(2), at(3), at(4)}, .friction = contacts.setup.scene.friction};
  scene.friction.kinetic_coefficient = at(5);
  scene.restitution = RestitutionOf(law, at(6));
  return scene;
}

struct Case {
  std::string law;
  double tolerance;
  std::optional<double> static_coefficient;
};

class BatchBits : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Laws, BatchBits,
                         testing::Values(Case{"newton", 1e-12, {}}, Case{"poisson", 1e-12, {}},
                                         Case{"energetic", 1e-12, {}}, Case{"energetic", 0.0, {}},
                                         Case{"energetic", 1e-6, 0.7}, Case{"poisson", 1e-2, 1.5}));

TEST_P(BatchBits, AreThoseOfSolveInEveryRow) {
  const auto& [law, tolerance, static_coefficient] = GetParam();
  BatchTable contacts = Contacts(law);
  contacts.setup.columns = PlainColumns();
  contacts.setup.demand.relative_tolerance = tolerance;
  contacts.setup.scene.friction.static_coefficient = static_coefficient;
  std::mt19937_64 random(5);
  for (int i = 0; i < 3000; ++i) contacts.Add(RandomRow(random));
  const auto response = contacts.Solve();
  ASSERT_TRUE(response.ok()) << response.status();
  RowCounts counts = ExpectBitsOfSolve(contacts, [&, &law = law](size_t i) { return SceneOf(contacts, law, i); });
  EXPECT_GT(counts.invalid, 100);
  for (const Model model : {Model::kPlanar, Model::kSliding, Model::kFrictionless, Model::kNone}) {
    const int64_t counted = response->summary.counts.by_model[static_cast<size_t>(model)].count;
    EXPECT_GE(counted, counts.models[model]);
    if (static_coefficient.has_value() || tolerance == 0.0) continue;
    EXPECT_GT(counts.models[model], 20) << static_cast<int>(model);
  }
}

TEST(BatchTest, ARowHasTheSameBitsWhateverItsPlace) {
  BatchTable whole = Contacts("energetic");
  whole.setup.columns = PlainColumns();
  std::mt19937_64 random(6);
  for (int i = 0; i < 700; ++i) whole.Add(RandomRow(random));
  ASSERT_TRUE(whole.Solve().ok());
  for (const size_t i : {0u, 1u, 255u, 256u, 257u, 511u, 699u}) {
    BatchTable alone = Contacts("energetic");
    alone.setup.columns = PlainColumns();
    std::vector<double> row;
    for (const auto& column : whole.in) row.push_back(column[i]);
    alone.Add(row);
    ASSERT_TRUE(alone.Solve().ok());
    for (size_t c = 0; c < alone.out.size(); ++c) {
      EXPECT_EQ(std::bit_cast<uint64_t>(alone.out[c][0]), std::bit_cast<uint64_t>(whole.out[c][i])) << i;
    }
  }
}

}  // namespace
}  // namespace ricochet
