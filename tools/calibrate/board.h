// A chessboard, and finding it in an image.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/image.h"

namespace maploop::calibrate {

// A plane of squares, by its inner corners: where four squares meet.
struct Board {
  int columns = 9, rows = 6;
  double square = 0.03;  // m

  // Of the corners in the board's own plane, m; row by row.
  std::vector<Eigen::Vector2d> points() const;
};

// "9x6". Throws std::invalid_argument: not two numbers from 3 to 50.
Board parse_board(const std::string& text, double square);

using Corners = std::vector<Eigen::Vector2d>;  // px, row by row

// As an 8-bit grey image. Throws std::runtime_error that says why it cannot be read.
GreyImage read_image(const std::filesystem::path& file);

// The board's corners, to a few hundredths of a pixel; nothing where it is not seen whole. A board
// has the same corners in several orders (turned, and where it is square on its side): see
// order_alike().
std::optional<Corners> find_corners(const GreyImage& image, const Board& board);

// The size of a board that is seen in the image, whatever size it has; nothing where none is.
std::optional<Board> find_any_board(const GreyImage& image);

// `corners` in the order in which they lie most alike to those of the other camera, whose view
// differs by less than a quarter turn about the line of sight.
Corners order_alike(const Corners& corners, const Corners& other, const Board& board);

}  // namespace maploop::calibrate
