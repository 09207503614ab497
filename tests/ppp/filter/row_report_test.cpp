#include "ppp/filter/row_report.h"

#include <gtest/gtest.h>

namespace maploop::ppp {
namespace {

// Returns whether the position is contradicted by satellites whose codes are near it or far.
bool contradicted(int near, int far) {
  std::vector<Row> rows;
  std::vector<Tracked> tracked;
  for (int i = 0; i < near; ++i) {
    Row row;
    row.sigma = 1.0;
    rows.push_back(row);
    tracked.emplace_back();
  }
  for (int i = 0; i < far; ++i) {
    tracked.emplace_back();
    tracked.back().code_good = false;
  }
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(FilterState::capacity);
  return disagree(rows, nothing, tracked, {});
}

TEST(RowReport, ManyFarCodesContradictAPositionThatFewAreNear) {
  EXPECT_TRUE(contradicted(0, 20));
  EXPECT_TRUE(contradicted(3, 5));
  EXPECT_FALSE(contradicted(3, 4)) << "any four may be wrong";
  EXPECT_FALSE(contradicted(2, 0));
  EXPECT_FALSE(contradicted(0, 0));
}

TEST(RowReport, AFewFarCodesDoNotContradictAPositionThatManyAreNear) {
  EXPECT_FALSE(contradicted(8, 4));
  EXPECT_TRUE(contradicted(8, 5));
}

}  // namespace
}  // namespace maploop::ppp
