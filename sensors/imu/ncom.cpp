#include "sensors/imu/ncom.h"

#include <cmath>

namespace maploop::sensors {
namespace {

std::uint8_t sum(std::span<const std::uint8_t> bytes) {
  unsigned total = 0;
  for (const std::uint8_t b : bytes) total += b;
  return static_cast<std::uint8_t>(total);
}

// Reads three bytes, little-endian, two's complement.
int i24(std::span<const std::uint8_t> bytes, std::size_t at) {
  const int value = bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16;
  return value >= 1 << 23 ? value - (1 << 24) : value;
}

}  // namespace

std::optional<NcomSample> parse_ncom(std::span<const std::uint8_t> bytes, NcomFault& fault) {
  constexpr double force_unit = 1e-4, rate_unit = 1e-5;  // m/s^2, rad/s
  constexpr double max_force = 100.0, max_rate = 10.0;
  constexpr std::uint16_t minute = 60'000;
  constexpr std::uint8_t structure_b = 11, sensors_run = 1, last_status = 5;
  fault = NcomFault::wrong_size;
  if (bytes.size() != ncom_size) return {};
  fault = NcomFault::no_sync;
  if (bytes[0] != 0xe7) return {};
  fault = NcomFault::wrong_checksum;
  if (sum(bytes.subspan(1, 21)) != bytes[22] || sum(bytes.subspan(1, 60)) != bytes[61] ||
      sum(bytes.subspan(1, 70)) != bytes[71]) {
    return {};
  }
  fault = NcomFault::not_inertial;
  const std::uint8_t status = bytes[21];
  if (status == structure_b || status < sensors_run || status > last_status) return {};
  NcomSample s;
  s.minute_ms = static_cast<std::uint16_t>(bytes[1] | bytes[2] << 8);
  const auto force = [&](std::size_t at) { return force_unit * i24(bytes, at); };
  const auto rate = [&](std::size_t at) { return rate_unit * i24(bytes, at); };
  s.values = {force(3), -force(6), -rate(18), true, -force(9), rate(12), -rate(15)};
  fault = NcomFault::out_of_range;
  const InertialValues& v = s.values;
  for (const double f : {v.specific_force_forward, v.specific_force_left, v.specific_force_up})
    if (std::fabs(f) > max_force) return {};
  for (const double w : {v.roll_rate, v.pitch_rate, v.yaw_rate})
    if (std::fabs(w) > max_rate) return {};
  if (s.minute_ms >= minute) return {};
  fault = NcomFault::none;
  return s;
}

std::optional<Time> NcomClock::stamp(std::uint16_t minute_ms, Time arrival) {
  constexpr int minute = 60'000;
  if (last_) {
    int ms = int{minute_ms} - int{*last_};
    if (ms > minute / 2) ms -= minute;
    if (ms < -minute / 2) ms += minute;
    // The packet does not count whole minutes without a packet; the host's clock does.
    const Duration step = std::chrono::milliseconds(ms);
    const Duration away = arrival - last_arrival_ - step;
    const Duration minutes =
        std::chrono::round<std::chrono::minutes>(std::max(away, Duration::zero()));
    if (step + minutes <= Duration::zero()) return {};
    device_ += step + minutes;
  }
  last_ = minute_ms;
  last_arrival_ = arrival;
  offset_.add(device_, arrival);
  const Time t = offset_.to_host(device_);
  if (t <= last_stamp_) return {};
  last_stamp_ = t;
  return t;
}

}  // namespace maploop::sensors
