// Tests which epochs of a moving receiver are compared with and without the map.
#include "tools/ppp/map_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "ppp/models/geodesy.h"
#include "tests/support/process.h"

namespace maploop::gnss {
namespace {

constexpr double week_second = 100'000.0;

// It moves north at 10 m/s, a row a second.
class NorthwardDrive : public ::testing::Test {
 protected:
  NorthwardDrive() {
    std::ofstream file(folder_.path() / "truth.csv");
    file << std::fixed;
    for (int i = 0; i <= 20; ++i) {
      const Eigen::Vector3d p = place(i);
      file << i << ',' << week_second + i << ',' << p.x() << ',' << p.y() << ',' << p.z() << '\n';
    }
  }

  static ppp::GpsTime at(int second) { return ppp::gps_week_time(2100, week_second + second); }
  static Eigen::Vector3d place(int second) {
    return origin + R_.transpose() * Eigen::Vector3d(0.0, 10.0 * second, 0.0);
  }
  static ppp::PppSolution solution(int second, double east, double sigma) {
    ppp::PppSolution s;
    s.time = at(second);
    s.status = PppStatus::converged;
    s.position = place(second) + R_.transpose() * Eigen::Vector3d(east, 0.0, 0.0);
    s.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
    return s;
  }

  static inline const Eigen::Vector3d origin{3582104.7678, 532590.1740, 5232755.1436};
  static inline const Eigen::Matrix3d R_ = ppp::rotation_enu_ecef(ppp::geodetic_from_ecef(origin));
  const maploop::testing::TemporaryFolder folder_;
};

TEST_F(NorthwardDrive, CountsWhereThePositionIsUncertainAcrossWithoutTheMap) {
  const Truth truth((folder_.path() / "truth.csv").string(), at(0));
  MapComparison comparison(truth, at(5));
  for (int i = 0; i <= 20; ++i) {
    const double sigma = i < 15 ? 1.0 : 0.1;
    comparison.add(solution(i, i < 8 ? 2.0 : 1.0, sigma), solution(i, i < 12 ? 3.0 : 1.2, sigma));
  }
  EXPECT_EQ(comparison.epochs(), 10u) << "from 5 to 14 s";
  EXPECT_NEAR(comparison.aided().across_rmse, std::sqrt((3 * 4.0 + 7 * 1.0) / 10), 1e-3);
  EXPECT_NEAR(comparison.free().across_rmse, std::sqrt((7 * 9.0 + 3 * 1.44) / 10), 1e-3);
  EXPECT_NEAR(comparison.aided().horizontal_rmse, comparison.aided().across_rmse, 1e-3);
  EXPECT_EQ(comparison.aided().stays_below_after, 2.0) << "s after 5: last above 1.5 m at 7";
  EXPECT_EQ(comparison.free().stays_below_after, 6.0);
}

TEST_F(NorthwardDrive, HasNothingToCompareWhereNothingIsKnown) {
  const Truth truth((folder_.path() / "truth.csv").string(), at(0));
  MapComparison comparison(truth, {});
  ppp::PppSolution none;
  none.time = at(3);
  comparison.add(none, none);
  comparison.add(solution(40, 1.0, 1.0), solution(40, 1.0, 1.0));
  EXPECT_EQ(comparison.epochs(), 0u);
  EXPECT_EQ(comparison.free().across_rmse, 0.0);
  EXPECT_EQ(comparison.free().stays_below_after, 0.0);
}

}  // namespace
}  // namespace maploop::gnss
