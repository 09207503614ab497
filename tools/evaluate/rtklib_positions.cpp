#include "tools/evaluate/rtklib_positions.h"

#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "sensors/folder/number_table.h"

namespace maploop::evaluation {
namespace {

// The table's seconds count from 1970 in its own scale, as doubles: to less than a microsecond.
Time calendar_of(double seconds) {
  return Time(std::chrono::microseconds(std::llround(1e6 * seconds)));
}

}  // namespace

std::vector<RtklibPosition> read_rtklib_positions(const std::filesystem::path& file) {
  const sensors::NumberTable table(file);
  const bool gpst = table.has("GPST"), geodetic = table.has("latitude");
  const std::size_t time = table.column(gpst ? "GPST" : "UTC");
  const std::array place{table.column(geodetic ? "latitude" : "x-ecef"),
                         table.column(geodetic ? "longitude" : "y-ecef"),
                         table.column(geodetic ? "height" : "z-ecef")};
  std::vector<RtklibPosition> positions;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto row = table.row(i);
    const Time calendar = calendar_of(row[time]);
    const Eigen::Vector3d p(row[place[0]], row[place[1]], row[place[2]]);
    RtklibPosition& position = positions.emplace_back();
    position.time =
        gpst ? ppp::GpsTime(calendar - Time(ppp::gps_epoch_day)) : ppp::from_utc(calendar);
    position.place =
        geodetic ? ppp::ecef_from_geodetic({radians(p.x()), radians(p.y()), p.z()}) : p;
    if (table.has("Q")) position.quality = static_cast<int>(row[table.column("Q")]);
    if (i > 0 && position.time <= positions[i - 1].time) {
      throw std::runtime_error(file.string() + ": the time of position " + std::to_string(i + 1) +
                               " is not after that of the one before");
    }
  }
  if (positions.empty()) throw std::runtime_error(file.string() + " holds no position");
  return positions;
}

}  // namespace maploop::evaluation
