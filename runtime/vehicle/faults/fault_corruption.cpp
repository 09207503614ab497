#include "runtime/vehicle/faults/fault_corruption.h"

#include <limits>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "sensors/replay/normal_generator.h"

namespace maploop::vehicle {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Calls change(value) for each axis of the unit that the fault strikes.
template <class Change>
void each_axis(ImuSample& s, FaultTarget target, Change change) {
  if (target == FaultTarget::gyro) {
    change(s.yaw_rate);
    if (s.six_axes) change(s.roll_rate), change(s.pitch_rate);
  } else {
    change(s.specific_force_forward);
    change(s.specific_force_left);
    if (s.six_axes) change(s.specific_force_up);
  }
}

}  // namespace

void fill_with_nan(ImuSample& sample) {
  const double other = sample.six_axes ? not_a_number : 0.0;
  sample.values() = {not_a_number, not_a_number, not_a_number, sample.six_axes,
                     other,        other,        other};
}

void fill_with_nan(GnssFix& fix) {
  fix.position = {not_a_number, not_a_number, not_a_number};
  fix.position_covariance.setConstant(not_a_number);
  fix.velocity_enu.setConstant(not_a_number);
  fix.velocity_covariance.setConstant(not_a_number);
}

void fill_with_nan(GnssEpoch& epoch) {
  for (ppp::Signal& signal : epoch.epoch.signals) {
    signal.code = signal.phase = signal.doppler = signal.cn0 = not_a_number;
  }
}

void fill_with_nan(WheelSpeed& sample) {
  sample.speed = sample.sigma = not_a_number;
}

void repeat(StereoPair& pair, const StereoPair& other) {
  pair.left = other.left;
  pair.right = other.right;
}

void repeat(LidarScan& scan, const LidarScan& other) {
  scan.points = other.points;
  scan.times = other.times;
}

void repeat(ImuSample& sample, const ImuSample& other) {
  sample.values() = other.values();
}

void repeat(GnssFix& fix, const GnssFix& other) {
  fix.position = other.position;
  fix.position_covariance = other.position_covariance;
  fix.velocity_enu = other.velocity_enu;
  fix.velocity_covariance = other.velocity_covariance;
}

void repeat(GnssEpoch& epoch, const GnssEpoch& other) {
  epoch.epoch.satellites = other.epoch.satellites;
  epoch.epoch.signals = other.epoch.signals;
}

void repeat(WheelSpeed& sample, const WheelSpeed& other) {
  sample.speed = other.speed;
  sample.sigma = other.sigma;
}

void move(GnssFix& fix, const Eigen::Vector3d& by) {
  fix.position = LocalFrame(fix.position).to_geodetic(by);
}

void distort(ImuSample& sample, const Strike& strike) {
  using enum FaultKind;
  if (strike.kind == nan) return fill_with_nan(sample);
  const double by =
      strike.target == FaultTarget::gyro && strike.kind != scale ? radians(strike.by) : strike.by;
  sensors::NormalGenerator random(strike.seed, sample.stamp);
  each_axis(sample, strike.target, [&](double& value) {
    if (strike.kind == bias) value += by;
    if (strike.kind == drift) value += by * strike.elapsed;
    if (strike.kind == scale) value *= 1.0 + by;
    if (strike.kind == noise) value += by * random.next();
  });
}

void distort(GnssFix& fix, const Strike& strike) {
  using enum FaultKind;
  const Eigen::Vector3d east = strike.by * Eigen::Vector3d::UnitX();
  switch (strike.kind) {
    case nan:
      return fill_with_nan(fix);
    case bias:
      return move(fix, east);
    case spoofed:
      fix.velocity_enu += east;
      return move(fix, strike.elapsed * east);
    case drift:
      return move(fix, strike.elapsed * east);
    case noise: {
      sensors::NormalGenerator random(strike.seed, fix.stamp);
      const double e = random.next(), n = random.next(), u = random.next();
      return move(fix, strike.by * Eigen::Vector3d(e, n, u));
    }
    default:
      return;
  }
}

void distort(GnssEpoch& epoch, const Strike& strike) {
  if (strike.kind == FaultKind::nan) return fill_with_nan(epoch);
  if (strike.kind != FaultKind::noise) return;
  sensors::NormalGenerator random(strike.seed, epoch.stamp);
  for (ppp::Signal& signal : epoch.epoch.signals) signal.code += strike.by * random.next();
}

void distort(WheelSpeed& sample, const Strike& strike) {
  if (strike.kind == FaultKind::nan) return fill_with_nan(sample);
  if (strike.kind == FaultKind::scale) sample.speed *= 1.0 + strike.by;
}

bool drawn(double share, std::uint64_t seed, Time stamp) {
  // 53 random bits give a number in [0, 1).
  return share >= 1.0 || static_cast<double>(generator(seed, stamp)() >> 11U) * 0x1p-53 < share;
}

std::mt19937_64 generator(std::uint64_t seed, Time stamp) {
  const auto t = static_cast<std::uint64_t>(to_nanoseconds(stamp));
  std::seed_seq sequence{seed & 0xffffffffU, seed >> 32U, t & 0xffffffffU, t >> 32U};
  return std::mt19937_64(sequence);
}

}  // namespace maploop::vehicle
