#include "tools/doctor/time_offsets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/calibrate/extrinsics/extrinsics.h"

namespace maploop::tools {
namespace {

constexpr double length = 20.0;  // s, of the stretch

std::string sensor_name(const std::string& name) {
  return name == "inertial unit" ? "imu" : name == "LiDAR" ? "lidar" : name;
}

TimeOffset offset_of(const extrinsics::SensorPair& pair) {
  const extrinsics::RateAlignment& r = pair.rates;
  TimeOffset offset{sensor_name(pair.a), sensor_name(pair.b), false, 0.0, 0.0, r.correlation, {}};
  offset.found = r.status == extrinsics::AlignmentStatus::ok;
  if (offset.found) {
    offset.offset = 1e3 * r.delay;
    offset.sigma = 1e3 * r.delay_sigma();
  } else {
    offset.finding = extrinsics::reason(r);
  }
  return offset;
}

}  // namespace

const web::Columns<TimeOffset> time_offset_columns{
    {"a", "stamps of", -10, 0, &TimeOffset::a},
    {"b", "against", -9, 0, &TimeOffset::b},
    {"found", "", 0, 0, &TimeOffset::found},
    {"offset_ms", "later by, ms", 13, 1, &TimeOffset::offset},
    {"sigma_ms", "sigma, ms", 10, 1, &TimeOffset::sigma},
    {"correlation", "correlation", 12, 2, &TimeOffset::correlation},
    {"finding", "", 0, 0, &TimeOffset::finding},
};

extrinsics::Stretch turning_stretch(const vehicle::Recording& recording) {
  const Duration whole = from_seconds(length);
  extrinsics::Stretch best{recording.first_stamp, recording.first_stamp + whole};
  const auto rates = extrinsics::inertial_rates(recording, {}).samples;
  double turned = 0.0, most = 0.0;  // rad of yaw in the window
  const auto turn = [&](std::size_t i) {
    const double step = i == 0 ? 0.0 : to_seconds(rates[i].stamp - rates[i - 1].stamp);
    return step * std::abs(rates[i].rate.z());
  };
  for (std::size_t begin = 0, end = 0; end < rates.size(); ++end) {
    turned += turn(end);
    while (rates[end].stamp - rates[begin].stamp > whole) turned -= turn(begin++);
    if (turned <= most) continue;
    most = turned;
    best = {rates[begin].stamp, rates[begin].stamp + whole};
  }
  return best;
}

std::vector<TimeOffset> time_offsets(const vehicle::Recording& recording,
                                     vehicle::VehicleConfig config,
                                     const extrinsics::Stretch& stretch,
                                     const extrinsics::Progress& progress) {
  vehicle::describe_car(config, recording.calibration);
  const auto measured = extrinsics::measure(recording, config, stretch, progress);
  std::vector<TimeOffset> offsets;
  for (const extrinsics::SensorPair& pair :
       extrinsics::find_extrinsics(measured, config.vehicle).pairs)
    offsets.push_back(offset_of(pair));
  return offsets;
}

std::vector<std::string> advice(const std::vector<TimeOffset>& offsets, const std::string& path) {
  constexpr double serious = 15.0;  // ms, 0.3 m at 20 m/s
  std::vector<std::string> sentences;
  bool late = false;
  for (const TimeOffset& o : offsets) {
    if (!o.found) {
      sentences.push_back("How late the stamps of " + o.a + " are against those of " + o.b +
                          " is not seen: " + o.finding + ".");
    } else if (std::abs(o.offset) > std::max(serious, 3.0 * o.sigma)) {
      late = true;
      sentences.push_back(fmt::format("The stamps of {} are {:.0f} ms {} than those of {}.", o.a,
                                      std::abs(o.offset), o.offset > 0.0 ? "later" : "earlier",
                                      o.b));
    }
  }
  if (late) {
    sentences.push_back("maploop calibrate extrinsics " + path +
                        " writes the delays to a file for --config.");
  }
  return sentences;
}

}  // namespace maploop::tools
