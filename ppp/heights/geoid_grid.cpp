#include "ppp/heights/geoid_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::ppp {
namespace {

template <class Value, class Bits>
Value big_endian(std::string_view bytes, std::size_t at) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    bits = static_cast<Bits>(bits << 8U | static_cast<std::uint8_t>(bytes[at + i]));
  }
  return std::bit_cast<Value>(bits);
}

constexpr std::size_t header_size = 40;
constexpr double whole_turn = 360.0;

}  // namespace

GeoidGrid::GeoidGrid(std::string_view bytes) {
  const auto refuse = [] {
    throw std::runtime_error(
        "is no grid of the geoid (GTX), or cut: egm96_15.gtx of Debian's proj-data is one");
  };
  if (bytes.size() < header_size) refuse();
  const auto number = [&](std::size_t i) {
    return big_endian<double, std::uint64_t>(bytes, sizeof(double) * i);
  };
  south_ = number(0);
  west_ = number(1);
  row_step_ = number(2);
  column_step_ = number(3);
  rows_ = big_endian<std::int32_t, std::uint32_t>(bytes, 32);
  columns_ = big_endian<std::int32_t, std::uint32_t>(bytes, 36);
  constexpr int most = 1 << 16;
  const bool sound = std::abs(south_) <= 90.0 && std::abs(west_) <= whole_turn &&
                     row_step_ > 1e-4 && row_step_ <= 90.0 && column_step_ > 1e-4 &&
                     column_step_ <= 90.0 && rows_ >= 2 && rows_ <= most && columns_ >= 2 &&
                     columns_ <= most;
  if (!sound) refuse();
  const auto count = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  if (bytes.size() != header_size + sizeof(float) * count) refuse();
  around_ = column_step_ * columns_ > whole_turn - 0.5 * column_step_;
  heights_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    heights_[i] = big_endian<float, std::uint32_t>(bytes, header_size + sizeof(float) * i);
  }
}

double GeoidGrid::sample(int row, int column) const {
  return static_cast<double>(
      heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column % columns_)]);
}

std::optional<double> GeoidGrid::at(double latitude, double longitude) const {
  const double north = (latitude - south_) / row_step_;
  double turned = std::fmod(longitude - west_, whole_turn);
  if (turned < 0.0) turned += whole_turn;
  const double east = turned / column_step_;
  const int last = around_ ? columns_ : columns_ - 1;
  if (!(north >= 0.0 && north <= rows_ - 1 && east >= 0.0 && east <= last)) return {};
  const int row = std::min(static_cast<int>(north), rows_ - 2);
  const int column = std::min(static_cast<int>(east), last - 1);
  const double up = north - row, right = east - column;
  const double below = (1.0 - right) * sample(row, column) + right * sample(row, column + 1);
  const double above =
      (1.0 - right) * sample(row + 1, column) + right * sample(row + 1, column + 1);
  const double height = (1.0 - up) * below + up * above;
  constexpr double largest = 200.0;  // m; no geoid is farther away, but what marks a void is
  return std::abs(height) <= largest ? std::optional(height) : std::nullopt;
}

GeoidGrid read_geoid_grid(const std::filesystem::path& file) {
  const std::string bytes = read_text(file, input_limits::geoid_grid);
  try {
    return GeoidGrid(bytes);
  } catch (const std::runtime_error& e) {
    throw FileError(file, e.what());
  }
}

}  // namespace maploop::ppp
