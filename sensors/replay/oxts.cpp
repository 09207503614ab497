#include "sensors/replay/oxts.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

constexpr std::size_t columns = 30;
enum Column : std::size_t {
  lat,
  lon,
  alt,
  roll,
  pitch,
  yaw,
  vn,
  ve,
  vf = 8,
  vu = 10,
  ax = 11,
  ay = 12,
  az = 13,
  wx = 17,
  wy = 18,
  wz = 19,
  pos_accuracy = 23
};

// These are the ranges of dataformat.txt, with room for the rounding of the text. Where it gives
// none, the limits are beyond what the unit can measure (GNSS receivers stop at 515 m/s, its
// accelerometers at 10 g), so that a damaged number does not pass for a measurement.
constexpr double half_turn = std::numbers::pi + 1e-3;
struct Range {
  Column column;
  const char* name;
  double largest;  // in magnitude
};
constexpr std::array<Range, 16> ranges{{{lat, "lat", 90.0},
                                        {lon, "lon", 180.0},
                                        {alt, "alt", 20000.0},
                                        {roll, "roll", half_turn},
                                        {pitch, "pitch", half_turn / 2.0},
                                        {yaw, "yaw", half_turn},
                                        {vn, "vn", 515.0},
                                        {ve, "ve", 515.0},
                                        {vf, "vf", 515.0},
                                        {vu, "vu", 515.0},
                                        {ax, "ax", 100.0},
                                        {ay, "ay", 100.0},
                                        {az, "az", 100.0},
                                        {wx, "wx", 10.0},
                                        {wy, "wy", 10.0},
                                        {wz, "wz", 10.0}}};

}  // namespace

OxtsRow parse_oxts_row(std::string_view text) {
  return oxts_row(parse_numbers(text));
}

OxtsRow oxts_row(std::span<const double> value) {
  if (value.size() != columns) {
    throw std::invalid_argument("has " + std::to_string(value.size()) + " columns instead of " +
                                std::to_string(columns));
  }
  for (const Range& range : ranges) {
    if (std::fabs(value[range.column]) > range.largest) {
      throw std::invalid_argument(std::string(range.name) +
                                  " is out of range: " + std::to_string(value[range.column]));
    }
  }
  OxtsRow row;
  row.position = {radians(value[lat]), radians(value[lon]), value[alt]};
  row.attitude = {azimuth_from_yaw(value[yaw]), -value[pitch], value[roll]};
  row.velocity_enu = {value[ve], value[vn], value[vu]};
  row.inertial = {value[ax], value[ay], value[wz], true, value[az], value[wx], value[wy]};
  row.forward_speed = std::copysign(std::hypot(value[vf], value[vu]), value[vf]);
  row.position_accuracy = value[pos_accuracy];
  return row;
}

OxtsRows read_oxts(const std::filesystem::path& folder) {
  return read_oxts(folder, read_timestamps(folder / "timestamps.txt"));
}

OxtsRows read_oxts(const std::filesystem::path& folder, Timestamps timestamps) {
  OxtsRows result;
  result.rows.resize(timestamps.size());
  result.verdicts = std::move(timestamps.verdicts);
  for (std::size_t i = 0; i < timestamps.size(); ++i) {
    if (result.verdicts[i]) continue;
    const std::filesystem::path file = folder / "data" / numbered_file(i, ".txt");
    std::size_t line = 0;
    try {
      const std::string text = read_text(file);
      line = 1;
      result.rows[i] = parse_oxts_row(text);
    } catch (const FileError& error) {
      result.verdicts[i] = Finding{file.string(), 0, error.reason()};
    } catch (const std::exception& error) {
      result.verdicts[i] = Finding{file.string(), line, error.what()};
    }
  }
  refuse_out_of_order(timestamps.stamps, timestamps.file, result.verdicts);
  result.unstamped = files_without_stamp(folder / "data", timestamps.size());
  result.stamps = std::move(timestamps.stamps);
  return result;
}

}  // namespace maploop::sensors
