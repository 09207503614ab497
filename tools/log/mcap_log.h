// Writes the events of an LCM log as an MCAP file: each unchanged, as maploop reads it back
// (sensors/replay/log_events.h), and once more as viewers show it (shown_event.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"
#include "sensors/bag/mcap_writer.h"

namespace maploop::lcm_log {

class McapLog {
 public:
  // The schema must outlive this.
  McapLog(sensors::bag::McapWriter::Append append, const schema::Schema& schema)
      : writer_(std::move(append)), schema_(schema) {}

  // An event is in one chunk (log_chunks.h). Throws
  // std::runtime_error for too many channels.
  void write(const LogEvent& event);

  // Ends the chunk.
  void flush();

  // Ends the file. Returns whether it has an index.
  bool close();

  // Counts events that were given and are not in the file.
  std::uint64_t lost() const { return lost_; }

 private:
  std::uint16_t channel(std::string_view topic, std::string_view schema_name,
                        const std::function<std::string()>& json_schema);

  sensors::bag::McapWriter writer_;
  const schema::Schema& schema_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> channels_;  // by topic and schema
  std::uint64_t in_chunk_ = 0;                                             // events
  std::uint64_t lost_ = 0;
};

}  // namespace maploop::lcm_log
