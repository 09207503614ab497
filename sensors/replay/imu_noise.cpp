#include "sensors/replay/imu_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "msgs/frames.h"
#include "sensors/replay/normal_generator.h"

namespace maploop::sensors {
namespace {

constexpr std::uint64_t own_stream = 0x696d'7500'0000'0000;
constexpr std::uint64_t imu_sizes_stream = 0x696d'7573'697a'6500;

class NoisyImu {
 public:
  explicit NoisyImu(const ImuNoiseParameters& parameters) : p_(parameters) {}

  bool operator()(Source<ImuSample>& source, ImuSample& sample) {
    if (!source.next(sample)) return false;
    NormalGenerator normal(static_cast<std::uint64_t>(p_.seed) ^ own_stream, sample.stamp);
    if (!last_) {
      gyro_bias_ = p_.gyro_turn_on * normal.next();
      scale_ = p_.gyro_scale * normal.next();
      forward_bias_ = p_.accelerometer_turn_on * normal.next();
      left_bias_ = p_.accelerometer_turn_on * normal.next();
      drift_ = p_.gyro_instability * normal.next();
    }
    // The white noise is that of a mean over the time since the previous sample.
    constexpr double shortest = 1e-3;
    const double dt = last_ ? std::max(to_seconds(sample.stamp - *last_), shortest) : 0.1;
    const double kept = std::exp(-dt / p_.instability_time);
    drift_ = kept * drift_ + p_.gyro_instability * std::sqrt(1.0 - kept * kept) * normal.next();
    sample.yaw_rate = (1.0 + scale_) * sample.yaw_rate + gyro_bias_ + drift_ +
                      p_.gyro_white / std::sqrt(dt) * normal.next();
    sample.specific_force_forward += forward_bias_;
    sample.specific_force_left += left_bias_;
    if (sample.six_axes) disturb_other_axes(normal, dt, sample);
    last_ = sample.stamp;
    return true;
  }

 private:
  // These draws come last, so that a unit without these axes has the same noise in the others.
  void disturb_other_axes(NormalGenerator& normal, double dt, ImuSample& sample) {
    if (!last_) {
      up_bias_ = p_.accelerometer_turn_on * normal.next();
      for (Gyro* gyro : {&roll_, &pitch_}) {
        gyro->bias = p_.gyro_turn_on * normal.next();
        gyro->scale = p_.gyro_scale * normal.next();
        gyro->drift = p_.gyro_instability * normal.next();
      }
    }
    const double kept = std::exp(-dt / p_.instability_time);
    for (const auto& [gyro, rate] :
         {std::pair(&roll_, &sample.roll_rate), std::pair(&pitch_, &sample.pitch_rate)}) {
      gyro->drift =
          kept * gyro->drift + p_.gyro_instability * std::sqrt(1.0 - kept * kept) * normal.next();
      *rate = (1.0 + gyro->scale) * *rate + gyro->bias + gyro->drift +
              p_.gyro_white / std::sqrt(dt) * normal.next();
    }
    sample.specific_force_up += up_bias_;
  }

  struct Gyro {
    double bias = 0.0, scale = 0.0, drift = 0.0;
  };

  ImuNoiseParameters p_;
  std::optional<Time> last_;
  Gyro roll_, pitch_;
  double up_bias_ = 0.0;
  double gyro_bias_ = 0.0, scale_ = 0.0, drift_ = 0.0;
  double forward_bias_ = 0.0, left_bias_ = 0.0;
};

}  // namespace

ImuNoiseParameters mems_noise(std::int64_t seed) {
  constexpr double hour = 3600.0;
  constexpr double milli_g = 9.81e-3;
  ImuNoiseParameters p;
  p.gyro_turn_on = radians(300.0) / hour;
  p.gyro_instability = radians(10.0) / hour;
  p.gyro_white = radians(0.3) / std::sqrt(hour);
  p.gyro_scale = 0.002;
  p.accelerometer_turn_on = 20.0 * milli_g;
  p.seed = seed;
  return p;
}

ImuNoiseParameters drawn(const ImuNoiseParameters& parameters) {
  ImuNoiseParameters p = parameters;
  NormalGenerator draw(static_cast<std::uint64_t>(p.seed) ^ imu_sizes_stream, Time{});
  for (double* size : {&p.gyro_turn_on, &p.gyro_instability, &p.gyro_white, &p.gyro_scale,
                       &p.accelerometer_turn_on})
    *size *= draw.log_uniform(0.5, 2.0);
  p.instability_time = draw.log_uniform(50.0, 1000.0);
  return p;
}

std::unique_ptr<Source<ImuSample>> with_noise(std::unique_ptr<Source<ImuSample>> source,
                                              const ImuNoiseParameters& parameters) {
  return derived(std::move(source), NoisyImu(parameters));
}

}  // namespace maploop::sensors
