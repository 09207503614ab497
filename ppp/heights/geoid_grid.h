// A grid of the geoid's height above the ellipsoid, in NOAA's binary form GTX: EGM96 is
// egm96_15.gtx of PROJ (Debian's proj-data).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace maploop::ppp {

class GeoidGrid {
 public:
  // Throws std::runtime_error, without the file's name, if this is no such grid.
  explicit GeoidGrid(std::string_view bytes);

  // Returns the height of the geoid above the ellipsoid, m; nothing outside the grid. Degrees.
  std::optional<double> at(double latitude, double longitude) const;

 private:
  double sample(int row, int column) const;

  double south_ = 0.0, west_ = 0.0, row_step_ = 1.0, column_step_ = 1.0;  // degrees
  int rows_ = 0, columns_ = 0;                                            // rows from the south
  bool around_ = false;  // the last column's eastern neighbour is the first one
  std::vector<float> heights_;
};

// Throws FileError.
GeoidGrid read_geoid_grid(const std::filesystem::path& file);

}  // namespace maploop::ppp
