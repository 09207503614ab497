// This file reads the events of an LCM log in order, and reports the damage between them.
//
//   LogReader reader(file, schema);
//   for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
//     if (item == LogReader::Item::event) use(reader.event()); else complain(reader.damage());
//   }
//
// Nothing is repaired, and nothing is skipped silently: every byte of the log belongs to one event
// or one damage. After damage, reading continues at the next event.
//
// The format has no checksum, so a wrong length shows only in the bytes after it. An event is
// accepted if another event, or the end of the log, follows it, unless the event with the next
// number begins inside it. If neither follows (damage between events, or a length that is too
// small), it is accepted if its data decodes by a known type. So damage costs only the events that
// it touches, and at most one of unknown type before it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/log/log_header.h"
#include "msgs/lcm/log/log_input.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

class LogReader {
 public:
  enum class Item { event, damage, end };

  // Reads plain or .gz files. The schema must outlive the reader. Memory stays within four times
  // the largest event that log_header.h allows. Throws std::runtime_error that names the file if it
  // cannot be opened.
  LogReader(const std::filesystem::path& file, const schema::Schema& schema)
      : schema_(schema), input_(file) {}

  Item next();

  // These belong to the last next() that returned event or damage; valid until the next call.
  const LogEvent& event() const { return event_; }
  const Damage& damage() const { return damage_; }

  const LogInput& input() const { return input_; }

 private:
  std::optional<std::string> check();
  std::optional<std::string> check_what_follows(std::span<const std::uint8_t> bytes,
                                                const LogHeader& header);
  void skip_to_sync();

  const schema::Schema& schema_;
  LogInput input_;
  LogEvent event_;
  Damage damage_;
  std::size_t event_bytes_ = 0;  // of event_, not yet skipped
  bool event_waits_ = false;     // event_ is next: the damage before it came first
  bool failure_told_ = false;
};

}  // namespace maploop::lcm_log
