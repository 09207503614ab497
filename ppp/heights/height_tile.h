// A tile of SRTM's heights: one degree by one degree, as a square of samples (NASA, "SRTM
// Topography", 2015).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::ppp {

// The south-western corner, degrees.
struct TileCorner {
  int latitude = 0, longitude = 0;
  bool operator==(const TileCorner&) const = default;
  bool operator<(const TileCorner& other) const {
    return latitude != other.latitude ? latitude < other.latitude : longitude < other.longitude;
  }
};

// Returns the corner that a file's name states, such as N49E011.hgt, N49E011.SRTMGL1.hgt.zip or
// s01w062.hgt.gz; nothing if it is no name of a tile.
std::optional<TileCorner> corner_of(const std::filesystem::path& file);

// Height and slope of the ground at one place. Above what the height counts is the model's matter.
struct TileHeight {
  double height = 0.0;                             // m
  double per_latitude = 0.0, per_longitude = 0.0;  // m a degree
};

class HeightTile {
 public:
  // `samples` are the big-endian 16-bit heights, row by row from the north. Throws
  // std::runtime_error, without the file's name, if they are not 1201 (SRTM3) or 3601 (SRTM1) by as
  // many.
  HeightTile(TileCorner corner, std::string_view samples);

  // Interpolates between four samples; nothing if one of them is void or the place is outside.
  // Degrees.
  std::optional<TileHeight> at(double latitude, double longitude) const;
  TileCorner corner() const { return corner_; }

 private:
  TileCorner corner_;
  int intervals_ = 0;                  // along each side
  std::vector<std::int16_t> samples_;  // m
};

// Reads .hgt, .hgt.gz and .hgt.zip. Throws FileError: as input_file.h, or no tile.
HeightTile read_height_tile(const std::filesystem::path& file);

}  // namespace maploop::ppp
