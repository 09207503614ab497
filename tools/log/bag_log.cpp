#include "tools/log/bag_log.h"

#include <algorithm>
#include <stdexcept>

#include "sensors/replay/log_events.h"
#include "tools/log/log_chunks.h"
#include "tools/log/log_files.h"
#include "tools/log/ros_messages.h"

namespace maploop::lcm_log {

std::uint32_t BagLog::connection(std::string_view topic, const RosType& type) {
  if (const auto found = connections_.find(topic); found != connections_.end())
    return found->second;
  if (connections_.size() > 2 * most_channels) {
    throw std::runtime_error("a bag is not written of a log with more than " +
                             std::to_string(most_channels) + " channels");
  }
  return connections_[std::string(topic)] =
             writer_.add_connection({std::string(topic), std::string(type.name),
                                     std::string(type.md5), std::string(type.definition)});
}

void BagLog::write(const LogEvent& event) {
  const bool alone = is_alone(event.data.size());
  if (alone) writer_.end_chunk();
  constexpr std::int64_t most_us = 4'294'967'295'999'999;  // seconds of a bag have 32 bits
  const std::int64_t time = 1000 * std::clamp<std::int64_t>(event.time_us, 0, most_us);
  writer_.write(
      connection(std::string(sensors::lcm_topics).append(event.channel), lcm_message_type), time,
      ros_bytes(event.data));
  view(event, schema_, [&](std::string_view topic, const View& shown) {
    writer_.write(connection(topic, ros_type(shown)), time, ros_message(shown));
  });
  if (alone || is_full(writer_.chunk_bytes(), writer_.chunk_nanoseconds())) writer_.end_chunk();
}

}  // namespace maploop::lcm_log
