// W as a whole matrix, by spans and by Eigen.

#include "ricochet/contact_matrix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "ricochet/eigen.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::array kPlane = {2.0, 0.5, 0.5, 1.0};
constexpr std::array kSpace = {1.96, 0.24, 0.6, 0.24, 2.96, -0.8, 0.6, -0.8, 1.85};

TEST(ContactMatrixTest, TakesTheUpperTriangle) {
  const auto plane = ContactFrom(std::span<const double, 4>(kPlane), 1.0, -1.0);
  ASSERT_TRUE(plane.ok());
  EXPECT_EQ(*plane, (PlanarContact{2.0, 0.5, 1.0, 1.0, -1.0}));
  const auto space = ContactFrom(std::span<const double, 9>(kSpace), {1.0, 0.6}, -1.0);
  ASSERT_TRUE(space.ok());
  EXPECT_THAT(space->w_per_kg, ElementsAre(1.96, 0.24, 0.6, 2.96, -0.8, 1.85));
}

TEST(ContactMatrixTest, NamesTheEntriesThatDifferAndTheFrame) {
  std::array<double, 9> w = kSpace;
  w[5] = 0.8;
  const auto space = ContactFrom(std::span<const double, 9>(w), {1.0, 0.6}, -1.0, "x, y, z of the world");
  ASSERT_FALSE(space.ok());
  EXPECT_THAT(std::string(space.status().message()), HasSubstr("w_per_kg[2][1] = -0.8: must be equal to [1][2] = 0.8"));
  EXPECT_THAT(std::string(space.status().message()), HasSubstr("x, y, z of the world"));
}

TEST(ContactMatrixTest, NamesAnEntryBelowTheDiagonalThatIsNotFinite) {
  std::array<double, 4> w = kPlane;
  w[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ViolationsOf(ContactFrom(std::span<const double, 4>(w), 1.0, -1.0).status()),
              ElementsAre(Violation{"w_per_kg[1][0]", "= nan: must be finite"}));
}

TEST(ContactMatrixTest, TakesDifferencesOfRounding) {
  std::array<double, 4> w = kPlane;
  w[2] += 1e-15;
  EXPECT_TRUE(ContactFrom(std::span<const double, 4>(w), 1.0, -1.0).ok());
}

TEST(EigenTest, MatricesOfEitherOrderGiveTheSameMechanism) {
  const Eigen::MatrixXd mass{{2.0, 0.5}, {0.5, 1.0}};
  const Eigen::Matrix<double, 2, 2, Eigen::RowMajor> by_rows{{1.0, 2.0}, {3.0, 4.0}};
  const Eigen::VectorXd rates{{-1.0, 0.5}};
  const Mechanism mechanism = *MechanismFrom(mass, by_rows, rates);
  EXPECT_THAT(mechanism.mass_matrix, ElementsAre(2.0, 0.5, 0.5, 1.0));
  EXPECT_THAT(mechanism.jacobian, ElementsAre(1.0, 2.0, 3.0, 4.0));
  EXPECT_THAT(mechanism.rates, ElementsAre(-1.0, 0.5));
}

TEST(EigenTest, ShapesThatDoNotFitAreNamed) {
  const Eigen::MatrixXd mass = Eigen::MatrixXd::Identity(4, 4), jacobian = Eigen::MatrixXd::Ones(2, 4);
  const Eigen::VectorXd rates = Eigen::VectorXd::Ones(4);
  EXPECT_TRUE(MechanismFrom(mass, jacobian, rates).ok());
  const absl::Status transposed = MechanismFrom(mass, jacobian.transpose(), rates).status();
  EXPECT_EQ(ViolationsOf(transposed).at(0),
            (Violation{"mechanism.jacobian", "is 4 x 2: must be 2 x 4 or 3 x 4 for 4 rates"}));
  const absl::Status tall = MechanismFrom(mass, Eigen::MatrixXd::Ones(5, 4), rates).status();
  EXPECT_EQ(ViolationsOf(tall).at(0),
            (Violation{"mechanism.jacobian", "is 5 x 4: must be 2 x 4 or 3 x 4 for 4 rates"}));
  // These have as many entries as a matrix that fits.
  const absl::Status flat = MechanismFrom(mass.reshaped(2, 8), jacobian.reshaped(4, 2), rates).status();
  ASSERT_EQ(ViolationsOf(flat).size(), 2);
  EXPECT_EQ(ViolationsOf(flat)[0], (Violation{"mechanism.mass_matrix", "is 2 x 8: must be 4 x 4 for 4 rates"}));
}

TEST(EigenTest, TurnsAWorldJacobianIntoTheFrameOfTheContact) {
  // t1 = y, t2 = z, n = x.
  const Eigen::Matrix3d axes{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  const Eigen::MatrixXd world{{1.0}, {2.0}, {3.0}};
  EXPECT_EQ(InFrame(axes, world), (Eigen::MatrixXd{{2.0}, {3.0}, {1.0}}));
}

TEST(EigenTest, ContactsTakeMatrices) {
  const Eigen::Matrix2d w{{2.0, 0.5}, {0.5, 1.0}};
  EXPECT_EQ(*ContactFrom(w, 1.0, -1.0), (PlanarContact{2.0, 0.5, 1.0, 1.0, -1.0}));
  const Eigen::Matrix2d skew{{2.0, 0.5}, {0.4, 1.0}};
  EXPECT_FALSE(ContactFrom(skew, 1.0, -1.0).ok());
}

}  // namespace
}  // namespace ricochet
