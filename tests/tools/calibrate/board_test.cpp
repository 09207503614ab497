// Tests finding boards in rendered images, and calibrations from them.
#include "tools/calibrate/board.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/tools/calibrate/rendered_views.h"

namespace maploop::calibrate {
namespace {

double rms_error(const Corners& found, const Corners& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) squares += (found[i] - truth[i]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(found.size()));
}

class Rendered : public ::testing::Test {
 protected:
  std::vector<Eigen::Isometry3d> poses(std::size_t count, std::uint32_t seed) const {
    return testing::board_poses(renderer, rig, rendered(board), count, 0.35, 0.6, seed);
  }

  testing::RenderedRig rig = testing::example_rig();
  testing::BoardRenderer renderer{rig};
};

TEST_F(Rendered, CornersAreFoundToHundredthsOfAPixel) {
  double worst = 0.0;
  std::uint32_t seed = 1;
  for (const auto& pose : poses(4, 7)) {
    const View truth = ideal_view(renderer, board, pose, 0.0, 0);
    const View found = found_view(renderer, board, pose, {0.7, 2.0}, seed++);
    const Corners left = order_alike(found.left, truth.left, board);
    worst = std::max({worst, rms_error(left, truth.left),
                      rms_error(order_alike(found.right, truth.right, board), truth.right)});
  }
  RecordProperty("worst_rms_px", std::to_string(worst));
  EXPECT_LT(worst, 0.1);
}

// The whole pipeline from images to parameters. The README contains its result.
TEST_F(Rendered, TheCamerasAreRecoveredWithinTheirStandardDeviations) {
  std::vector<View> views;
  std::uint32_t seed = 1;
  for (const auto& pose : poses(20, 11))
    views.push_back(found_view(renderer, board, pose, {0.7, 2.0}, seed++));
  const StereoResult result = calibrate(board, views, rig.width, rig.height);
  const CommonVector error = error_of(result.rig, rig);
  const CommonVector ratio = error.cwiseQuotient(result.adjustment.sigma);
  std::cout << "rms " << result.adjustment.rms << " px\nerror " << error.transpose() << "\nsigma "
            << result.adjustment.sigma.transpose() << "\nratio " << ratio.transpose() << '\n';
  EXPECT_TRUE(result.bad.empty());
  EXPECT_LT(result.adjustment.rms, 0.1);
  EXPECT_LT(std::abs(error[0]), 0.001 * rig.left.fx);
  EXPECT_LT(error.tail<3>().norm(), 0.0005);      // m of 0.12
  EXPECT_LT(error.segment<3>(18).norm(), 0.001);  // rad
  EXPECT_LT(ratio.squaredNorm() / common_parameter_count,
            4.0);  // errors within a view are correlated
  EXPECT_LT(result.row_error, 0.1);
}

TEST_F(Rendered, AnotherBoardThanTheOneNamedIsNotFoundAndIsRecognized) {
  const StereoPair pair = renderer.render(rendered(board), poses(1, 7)[0], {0.7, 2.0}, 1);
  for (const Board& wrong : {Board{8, 6, 0.03}, Board{9, 7, 0.03}, Board{7, 5, 0.03}})
    EXPECT_FALSE(find_corners(pair.left, wrong)) << wrong.columns << "x" << wrong.rows;
  const auto seen = find_any_board(pair.left);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->columns, 9);
  EXPECT_EQ(seen->rows, 6);
}

TEST_F(Rendered, ABoardHalfOutsideAndAnImageWithoutOneAreNotFound) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << -0.9, -0.07, 0.5;
  EXPECT_FALSE(find_corners(renderer.render(rendered(board), pose, {0.7, 2.0}, 1).left, board));
  GreyImage black;
  black.resize(100, 80);
  EXPECT_FALSE(find_corners(black, board));
}

TEST(OrderAlike, FindsEveryOrderOfTheSameCorners) {
  for (const Board& b : {Board{5, 4, 1.0}, Board{4, 4, 1.0}}) {
    const Corners corners = b.points();
    const std::size_t orders = b.columns == b.rows ? 8 : 4;
    for (std::size_t order = 0; order < orders; ++order) {
      Corners other;
      for (int row = 0; row < b.rows; ++row)
        for (int column = 0; column < b.columns; ++column) {
          int r = (order & 1) != 0 ? b.rows - 1 - row : row;
          int c = (order & 2) != 0 ? b.columns - 1 - column : column;
          if ((order & 4) != 0) std::swap(r, c);
          other.push_back(corners[static_cast<std::size_t>(r * b.columns + c)]);
        }
      const Corners ordered = order_alike(other, corners, b);
      EXPECT_LT(rms_error(ordered, corners), 1e-12) << order;
    }
  }
}

TEST(ParseBoard, RefusesWhatIsNoBoard) {
  EXPECT_EQ(parse_board("9x6", 0.03).columns, 9);
  EXPECT_EQ(parse_board("9x6", 0.03).rows, 6);
  for (const char* wrong : {"", "9", "9x", "x6", "9x6x", "2x6", "9x51", "9*6", "-9x6", "9.5x6"})
    EXPECT_THROW(parse_board(wrong, 0.03), std::invalid_argument) << wrong;
}

}  // namespace
}  // namespace maploop::calibrate
