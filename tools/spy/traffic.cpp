#include "tools/spy/traffic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <maploop_lcm/run_t.hpp>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/decoded_message.h"

namespace maploop::spy {
namespace {

constexpr std::size_t maximum_channels = 1000;
constexpr std::size_t maximum_arrivals = 4096;

// Returns the rate between the first and the last arrival, Hz.
std::optional<double> rate(const std::deque<Duration>& arrivals) {
  if (arrivals.size() < 2 || arrivals.back() == arrivals.front()) return {};
  return static_cast<double>(arrivals.size() - 1) / to_seconds(arrivals.back() - arrivals.front());
}

std::optional<double> jitter(const std::deque<Duration>& arrivals) {
  if (arrivals.size() < 3) return {};
  const auto intervals = static_cast<double>(arrivals.size() - 1);
  const double mean = to_seconds(arrivals.back() - arrivals.front()) / intervals;
  double squares = 0.0;
  for (std::size_t i = 1; i < arrivals.size(); ++i) {
    squares += std::pow(to_seconds(arrivals[i] - arrivals[i - 1]) - mean, 2);
  }
  return std::sqrt(squares / (intervals - 1.0));
}

// Stamps and sequence of the message itself, of its `header`, or of a message that is its first
// member, by the names that our types and LCM convention use.
struct Header {
  std::optional<std::int64_t> stamp_ns, utime, sequence;
};

void read(const schema::Field& parent, Header& header) {
  const bool outermost = parent.member == nullptr;
  for (const schema::Field& field : parent.inner) {
    const std::string& name = field.name();
    if (field.count() == 1) {
      const schema::Value value = field.value();
      const auto* number = std::get_if<std::int64_t>(&value);
      if (number == nullptr) continue;
      if (name == "stamp_ns") header.stamp_ns = *number;
      if (name == "utime" || name == "timestamp") header.utime = *number;
      if (name == "sequence") header.sequence = *number;
    } else if (field.sizes.empty() &&
               (&field == &parent.inner.front() || (name == "header" && outermost))) {
      read(field, header);
    }
  }
}

std::optional<Time> stamp_of(const Header& header) {
  if (header.stamp_ns) return from_nanoseconds(*header.stamp_ns);
  return header.utime ? from_microseconds(*header.utime) : std::nullopt;
}

}  // namespace

Traffic::Channel* Traffic::find(std::string_view name) {
  if (const auto found = channels_.find(name); found != channels_.end()) return &found->second;
  if (channels_.size() == maximum_channels) return nullptr;
  return &channels_[std::string(name)];
}

void Traffic::add(std::string_view name, std::span<const std::uint8_t> data, Duration arrived) {
  ++count_;
  arrived_ = arrived;
  if (name == channel_names::run) {
    maploop_lcm::run_t run;
    if (schema::checked_decode(schema_, data, run)) runs_.take(run, arrived);
  }
  Channel* channel = find(name);
  if (channel == nullptr) {
    ++elsewhere_;
    return;
  }
  ++channel->count;
  channel->last.assign(data.begin(), data.end());
  std::deque<Duration>& arrivals = channel->arrivals;
  arrivals.push_back(arrived);
  while (arrivals.size() > maximum_arrivals || arrivals.front() < arrived - window_) {
    arrivals.pop_front();
  }
  read_header(*channel);
}

void Traffic::read_header(Channel& channel) {
  const std::uint64_t fingerprint = schema::fingerprint_of(channel.last);
  const schema::Type* type = schema_.find(fingerprint);
  const std::optional<Time> previous = std::exchange(channel.stamp, std::nullopt);
  channel.type = type != nullptr ? type->name : fmt::format("0x{:016x}", fingerprint);
  const auto message = try_decode(schema_, channel.last);
  if (!message) {
    ++channel.bad;
    return;
  }
  Header header;
  read(*message, header);
  channel.stamp = stamp_of(header);
  const bool again = header.sequence && channel.sequence && *header.sequence <= *channel.sequence;
  const bool back = header.sequence ? again : previous > channel.stamp;
  if (channel.stamp && (back || !newest_ || *channel.stamp > *newest_)) newest_ = channel.stamp;
  if (header.sequence && channel.sequence && !again) {
    channel.lost += static_cast<std::uint64_t>(*header.sequence) -
                    static_cast<std::uint64_t>(*channel.sequence) - 1;
  }
  if (header.sequence) channel.sequence = header.sequence;
}

std::vector<ChannelStatus> Traffic::status(Duration now,
                                           const lcm_log::ChannelFilter& filter) const {
  std::vector<ChannelStatus> all;
  for (const auto& [name, channel] : channels_) {
    if (!filter(name)) continue;
    ChannelStatus s;
    s.name = name;
    s.type = channel.type;
    s.count = channel.count;
    s.silent_s = std::max(0.0, to_seconds(now - channel.arrivals.back()));
    if (now - channel.arrivals.back() > window_) {
      s.rate_hz = 0.0;
    } else {
      s.rate_hz = rate(channel.arrivals);
      s.jitter_s = jitter(channel.arrivals);
    }
    if (channel.stamp && newest_) {
      s.age_s = std::max(0.0, to_seconds(*newest_ - *channel.stamp));
    }
    s.bytes = channel.last.size();
    if (channel.sequence) s.lost = channel.lost;
    s.bad = channel.bad;
    all.push_back(std::move(s));
  }
  return all;
}

std::span<const std::uint8_t> Traffic::last(std::string_view channel) const {
  const auto found = channels_.find(channel);
  return found != channels_.end() ? std::span<const std::uint8_t>(found->second.last)
                                  : std::span<const std::uint8_t>();
}

}  // namespace maploop::spy
