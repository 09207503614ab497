#include "tools/log/mcap_log.h"

#include <algorithm>
#include <stdexcept>

#include "sensors/replay/log_events.h"
#include "tools/log/log_files.h"
#include "tools/log/shown_event.h"

namespace maploop::lcm_log {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20U;
constexpr std::uint64_t chunk_nanoseconds = 1'000'000'000;
// An event of so many bytes has a chunk of its own, which those who read other channels skip.
constexpr std::size_t large_event = std::size_t{1} << 16U;

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

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
  const bool alone = event.data.size() >= large_event;
  if (alone) flush();
  constexpr std::int64_t most_us = std::int64_t{1} << 53;
  const std::int64_t time = 1000 * std::clamp<std::int64_t>(event.time_us, 0, most_us);
  const std::string raw = std::string(sensors::lcm_topics).append(event.channel);
  writer_.write(channel(raw, {}, {}), time, as_text(event.data));
  ++in_chunk_;
  show(event, schema_, [&](const ShownMessage& shown) {
    writer_.write(channel(shown.topic, shown.schema_name, shown.schema), time, shown.json());
  });
  if (alone || writer_.chunk_bytes() >= chunk_bytes ||
      writer_.chunk_nanoseconds() >= chunk_nanoseconds)
    flush();
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
