#include "tools/log/mcap_log.h"

#include <algorithm>
#include <stdexcept>

#include "sensors/bag/byte_cursor.h"
#include "sensors/replay/log_events.h"
#include "tools/log/log_chunks.h"
#include "tools/log/log_files.h"
#include "tools/log/shown_event.h"

namespace maploop::lcm_log {
std::uint16_t McapLog::channel(std::string_view topic, std::string_view schema_name,
                               const std::function<std::string()>& json_schema) {
  const auto [place, is_new] =
      channels_.try_emplace({std::string(topic), std::string(schema_name)});
  if (!is_new) return place->second;
  if (channels_.size() > 2 * most_channels) {
    throw std::runtime_error("an MCAP file is not written of a log with more than " +
                             std::to_string(most_channels) + " channels");
  }
  const std::string name(topic);
  place->second = schema_name.empty()
                      ? writer_.add_channel({name, std::string(sensors::lcm_encoding), {}, {}, {}})
                      : writer_.add_channel(
                            {name, "json", std::string(schema_name), "jsonschema", json_schema()});
  return place->second;
}

void McapLog::write(const LogEvent& event) {
  const bool alone = is_alone(event.data.size());
  if (alone) flush();
  constexpr std::int64_t most_us = std::int64_t{1} << 53;
  const std::int64_t time = 1000 * std::clamp<std::int64_t>(event.time_us, 0, most_us);
  const std::string raw = std::string(sensors::lcm_topics).append(event.channel);
  writer_.write(channel(raw, {}, {}), time, sensors::bag::as_text(event.data));
  ++in_chunk_;
  show(event, schema_, [&](const ShownMessage& shown) {
    writer_.write(channel(shown.topic, shown.schema_name, shown.schema), time, shown.json());
  });
  if (alone || is_full(writer_.chunk_bytes(), writer_.chunk_nanoseconds())) flush();
}

void McapLog::flush() {
  if (!writer_.end_chunk()) lost_ += in_chunk_;
  in_chunk_ = 0;
}

bool McapLog::close() {
  flush();
  return writer_.close();
}

}  // namespace maploop::lcm_log
