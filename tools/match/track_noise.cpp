#include "tools/match/track_noise.h"

#include <cmath>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "sensors/replay/normal_generator.h"

namespace maploop::match {

Track with_noise(const Track& track, double interval, const TrackNoise& noise,
                 std::vector<std::size_t>* rows) {
  Track noisy;
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
    if (rows) rows->push_back(i);
  }
  return noisy;
}

}  // namespace maploop::match
