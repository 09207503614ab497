#include "ppp/heights/height_tile.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "ppp/heights/zip_archive.h"

namespace maploop::ppp {
namespace {

constexpr std::int16_t no_height = -32768;  // in the files

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

int whole(std::string_view digits) {
  int value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

// Returns the number of samples along a side: that of SRTM1 or SRTM3.
int side_of(std::size_t bytes) {
  for (const int side : {1201, 3601}) {
    if (bytes == 2 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) return side;
  }
  throw std::runtime_error(std::to_string(bytes) +
                           " bytes are no tile of 1201 or 3601 samples by as many, of two bytes "
                           "each: it is cut, or of another kind; gdalwarp makes tiles of others "
                           "(-of SRTMHGT)");
}

}  // namespace

std::optional<TileCorner> corner_of(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool ends =
      name.ends_with(".hgt") || name.ends_with(".hgt.zip") || name.ends_with(".hgt.gz");
  if (!ends || name.size() < 11) return {};
  const std::string_view north = std::string_view(name).substr(1, 2);
  const std::string_view east = std::string_view(name).substr(4, 3);
  if ((name[0] != 'n' && name[0] != 's') || (name[3] != 'e' && name[3] != 'w') || name[7] != '.' ||
      !all_digits(north) || !all_digits(east)) {
    return {};
  }
  const TileCorner corner{name[0] == 'n' ? whole(north) : -whole(north),
                          name[3] == 'e' ? whole(east) : -whole(east)};
  const bool on_earth = corner.latitude >= -90 && corner.latitude < 90 &&
                        corner.longitude >= -180 && corner.longitude < 180;
  return on_earth ? std::optional(corner) : std::nullopt;
}

HeightTile::HeightTile(TileCorner corner, std::string_view samples)
    : corner_(corner), intervals_(side_of(samples.size()) - 1), samples_(samples.size() / 2) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto high = static_cast<std::uint8_t>(samples[2 * i]);
    const auto low = static_cast<std::uint8_t>(samples[2 * i + 1]);
    samples_[i] = static_cast<std::int16_t>(high << 8U | low);
  }
}

std::optional<TileHeight> HeightTile::at(double latitude, double longitude) const {
  const double n = intervals_;
  const double south = n * (latitude - corner_.latitude),
               east = n * (longitude - corner_.longitude);
  if (!(south >= 0.0 && south <= n && east >= 0.0 && east <= n)) return {};
  const double north = n - south;  // rows from the northern edge
  const int row = std::min(static_cast<int>(north), intervals_ - 1);
  const int column = std::min(static_cast<int>(east), intervals_ - 1);
  const double down = north - row, right = east - column;
  const auto sample = [&](int r, int c) {
    return samples_[static_cast<std::size_t>(r) * static_cast<std::size_t>(intervals_ + 1) +
                    static_cast<std::size_t>(c)];
  };
  const std::int16_t nw = sample(row, column), ne = sample(row, column + 1);
  const std::int16_t sw = sample(row + 1, column), se = sample(row + 1, column + 1);
  for (const std::int16_t corner : {nw, ne, sw, se}) {
    if (corner == no_height) return {};
  }
  const double above = nw + right * (ne - nw), below = sw + right * (se - sw);
  return TileHeight{above + down * (below - above), n * (above - below),
                    n * ((1.0 - down) * (ne - nw) + down * (se - sw))};
}

HeightTile read_height_tile(const std::filesystem::path& file) {
  const auto corner = corner_of(file);
  if (!corner) {
    throw FileError(file,
                    "is not named after its south-western corner, as N49E011.hgt, .hgt.gz or "
                    ".hgt.zip");
  }
  constexpr std::size_t limit = input_limits::height_tile;
  std::string bytes = read_text(file, limit);
  try {
    if (bytes.starts_with("PK")) bytes = unpacked(bytes, ".hgt", limit);
    return {*corner, bytes};
  } catch (const std::bad_alloc&) {
    throw FileError(file, "does not fit into memory");
  } catch (const std::runtime_error& e) {
    throw FileError(file, e.what());
  }
}

}  // namespace maploop::ppp
