#include "tools/log/log_diff.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>

#include "msgs/lcm/log/log_reader.h"
#include "tools/log/log_text.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

constexpr std::uint64_t kMaximumMessages = 50'000'000;  // 400 MB of hashes
constexpr std::size_t kMaximumChannels = 100'000;

struct Channel {
  std::vector<std::uint64_t> hashes_a;
  ChannelDiff result;
};
using Channels = std::map<std::string, Channel, std::less<>>;

// A message to be shown.
struct Wanted {
  std::uint64_t number = 0;
  std::uint64_t seen = 0;
  std::optional<std::int64_t> time_us;
  std::vector<std::uint8_t> data;
};
using AllWanted = std::map<std::string, Wanted, std::less<>>;

void for_each_event(const std::filesystem::path& log, const schema::Schema& schema,
                    const std::function<void(const LogEvent&)>& use) {
  LogReader reader(log, schema);
  Progress progress(reader.input().file_size());
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    progress.at(reader.input().file_position());
    if (item == LogReader::Item::damage) {
      throw std::runtime_error("'" + log.string() + "' is damaged at byte " +
                               std::to_string(reader.damage().begin) + " (" +
                               reader.damage().reason +
                               "): see 'maploop log verify', repair with 'maploop log recover'");
    }
    use(reader.event());
  }
}

std::uint64_t hash(const LogEvent& event) {
  return XXH3_64bits(event.data.data(), event.data.size());
}

Channel& find(Channels& channels, std::string_view name) {
  if (const auto found = channels.find(name); found != channels.end()) return found->second;
  if (channels.size() == kMaximumChannels) {
    throw std::runtime_error("more than " + std::to_string(kMaximumChannels) +
                             " channels: compare some with --channels");
  }
  Channel& channel = channels[std::string(name)];
  channel.result.channel = name;
  return channel;
}

void compare_with_a(Channel& channel, const LogEvent& event) {
  ChannelDiff& result = channel.result;
  const std::uint64_t number = result.count_b++;
  if (number >= channel.hashes_a.size()) return;
  if (channel.hashes_a[number] == hash(event)) return;
  ++result.differing;
  if (!result.number) result.number = number;
}

void fetch(const std::filesystem::path& log, const schema::Schema& schema, AllWanted& wanted) {
  for_each_event(log, schema, [&](const LogEvent& event) {
    const auto found = wanted.find(event.channel);
    if (found == wanted.end()) return;
    Wanted& w = found->second;
    if (w.seen++ != w.number) return;
    w.time_us = event.time_us;
    w.data.assign(event.data.begin(), event.data.end());
  });
}

void describe_first_differences(const std::filesystem::path& a, const std::filesystem::path& b,
                                const schema::Schema& schema, LogDiff& diff) {
  AllWanted of_a;
  for (const ChannelDiff& channel : diff.channels) {
    if (channel.number) of_a[channel.channel].number = *channel.number;
  }
  if (of_a.empty()) return;
  AllWanted of_b = of_a;
  fetch(a, schema, of_a);
  fetch(b, schema, of_b);
  for (ChannelDiff& channel : diff.channels) {
    if (!channel.number) continue;
    const Wanted& from_a = of_a.at(channel.channel);
    const Wanted& from_b = of_b.at(channel.channel);
    channel.time_a_us = from_a.time_us;
    channel.time_b_us = from_b.time_us;
    if (from_a.time_us && from_b.time_us) {
      channel.field = compare(from_a.data, from_b.data, schema);
    }
  }
}

// LCM sends this test message to itself when a program connects to the bus; it does not belong to a
// run.
bool compared(ChannelFilter& filter, std::string_view channel) {
  return channel != "LCM_SELF_TEST" && filter.takes(channel);
}

}  // namespace

bool LogDiff::same() const {
  return std::all_of(channels.begin(), channels.end(), [](const auto& c) { return c.same(); });
}

LogDiff diff(const std::filesystem::path& a, const std::filesystem::path& b,
             const schema::Schema& schema, ChannelFilter filter) {
  Channels channels;
  std::uint64_t messages = 0;
  for_each_event(a, schema, [&](const LogEvent& event) {
    if (!compared(filter, event.channel)) return;
    if (++messages > kMaximumMessages) {
      throw std::runtime_error("'" + a.string() + "' holds more than " +
                               std::to_string(kMaximumMessages) +
                               " messages: compare some with --channels, or split it first");
    }
    Channel& channel = find(channels, event.channel);
    channel.hashes_a.push_back(hash(event));
    ++channel.result.count_a;
  });
  for_each_event(b, schema, [&](const LogEvent& event) {
    if (compared(filter, event.channel)) compare_with_a(find(channels, event.channel), event);
  });
  LogDiff result;
  for (auto& [name, channel] : channels) {
    ChannelDiff& c = channel.result;
    if (!c.number && c.count_a != c.count_b) c.number = std::min(c.count_a, c.count_b);
    result.channels.push_back(std::move(c));
  }
  describe_first_differences(a, b, schema, result);
  return result;
}

std::string format_diff(const LogDiff& diff, const std::string& a, const std::string& b) {
  std::string text;
  for (const ChannelDiff& c : diff.channels) {
    if (c.same()) {
      text += fmt::format("{}: same, {} messages\n", c.channel, c.count_a);
      continue;
    }
    text += fmt::format("{}: different: {} and {} messages, {} of them differ\n", c.channel,
                        c.count_a, c.count_b, c.differing);
    const auto side = [&](const std::string& log, const std::optional<std::int64_t>& time_us,
                          const std::string* value) {
      text += "    " + log + ": ";
      text += time_us ? time_text(*time_us) : "has no such message";
      if (value != nullptr) text += "  " + *value;
      text += '\n';
    };
    text += fmt::format("  message {}", *c.number);
    if (c.field) text += ", " + c.field->field;
    text += '\n';
    side(a, c.time_a_us, c.field ? &c.field->a : nullptr);
    side(b, c.time_b_us, c.field ? &c.field->b : nullptr);
  }
  if (diff.channels.empty()) text += "no messages to compare\n";
  return text;
}

}  // namespace maploop::lcm_log
