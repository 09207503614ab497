#include "sensors/velodyne/packet_clock.h"

#include <algorithm>

namespace maploop::sensors {
namespace {

constexpr std::int64_t hour_us = 3'600'000'000;

// Returns how long after `before` the time `now` is, both in microseconds of the hour, within half
// an hour either way.
Duration step_of(std::uint32_t before, std::uint32_t now) {
  std::int64_t us = std::int64_t{now} - std::int64_t{before};
  if (us > hour_us / 2) us -= hour_us;
  if (us < -hour_us / 2) us += hour_us;
  return std::chrono::microseconds(us);
}

}  // namespace

// A working clock advances with every packet, by about as much as the host's.
void PacketClock::judge(Duration step, Duration arrival_step) {
  constexpr Duration agreement = std::chrono::milliseconds(100);
  const bool goes_on = step > Duration::zero() && std::chrono::abs(step - arrival_step) < agreement;
  trust_ = std::clamp(trust_ + (goes_on ? 1 : -1), 0, 2 * trusted);
}

PacketTime PacketClock::stamp(std::uint32_t device_time, Duration period, Time arrival) {
  PacketTime time;
  const Duration arrival_step = arrival - last_arrival_;
  const bool first = !last_;
  const Duration step = first ? Duration::zero() : step_of(*last_, device_time);
  if (!first) judge(step, arrival_step);
  const bool in_hour = device_time < hour_us;
  constexpr Duration reordered = std::chrono::milliseconds(50);
  if (has_device_time() && in_hour) {
    if (step <= Duration::zero() && step > -reordered) {
      time.late = true;
      return time;
    }
    time.lost = step < std::chrono::seconds(1) && step > period
                    ? static_cast<std::uint64_t>((step + period / 2) / period - 1)
                    : 0;
  }
  device_ += step;
  last_ = device_time;
  last_arrival_ = arrival;
  const Time sent = arrival - period;
  // A clock that goes back was set. After a pause in the arrivals, a packet that continues the
  // sequence was held up by the link, and the line still gives its time; any other packet means
  // that the scanner was switched off. Without a device time, any disagreement restarts the
  // estimate.
  constexpr Duration restarted = std::chrono::seconds(1);
  const Duration pause = arrival_step - step;
  const bool jumped =
      !first && (has_device_time() ? step <= -reordered || (pause > restarted && step > 2 * period)
                                   : std::chrono::abs(pause) > restarted);
  if (jumped) offset_ = ClockOffset();
  const bool drifted_away = in_hour && offset_.add(device_, sent);
  if (has_device_time() && (jumped || drifted_away)) ++jumps_;
  time.first_firing =
      has_device_time() && in_hour && offset_.known() ? offset_.to_host(device_) : sent;
  return time;
}

void PacketClock::add(const PositionPacket& packet) {
  const std::optional<Time> utc = packet.utc();
  if (!utc || !last_ || !has_device_time() || packet.device_time >= hour_us) return;
  gps_offset_ = *utc - offset_.to_host(device_ + step_of(*last_, packet.device_time));
}

}  // namespace maploop::sensors
