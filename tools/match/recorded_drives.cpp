#include "tools/match/recorded_drives.h"

#include <cmath>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "sensors/replay/normal_generator.h"

namespace maploop::match {

RecordedDrive read_recorded_drive(const std::filesystem::path& folder, const std::string& name) {
  return {name, read_track(folder / "oxts" / (name + ".csv.gz"), {}),
          read_labels(folder / "labels" / (name + ".csv.gz"))};
}

NoisyTrack with_noise(const Track& track, double interval, const TrackNoise& noise) {
  NoisyTrack result;
  Track& noisy = result.track;
  Eigen::Vector2d markov = Eigen::Vector2d::Zero();
  std::int64_t last_period = -1;
  for (std::size_t i = 0; i < track.size(); ++i) {
    mapmatch::VehicleFix fix = track[i];
    const double t = to_seconds(fix.stamp - track.front().stamp);
    const auto period =
        interval > 0.0 ? static_cast<std::int64_t>(t / interval + 1e-6) : last_period + 1;
    if (period == last_period) continue;
    last_period = period;
    sensors::NormalGenerator random(noise.seed, fix.stamp);
    Eigen::Vector2d error;
    for (int axis = 0; axis < 2; ++axis) {
      const double keep =
          noisy.empty() ? 0.0
                        : std::exp(-to_seconds(fix.stamp - noisy.back().stamp) / noise.markov_time);
      markov[axis] =
          keep * markov[axis] + noise.markov * std::sqrt(1.0 - keep * keep) * random.next();
      error[axis] = noise.white * random.next() + markov[axis];
    }
    const LocalFrame frame(fix.position);
    fix.position = frame.to_geodetic({error.x(), error.y(), 0.0});
    fix.covariance +=
        (noise.white * noise.white + noise.markov * noise.markov) * Eigen::Matrix2d::Identity();
    if (noise.speed > 0.0) {
      fix.speed += noise.speed * random.next();
      fix.speed_sigma = noise.speed;
    }
    if (noise.azimuth > 0.0) {
      fix.azimuth = wrap_angle(fix.azimuth + noise.azimuth * random.next());
      fix.azimuth_sigma = noise.azimuth;
    }
    noisy.push_back(fix);
    result.rows.push_back(i);
  }
  return result;
}

std::vector<NoisyTrack> InputCondition::realizations(const RecordedDrive& drive, int seeds) const {
  std::vector<NoisyTrack> all;
  TrackNoise drawn = noise;
  for (drawn.seed = 1; drawn.seed <= static_cast<std::uint64_t>(seeds); ++drawn.seed) {
    all.push_back(with_noise(drive.track, interval, drawn));
    if (noise.white + noise.markov == 0.0) break;
  }
  return all;
}

std::vector<InputCondition> input_conditions() {
  struct Rate {
    const char* name;
    double interval;
  };
  constexpr Rate rates[] = {{", 1 Hz", 1.0}, {", 10 Hz", 0.0}};
  std::vector<InputCondition> all;
  for (const Rate& rate : rates)
    all.push_back({std::string("noise-free") + rate.name, rate.interval, {}});
  for (const bool white : {true, false})
    for (const Rate& rate : rates)
      for (const int metres : {5, 10, 15})
        all.push_back(
            {(white ? "white " : "Gauss-Markov ") + std::to_string(metres) + " m" + rate.name,
             rate.interval,
             {white ? metres : 0.0, white ? 0.0 : metres, 30.0, 0.2, radians(3.0), 1}});
  return all;
}

}  // namespace maploop::match
