#include "tools/dashboard/foxglove_bridge.h"

#include <algorithm>
#include <utility>

#include "msgs/lcm/checked_decode.h"
#include "tools/log/shown_event.h"

namespace maploop::dashboard {
namespace {

constexpr std::size_t most_bus_channels = 64;
constexpr std::int64_t second_us = 1'000'000;

}  // namespace

bool FoxgloveBridge::is_wanted(const Known& known) const {
  return std::ranges::any_of(known.channels, [&](int channel) { return server_.wanted(channel); });
}

void FoxgloveBridge::take(const lcm_log::LogEvent& event) {
  auto place = known_.find(event.channel);
  if (place == known_.end()) {
    if (known_.size() >= most_bus_channels) return;
    place = known_.try_emplace(std::string(event.channel)).first;
  }
  Known& known = place->second;
  const bool rare = event.time_us - std::exchange(known.last_us, event.time_us) >= second_us;
  if (!rare && std::exchange(known.kept, false))
    for (const int channel : known.channels) server_.forget(channel);
  const bool unknown = !known.complete && event.time_us - known.looked_at_us >= second_us;
  if (!rare && !unknown && !is_wanted(known)) return;
  known.looked_at_us = event.time_us;
  std::size_t shown = 0;
  lcm_log::show(event, schema::own_schema(), [&](const lcm_log::ShownMessage& message) {
    ++shown;
    const std::pair key(std::string(message.topic), std::string(message.schema_name));
    const auto [found, is_new] = channels_.try_emplace(key, -1);
    if (is_new) found->second = server_.add({key.first, key.second, message.schema()});
    known.channels.insert(found->second);
    if (rare || server_.wanted(found->second))
      server_.publish(found->second, 1000 * event.time_us, message.json(), rare);
  });
  known.kept |= rare;
  known.complete = shown >= lcm_log::most_shown(event.channel);
}

}  // namespace maploop::dashboard
