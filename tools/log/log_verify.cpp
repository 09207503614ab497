#include <fmt/ostream.h>

#include <map>
#include <ostream>

#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

class Verifier {
 public:
  Verifier(const path& log, const schema::Schema& schema, std::ostream& out)
      : log_(log.string()), schema_(schema), out_(out) {}

  void damage(const Damage& damage) {
    find(fmt::format("byte {}", damage.begin),
         fmt::format("{} bytes are not an event: {}", damage.bytes(), damage.reason));
    after_damage_ = true;
  }

  void event(const LogEvent& event) {
    const std::string where = fmt::format("byte {}, event {}", event.offset, event.number);
    check_number(event, where);
    check_time(event, where);
    if (schema_.find(schema::fingerprint_of(event.data)) == nullptr) {
      ++result_.unknown;
    } else if (const auto why = why_undecodable(event, schema_)) {
      find(where, *why);
    } else {
      ++result_.decoded;
    }
    ++result_.events;
    after_damage_ = false;
  }

  Verification finish(std::uint64_t bytes) {
    if (result_.findings > most_printed) {
      fmt::print(out_, "... {} more\n", result_.findings - most_printed);
    }
    fmt::print(out_, "{}: {} events, {}; {} messages decoded, {} of unknown type; {} findings\n",
               log_, result_.events, size_text(bytes), result_.decoded, result_.unknown,
               result_.findings);
    return result_;
  }

 private:
  void find(const std::string& where, const std::string& what) {
    if (++result_.findings <= most_printed) fmt::print(out_, "{}: {}: {}\n", log_, where, what);
  }

  void check_number(const LogEvent& event, const std::string& where) {
    const bool lost_with_damage = after_damage_ && event.number > number_;
    const auto expected = static_cast<std::uint64_t>(number_) + 1;  // cannot overflow
    if (static_cast<std::uint64_t>(event.number) != expected && !lost_with_damage) {
      find(where, result_.events == 0 ? "the log begins with this event number, not with 0"
                                      : "its number follows " + std::to_string(number_));
    }
    number_ = event.number;
  }

  void check_time(const LogEvent& event, const std::string& where) {
    auto last = last_us_.find(event.channel);
    if (last == last_us_.end()) {
      if (last_us_.size() == most_channels) return;
      last = last_us_.emplace(event.channel, event.time_us).first;
    }
    const double step = seconds_between(last->second, event.time_us);
    if (step < 0.0) {
      find(where, fmt::format("time of {} goes back by {:.6f} s", event.channel, -step));
    }
    last->second = event.time_us;
  }

  std::string log_;
  const schema::Schema& schema_;
  std::ostream& out_;
  Verification result_;
  bool after_damage_ = false;
  std::int64_t number_ = -1;
  std::map<std::string, std::int64_t, std::less<>> last_us_;  // time of each channel's last message
};

}  // namespace

Verification verify(const path& log, const schema::Schema& schema, std::ostream& out) {
  Verifier verifier(log, schema, out);
  const LogSummary read = read_log(
      log, schema, [&](const LogEvent& event) { verifier.event(event); },
      [&](const Damage& damage) { verifier.damage(damage); });
  return verifier.finish(read.bytes);
}

}  // namespace maploop::lcm_log
