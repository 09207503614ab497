#include "sensors/replay/log_recording.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "msgs/input_limits.h"
#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "sensors/replay/log_events.h"

namespace maploop::sensors {
namespace {

using input_limits::longest_gap;
using input_limits::longest_pause;
using input_limits::within;
using schema::checked_decode;
using schema::own_schema;

template <class T>
class LogSource final : public Source<T> {
  using Lcm = decltype(to_lcm(T{}));

 public:
  LogSource(const std::filesystem::path& log, std::string_view channel)
      : log_(log), channel_(channel), reader_(open_log(log, own_schema(), channel)) {}

  bool next(T& sample) override {
    for (auto item = reader_->next(); item != LogEvents::Item::end; item = reader_->next()) {
      // The constructor of LogRecording refused damage; a log that has changed since is read as far
      // as possible.
      if (item != LogEvents::Item::event || reader_->event().channel != channel_) continue;
      if (!read(sample)) continue;
      ++report_.delivered;
      return true;
    }
    return false;
  }

  const SourceReport& report() const override { return report_; }

 private:
  bool read(T& sample) {
    const auto refuse = [&](const std::string& why) {
      report_.refuse(
          {log_.string(), 0,
           channel_ + ", event " + std::to_string(reader_->event().number) + ": " + why});
      return false;
    };
    if (!checked_decode(own_schema(), reader_->event().data, message_)) {
      return refuse("not a message of type " + std::string(Lcm::getTypeName()) +
                    " of this version");
    }
    try {
      if constexpr (requires { from_lcm(message_, sample); }) {
        from_lcm(message_, sample);
      } else {
        sample = from_lcm(message_);
      }
    } catch (const std::invalid_argument& e) {
      return refuse(e.what());
    }
    if (sample.available <= last_) return refuse("it is not later than the message before it");
    if (last_ != Time::min() && !within(longest_pause, last_, sample.available))
      return refuse("it is more than a day later than the message before it");
    if (!within(longest_gap, sample.stamp, sample.available))
      return refuse("it is available more than an hour from its stamp");
    last_ = sample.available;
    return true;
  }

  std::filesystem::path log_;
  std::string channel_;
  std::unique_ptr<LogEvents> reader_;
  Lcm message_{};
  Time last_ = Time::min();
  SourceReport report_;
};

// These channels can be replayed. The first one that the log has of `image_channels` defines the
// frames; without them it is the channel that begins first.
constexpr std::array image_channels{channel_names::camera, channel_names::odometry};
constexpr std::array sensor_channels{
    channel_names::camera,   channel_names::odometry,        channel_names::imu,
    channel_names::velodyne, channel_names::gnss_fix,        channel_names::wheel_speed,
    channel_names::truth,    channel_names::visual_odometry, channel_names::lidar_odometry};

// Describes one channel after a first pass over the log.
struct Seen {
  std::size_t count = 0;
  Time first{};
  Time last{};
};

using SeenChannels = std::map<std::string_view, Seen>;

// Precondition: not empty.
Seen frames_of(const SeenChannels& seen) {
  for (const std::string_view name : image_channels) {
    if (const auto found = seen.find(name); found != seen.end()) return found->second;
  }
  std::optional<Seen> earliest;
  for (const std::string_view name : sensor_channels) {
    const auto found = seen.find(name);
    if (found == seen.end()) continue;
    if (!earliest || found->second.first < earliest->first) earliest = found->second;
  }
  return earliest.value();
}

// Every message of a sensor begins with a header_t, whose stamp is returned.
std::optional<Time> stamp_of(std::span<const std::uint8_t> data) {
  constexpr int fingerprint_bytes = 8;
  maploop_lcm::header_t header{};
  if (header._decodeNoHash(data.data(), fingerprint_bytes,
                           static_cast<int>(data.size()) - fingerprint_bytes) < 0) {
    return std::nullopt;
  }
  return from_nanoseconds(header.stamp_ns);
}

}  // namespace

LogRecording::LogRecording(const std::filesystem::path& log) : log_(log) {
  const auto refuse = [&log](const std::string& why) {
    throw std::runtime_error("cannot replay the log '" + log.string() + "': " + why);
  };
  SeenChannels seen;
  bool calibrated = false, of_another_version = false;
  const auto reader = open_log(log, own_schema());
  for (auto item = reader->next(); item != LogEvents::Item::end; item = reader->next()) {
    if (item == LogEvents::Item::damage) {
      if (reader->damage().begin == 0) {
        refuse("it is not a log, a table of t and the 30 columns of OXTS, or RINEX observations");
      }
      refuse("it is damaged at byte " + std::to_string(reader->damage().begin) + " (" +
             reader->damage().reason + "); 'maploop log recover' writes a sound copy of it");
    }
    const lcm_log::LogEvent& event = reader->event();
    if (event.channel == channel_names::calibration && !calibrated) {
      maploop_lcm::calibration_t message{};
      calibrated = checked_decode(own_schema(), event.data, message);
      if (calibrated) calibration_ = from_lcm(message);
      of_another_version = !calibrated;
    }
    const auto sensor = std::find(sensor_channels.begin(), sensor_channels.end(), event.channel);
    if (sensor == sensor_channels.end()) continue;
    const std::optional<Time> stamp = stamp_of(event.data);
    if (!stamp) continue;
    Seen& s = seen[*sensor];
    if (s.count++ == 0) s.first = *stamp;
    s.last = *stamp;
  }
  if (seen.empty())
    refuse("it contains no messages of sensors; is it a log of 'maploop replay --record'?");
  if (!calibrated) {
    refuse(std::string(of_another_version ? "its calibration is from another version of maploop"
                                          : "it contains no calibration") +
           "; record it again with 'maploop replay DRIVE --record'");
  }
  for (const auto& [name, unused] : seen) channels_.emplace(name);
  const Seen frames = frames_of(seen);
  frame_count_ = frames.count;
  first_stamp_ = frames.first;
  last_stamp_ = frames.last;
}

std::optional<FusedSensors> LogRecording::fused_sensors_of(const std::filesystem::path& log) {
  const auto reader = open_log(log, own_schema(), channel_names::calibration);
  maploop_lcm::calibration_t message{};
  while (reader->next() == LogEvents::Item::event) {
    if (reader->event().channel != channel_names::calibration) continue;
    if (checked_decode(own_schema(), reader->event().data, message)) return from_lcm(message).fused;
  }
  return std::nullopt;
}

template <class T>
std::unique_ptr<Source<T>> LogRecording::source(std::string_view channel) const {
  if (!channels_.contains(channel)) return nullptr;
  return std::make_unique<LogSource<T>>(log_, channel);
}

template std::unique_ptr<Source<StereoPair>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<LidarScan>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<ImuSample>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<GnssFix>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<WheelSpeed>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<ReferencePose>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<RelativeMotion>> LogRecording::source(std::string_view) const;
template std::unique_ptr<Source<LidarMotion>> LogRecording::source(std::string_view) const;

}  // namespace maploop::sensors
