// Runs one estimator on the first N inputs (at most 12) of a recording, for
// tools/aarch64/count-instructions: the instructions of one more input are those of its stage.
//   stage_work stereo|lidar|fusion|mapmatch|ppp N RECORDING [MAP]
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/fusion/guarded_filter.h"
#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "mapmatch/nav_matcher.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/stages/road_map.h"

namespace maploop::vehicle {
namespace {

// As many inputs are read, however many of them are taken: reading is not counted.
constexpr int read_inputs = 12;

// Calls take(sample) for the first n samples, of which more are read.
template <class T, class Take>
void first(int n, sensors::Source<T>& source, Take take) {
  std::vector<T> samples(read_inputs);
  for (T& sample : samples) {
    if (!source.next(sample)) throw std::runtime_error("the recording is too short");
  }
  for (int i = 0; i < n; ++i) take(samples[static_cast<std::size_t>(i)]);
}

// A car that drives along the map's first road, at 10 Hz.
NavState state_on(const mapmatch::RoadNetwork& network, int i) {
  const auto shape = network.shape(0);
  const Eigen::Vector2d from = shape.front().position(), to = shape.back().position();
  const Eigen::Vector2d at = from + 0.01 * (i % 100) * (to - from);
  NavState state;
  state.stamp = state.available = from_nanoseconds(1'000'000'000) + from_seconds(0.1 * i);
  state.status = NavStatus::aided;
  state.origin = network.frame().origin();
  state.position_enu = {at.x(), at.y(), 0.0};
  const Eigen::Vector2d along = (to - from).normalized();
  state.velocity_enu = {10.0 * along.x(), 10.0 * along.y(), 0.0};
  state.attitude.azimuth = std::atan2(along.x(), along.y());
  state.forward_speed = 10.0;
  state.covariance.setIdentity();
  return state;
}

void work(const std::string& stage, int n, const std::string& path, const std::string& map_file) {
  const VehicleConfig config;
  if (stage == "mapmatch") {
    MapParameters map;
    map.file = map_file;
    const auto roads = load_road_map(map);
    mapmatch::NavMatcher matcher(roads->network, roads->rules, config.mapmatch);
    for (int i = 0; i < n; ++i) matcher.add(state_on(roads->network, i));
    return;
  }
  const Recording recording = open_recording(path, config);
  Sensors sensors = recording.sensors(Time::min());
  if (stage == "stereo") {
    stereo::StereoOdometry odometry(recording.calibration.stereo, config.stereo);
    first(n, *sensors.camera, [&](const StereoPair& pair) { odometry.process(pair); });
  } else if (stage == "lidar") {
    lidar::VisualLidarOdometer odometer(recording.calibration.T_body_velo, config.lidar);
    first(n, *sensors.velodyne, [&](const LidarScan& scan) { odometer.process(&scan, nullptr); });
  } else if (stage == "fusion") {
    fusion::GuardedFilter filter(fusion::ReducedImuFilter(config.fusion), config.guard);
    first(1, *sensors.gnss, [&](const GnssFix& fix) { filter.add(fix); });
    first(n, *sensors.imu, [&](const ImuSample& sample) {
      filter.add(sample);
      filter.aided().state_at(sample.stamp);
    });
  } else if (stage == "ppp") {
    auto filter = sensors.ppp->make_map_aided_filter();
    first(n, *sensors.epochs, [&](const GnssEpoch& epoch) { filter.process(epoch.epoch); });
  } else {
    throw std::runtime_error("there is no stage '" + stage + "'");
  }
}

}  // namespace
}  // namespace maploop::vehicle

int main(int count, char** words) {
  using maploop::vehicle::read_inputs;
  if (count < 4) {
    std::cerr << "usage: stage_work stereo|lidar|fusion|mapmatch|ppp N RECORDING [MAP]\n";
    return 2;
  }
  const int n = std::atoi(words[2]);
  if (n < 0 || n > read_inputs) {
    std::cerr << "stage_work: N is " << words[2] << "; it must be from 0 to 12\n";
    return 2;
  }
  try {
    maploop::vehicle::work(words[1], n, words[3], count > 4 ? words[4] : "");
  } catch (const std::exception& e) {
    std::cerr << "stage_work: " << e.what() << '\n';
    return 1;
  }
}
