#include <fmt/ostream.h>

#include <algorithm>
#include <functional>
#include <map>
#include <ostream>
#include <stdexcept>
#include <vector>

#include "msgs/xxh3.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

constexpr std::uint64_t most_messages = 50'000'000;  // 400 MB of hashes

// A message to be shown.
struct Shown {
  std::uint64_t seen = 0;
  std::optional<std::int64_t> time_us;  // nothing if the log has no such message
  std::vector<std::uint8_t> data;
};

struct Channel {
  std::vector<std::uint64_t> hashes_a;
  std::uint64_t count_b = 0;
  std::uint64_t differing = 0;         // among the messages that have a partner in the other log
  std::optional<std::uint64_t> first;  // that differs or has no partner, from 0
  Shown a, b;                          // that message
};
using Channels = std::map<std::string, Channel, std::less<>>;

void read_sound_log(const path& log, const schema::Schema& schema, const ChannelFilter& channels,
                    const std::function<void(const LogEvent&)>& use) {
  const auto refuse = [&](const Damage& damage) {
    throw std::runtime_error("'" + log.string() + "' is damaged at byte " +
                             std::to_string(damage.begin) + " (" + damage.reason +
                             "): see 'maploop log verify', repair with 'maploop log recover'");
  };
  // LCM sends LCM_SELF_TEST to itself when a program connects to the bus; it does not belong to a
  // run.
  const auto select = [&](const LogEvent& event) {
    if (event.channel != "LCM_SELF_TEST" && channels(event.channel)) use(event);
  };
  read_log(log, schema, select, refuse);
}

std::uint64_t hash(const LogEvent& event) {
  return XXH3_64bits(event.data.data(), event.data.size());
}

Channel& find(Channels& channels, std::string_view name) {
  if (const auto found = channels.find(name); found != channels.end()) return found->second;
  if (channels.size() == most_channels) {
    throw std::runtime_error("more than " + std::to_string(most_channels) +
                             " channels: compare some with --channels");
  }
  return channels[std::string(name)];
}

Channels compare_hashes(const path& a, const path& b, const schema::Schema& schema,
                        const ChannelFilter& filter) {
  Channels channels;
  std::uint64_t messages = 0;
  read_sound_log(a, schema, filter, [&](const LogEvent& event) {
    if (++messages > most_messages) {
      throw std::runtime_error("'" + a.string() + "' holds more than " +
                               std::to_string(most_messages) +
                               " messages: compare some with --channels, or split it first");
    }
    find(channels, event.channel).hashes_a.push_back(hash(event));
  });
  read_sound_log(b, schema, filter, [&](const LogEvent& event) {
    Channel& channel = find(channels, event.channel);
    const std::uint64_t number = channel.count_b++;
    if (number >= channel.hashes_a.size() || channel.hashes_a[number] == hash(event)) return;
    if (channel.differing++ == 0) channel.first = number;
  });
  for (auto& [name, c] : channels) {
    if (!c.first && c.hashes_a.size() != c.count_b) {
      c.first = std::min<std::uint64_t>(c.hashes_a.size(), c.count_b);
    }
  }
  return channels;
}

// Keeps the first message of each channel that differs, in `shown` of the channel.
void fetch(const path& log, const schema::Schema& schema, const ChannelFilter& filter,
           Channels& channels, Shown Channel::*shown) {
  read_sound_log(log, schema, filter, [&](const LogEvent& event) {
    Channel& channel = channels.at(std::string(event.channel));
    Shown& message = channel.*shown;
    if (!channel.first || message.seen++ != *channel.first) return;
    message.time_us = event.time_us;
    message.data.assign(event.data.begin(), event.data.end());
  });
}

}  // namespace

bool diff(const path& a, const path& b, const schema::Schema& schema, const ChannelFilter& filter,
          std::ostream& out) {
  Channels channels = compare_hashes(a, b, schema, filter);
  if (channels.empty()) {
    throw std::runtime_error("neither log has a message on these channels: nothing was compared");
  }
  const bool same = std::all_of(channels.begin(), channels.end(),
                                [](const auto& channel) { return !channel.second.first; });
  if (!same) {
    fetch(a, schema, filter, channels, &Channel::a);
    fetch(b, schema, filter, channels, &Channel::b);
  }
  for (const auto& [name, c] : channels) {
    if (!c.first) {
      fmt::print(out, "{}: same, {} messages\n", name, c.count_b);
      continue;
    }
    fmt::print(out, "{}: different: {} and {} messages, {} of them differ\n", name,
               c.hashes_a.size(), c.count_b, c.differing);
    std::optional<FieldDifference> field;
    if (c.a.time_us && c.b.time_us) field = compare(c.a.data, c.b.data, schema);
    fmt::print(out, "  message {}{}\n", *c.first, field ? ", " + field->field : "");
    const auto print_side = [&](const path& log, const Shown& shown, const std::string* value) {
      fmt::print(out, "    {}: {}{}\n", log.string(),
                 shown.time_us ? time_text(*shown.time_us) : "has no such message",
                 value != nullptr ? "  " + *value : "");
    };
    print_side(a, c.a, field ? &field->a : nullptr);
    print_side(b, c.b, field ? &field->b : nullptr);
  }
  return same;
}

}  // namespace maploop::lcm_log
