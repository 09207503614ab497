#include "tools/calibrate/board.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"

namespace maploop::calibrate {
namespace {

cv::Mat as_mat(const GreyImage& image) {
  return {image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())};
}

// Returns half the distance between neighbouring corners: a window of this radius around a corner
// does not reach another one.
double half_spacing(const std::vector<cv::Point2f>& corners, const Board& board) {
  double shortest = std::numeric_limits<double>::max();
  const auto at = [&](int row, int column) {
    return corners[static_cast<std::size_t>(row * board.columns + column)];
  };
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      if (column > 0)
        shortest = std::min(shortest, cv::norm(at(row, column) - at(row, column - 1)));
      if (row > 0) shortest = std::min(shortest, cv::norm(at(row, column) - at(row - 1, column)));
    }
  return 0.5 * shortest;
}

}  // namespace

std::vector<Eigen::Vector2d> Board::points() const {
  std::vector<Eigen::Vector2d> points;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      points.emplace_back(column * square, row * square);
  return points;
}

Board parse_board(const std::string& text, double square) {
  Board board{0, 0, square};
  const char* const end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, board.columns);
  const bool x = columns.ptr != end && *columns.ptr == 'x';
  const auto rows = std::from_chars(x ? columns.ptr + 1 : end, end, board.rows);
  const auto is_count = [](int n) { return n >= 3 && n <= 50; };
  if (columns.ec != std::errc{} || !x || rows.ec != std::errc{} || rows.ptr != end ||
      !is_count(board.columns) || !is_count(board.rows)) {
    throw std::invalid_argument("'" + text +
                                "' is no board: give its inner corners as COLUMNSxROWS, 3 to 50 "
                                "each, such as 9x6 for 10 x 7 squares");
  }
  return board;
}

GreyImage read_image(const std::filesystem::path& file) {
  std::vector<char> bytes;
  read_bytes(file, input_limits::picture, bytes);
  return sensors::is_png(bytes) ? sensors::decode_any_png(bytes) : sensors::decode_grey_jpeg(bytes);
}

std::optional<Corners> find_corners(const GreyImage& image, const Board& board) {
  const cv::Mat mat = as_mat(image);
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> found;
  // Finds the board and its corners to a few tenths of a pixel; cornerSubPix() then refines them.
  if (!cv::findChessboardCornersSB(mat, size, found, cv::CALIB_CB_NORMALIZE_IMAGE) &&
      !cv::findChessboardCornersSB(mat, size, found, cv::CALIB_CB_EXHAUSTIVE)) {
    return std::nullopt;
  }
  const int window = std::clamp(static_cast<int>(half_spacing(found, board)), 2, 10);
  cv::cornerSubPix(mat, found, {window, window}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-3});
  Corners corners;
  for (const cv::Point2f& p : found) corners.emplace_back(p.x, p.y);
  return corners;
}

std::optional<Board> find_any_board(const GreyImage& image) {
  cv::Mat corners, meta;
  constexpr int smallest = 3;
  if (!cv::findChessboardCornersSB(as_mat(image), {smallest, smallest}, corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER, meta)) {
    return std::nullopt;
  }
  return Board{std::max(meta.cols, meta.rows), std::min(meta.cols, meta.rows), 0.0};
}

Corners order_alike(const Corners& corners, const Corners& other, const Board& board) {
  Corners best;
  double least = std::numeric_limits<double>::max();
  for (int order = 0; order < 8; ++order) {
    const bool transposed = (order & 4) != 0;
    if (transposed && board.columns != board.rows) break;
    Corners candidate;
    for (int row = 0; row < board.rows; ++row)
      for (int column = 0; column < board.columns; ++column) {
        int r = (order & 1) != 0 ? board.rows - 1 - row : row;
        int c = (order & 2) != 0 ? board.columns - 1 - column : column;
        if (transposed) std::swap(r, c);
        candidate.push_back(corners[static_cast<std::size_t>(r * board.columns + c)]);
      }
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double squares = 0.0;
    for (std::size_t i = 0; i < candidate.size(); ++i) {
      const Eigen::Vector2d shift = candidate[i] - other[i];
      sum += shift;
      squares += shift.squaredNorm();
    }
    const double spread = squares - sum.squaredNorm() / static_cast<double>(candidate.size());
    if (spread < least) {
      least = spread;
      best = std::move(candidate);
    }
  }
  return best;
}

}  // namespace maploop::calibrate
