// Describes a chessboard and finds it in an image.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/image.h"

namespace maploop::calibrate {

// A plane of squares, described by its inner corners, where four squares meet.
struct Board {
  int columns = 9, rows = 6;
  double square = 0.03;  // m

  // Returns the corners in the board's own plane, m; row by row.
  std::vector<Eigen::Vector2d> points() const;
};

// Parses "9x6" (columns x rows). Throws std::invalid_argument if these are not two numbers from 3
// to 50.
Board parse_board(const std::string& text, double square);

using Corners = std::vector<Eigen::Vector2d>;  // px, row by row

// Reads a PNG or JPEG file as an 8-bit grey image. Throws std::runtime_error that states why it
// cannot be read.
GreyImage read_image(const std::filesystem::path& file);

// Returns the board's corners, accurate to a few hundredths of a pixel, or nothing if the board is
// not completely visible. The order of the corners is ambiguous (the board may be turned by 180
// degrees, and a square board by 90 degrees): see order_alike().
std::optional<Corners> find_corners(const GreyImage& image, const Board& board);

// Returns the size of any board that is visible in the image, or nothing.
std::optional<Board> find_any_board(const GreyImage& image);

// Reorders `corners` to be most similar to those of the other camera, whose view differs by less
// than a quarter turn about the line of sight.
Corners order_alike(const Corners& corners, const Corners& other, const Board& board);

}  // namespace maploop::calibrate
