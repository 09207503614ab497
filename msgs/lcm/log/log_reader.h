// The events of an LCM log in order, and whatever between them is damaged.
//
//   LogReader reader(file);
//   for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
//     if (item == LogReader::Item::event) use(reader.event()); else complain(reader.damage());
//   }
//
// Nothing is repaired and nothing is skipped in silence: every byte of the log is in one event or
// in one damage. After damage, reading goes on at the next event.
//
// The format has no checksum, so a wrong length shows only in what follows it. An event is taken
// where another, or the end of the log, follows it, unless the event with the next number begins
// inside it. Where neither follows (damage between events, or a length that is too small), it is
// taken if its data decodes by a known type; by an unknown type, if the next event found is not
// the one with the next number, or if its channel's last message had the same fingerprint and size.
// So damage takes with it no event but those it touches, and at most one of unknown type before it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/log/log_header.h"
#include "msgs/lcm/log/log_input.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

class LogReader {
 public:
  enum class Item { event, damage, end };

  // Plain or .gz. The schema must outlive the reader. Memory stays within four times the largest
  // event that `limits` allow. Throws std::runtime_error naming the file when it cannot be opened.
  LogReader(const std::filesystem::path& file, const schema::Schema& schema,
            const LogLimits& limits = {});

  Item next();

  // Of the last next() that said so; valid until the next one.
  const LogEvent& event() const { return event_; }
  const Damage& damage() const { return damage_; }

  const LogInput& input() const { return input_; }

 private:
  // What the channel's last message looked like.
  struct Seen {
    std::uint64_t fingerprint = 0;
    std::size_t bytes = 0;
  };

  std::optional<std::string> check();
  std::optional<std::string> check_what_follows(std::span<const std::uint8_t> bytes,
                                                const LogHeader& header);
  bool next_event_inside(std::span<const std::uint8_t> bytes, const LogHeader& header,
                         bool any_number) const;
  bool trusted(std::span<const std::uint8_t> bytes, const LogHeader& header);
  void skip_to_sync();
  void remember();

  const schema::Schema& schema_;
  LogLimits limits_;
  LogInput input_;
  LogEvent event_;
  Damage damage_;
  std::size_t event_bytes_ = 0;  // of event_, not yet skipped
  bool event_waits_ = false;     // event_ comes next: the damage before it was told first
  bool failure_told_ = false;
  std::unordered_map<std::string, Seen> seen_;
  std::string channel_;  // reused key of seen_
  schema::DecodedMessage decoded_;
};

}  // namespace maploop::lcm_log
