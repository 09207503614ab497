#include <fmt/ostream.h>

#include <ostream>
#include <stdexcept>

#include "msgs/lcm/log/log_header.h"
#include "tools/log/log_tools.h"
#include "tools/log/log_writer.h"

namespace maploop::lcm_log {
namespace {

// Bytes that are left out, with the number and the time of the events on both sides.
struct Loss {
  Damage bytes;
  std::int64_t before = -1, after = -1;
  std::optional<std::int64_t> before_us = {}, after_us = {};  // nothing at the ends of the log

  // Returns how many events are missing, by the numbers; 0 if the bytes could not hold as many,
  // because one of the numbers is then damaged. The difference of unsigned numbers cannot overflow.
  std::uint64_t events() const {
    const auto missing = static_cast<std::uint64_t>(after) - static_cast<std::uint64_t>(before) - 1;
    return after_us && missing <= bytes.bytes() / (header_bytes + 1) ? missing : 0;
  }

  std::string text() const {
    std::string text = fmt::format("lost bytes {} to {}", bytes.begin, bytes.end);
    if (events() == 1) text += fmt::format(", event {}", before + 1);
    if (events() > 1) text += fmt::format(", events {} to {}", before + 1, after - 1);
    if (before_us && after_us) {
      text += fmt::format(", between {} and {} ({:.6f} s)", time_text(*before_us),
                          time_text(*after_us), seconds_between(*before_us, *after_us));
    } else if (before_us) {
      text += ", after " + time_text(*before_us);
    } else if (after_us) {
      text += ", before " + time_text(*after_us);
    }
    return text + ": " + bytes.reason;
  }
};

}  // namespace

Recovery recover(const path& log, const schema::Schema& schema, const path& output,
                 std::ostream& out) {
  refuse_same_file(log, output);
  LogWriter writer(output, schema);
  Recovery result;
  std::optional<Loss> open;  // the event after it is not known yet
  Loss next;                 // what is known of a loss that begins now
  const auto lose = [&](const Damage& damage) {
    if (!open) {
      open = next;
      open->bytes = damage;
    }
    open->bytes.end = damage.end;
  };
  const auto report = [&] {
    if (!open) return;
    if (++result.losses <= most_printed) out << log.string() << ": " << open->text() << '\n';
    result.lost_bytes += open->bytes.bytes();
    result.lost_events += open->events();
    open.reset();
  };
  const auto take = [&](const LogEvent& event) {
    if (const auto why = why_undecodable(event, schema)) {
      const auto size = header_bytes + event.channel.size() + event.data.size();
      return lose({event.offset, event.offset + size, *why});
    }
    if (open) {
      open->after = event.number;
      open->after_us = event.time_us;
    }
    report();
    next.before = event.number;
    next.before_us = event.time_us;
    writer.write(event);
  };
  const LogSummary read = read_log(log, schema, take, lose);
  report();
  if (writer.events() == 0) {
    throw std::runtime_error("'" + log.string() + "' holds no readable event: nothing written");
  }
  writer.close();
  result.events = writer.events();
  if (result.losses > most_printed) {
    fmt::print(out, "... {} more losses\n", result.losses - most_printed);
  }
  fmt::print(out,
             "{}: {} events recovered; lost {} bytes of {} in {} places, {} events by their "
             "numbers\n",
             log.string(), result.events, result.lost_bytes, read.bytes, result.losses,
             result.lost_events);
  return result;
}

}  // namespace maploop::lcm_log
