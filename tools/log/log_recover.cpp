#include "tools/log/log_recover.h"

#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <memory>
#include <stdexcept>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/log/log_reader.h"
#include "tools/log/log_text.h"
#include "tools/log/log_writer.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

constexpr std::uint64_t kSmallestEvent = kHeaderBytes + 1;

// A copy of an event that is independent of its reader.
struct HeldEvent {
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::string channel;
  std::vector<std::uint8_t> data;
};

// Writes each event after its neighbours are known, with a time that fits theirs.
class TimeRepairer {
 public:
  TimeRepairer(LogWriter& writer, const RecoverParameters& parameters, Recovery& result)
      : writer_(writer), parameters_(parameters), result_(result) {}

  void write(const LogEvent& event) {
    held_.push_back({event.number,
                     event.time_us,
                     std::string(event.channel),
                     {event.data.begin(), event.data.end()}});
    if (held_.size() == 3) write_first();
  }

  void finish() {
    while (!held_.empty()) write_first();
  }

 private:
  bool earlier(std::int64_t a_us, std::int64_t b_us) const {
    return seconds_between(a_us, b_us) > parameters_.max_disorder_s;
  }

  // Returns the corrected time of the first held event.
  std::int64_t right_time() const {
    const std::int64_t time = held_[0].time_us;
    if (!last_us_) {  // the log's first event is too late only if the next two agree
      const bool late = held_.size() == 3 && earlier(held_[1].time_us, time) &&
                        earlier(held_[2].time_us, time) &&
                        !earlier(held_[2].time_us, held_[1].time_us);
      return late ? held_[1].time_us : time;
    }
    if (held_.size() == 1) return earlier(time, *last_us_) ? *last_us_ : time;
    const std::int64_t next = held_[1].time_us;
    const bool late = earlier(*last_us_, time) && earlier(next, time);
    const bool early = earlier(time, *last_us_) && earlier(time, next);
    return late || early ? *last_us_ : time;
  }

  void write_first() {
    HeldEvent event = std::move(held_.front());
    held_.front().time_us = event.time_us;
    const std::int64_t time = right_time();
    held_.pop_front();
    if (time != event.time_us) {
      ++result_.repair_count;
      if (result_.repairs.size() < parameters_.max_listed) {
        result_.repairs.push_back({event.number, event.time_us, time});
      }
    }
    last_us_ = time;
    writer_.write({.number = event.number,
                   .time_us = time,
                   .channel = event.channel,
                   .data = event.data,
                   .offset = 0});
  }

  LogWriter& writer_;
  const RecoverParameters& parameters_;
  Recovery& result_;
  std::deque<HeldEvent> held_;  // at most three
  std::optional<std::int64_t> last_us_;
};

// Combines damage with the events on both sides into an account of the losses.
class LossAccount {
 public:
  LossAccount(const RecoverParameters& parameters, Recovery& result)
      : parameters_(parameters), result_(result) {}

  void damage(const Damage& damage) {
    close({}, {});
    open_ = Loss{.begin = damage.begin, .end = damage.end, .reason = damage.reason};
    open_->after_us = last_us_;
    if (last_is_doubtful_) {
      open_->reason += "; event " + std::to_string(last_number_) +
                       " before it is kept, but may have a damaged end";
    }
  }

  void undecodable(const LogEvent& event, const std::string& reason) {
    close(event.number, event.time_us);
    const std::uint64_t size = kHeaderBytes + event.channel.size() + event.data.size();
    Loss loss{.begin = event.offset, .end = event.offset + size, .reason = reason};
    loss.first_event = loss.last_event = event.number;
    loss.after_us = loss.before_us = event.time_us;
    ++result_.lost_events;
    list(std::move(loss));
    pass(event);
  }

  void event(const LogEvent& event) {
    close(event.number, event.time_us);
    pass(event);
  }

  void finish() { close({}, {}); }

 private:
  void pass(const LogEvent& event) {
    last_number_ = event.number;
    last_us_ = event.time_us;
    last_is_doubtful_ = event.doubtful;
  }

  // `number` and `time_us` are those of the event after the loss.
  void close(std::optional<std::int64_t> number, std::optional<std::int64_t> time_us) {
    if (!open_) return;
    open_->before_us = time_us;
    // If more events are missing than the bytes could hold, one of the numbers is damaged.
    const std::uint64_t room = (open_->end - open_->begin) / kSmallestEvent;
    // The difference of unsigned numbers cannot overflow.
    const std::uint64_t missing =
        number ? static_cast<std::uint64_t>(*number) - static_cast<std::uint64_t>(last_number_) - 1
               : 0;
    if (number && *number > last_number_ && missing <= room) {
      result_.lost_events += missing;
      if (*number > last_number_ + 1) {
        open_->first_event = last_number_ + 1;
        open_->last_event = *number - 1;
      }
    }
    list(std::move(*open_));
    open_.reset();
  }

  void list(Loss loss) {
    ++result_.loss_count;
    result_.lost_bytes += loss.end - loss.begin;
    if (result_.losses.size() < parameters_.max_listed) result_.losses.push_back(std::move(loss));
  }

  const RecoverParameters& parameters_;
  Recovery& result_;
  std::optional<Loss> open_;  // the event after the loss is not known yet
  std::int64_t last_number_ = -1;
  std::optional<std::int64_t> last_us_;
  bool last_is_doubtful_ = false;
};

}  // namespace

Recovery recover(const std::filesystem::path& log, const schema::Schema& schema,
                 const std::filesystem::path& output, const RecoverParameters& parameters) {
  refuse_same_file(log, output);
  LogReader reader(log, schema);
  Progress progress(reader.input().file_size());
  LogWriter writer(output);
  Recovery result;
  result.file = log.string();
  TimeRepairer repairer(writer, parameters, result);
  LossAccount account(parameters, result);
  schema::DecodedMessage decoded;
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    progress.at(reader.input().file_position());
    if (item == LogReader::Item::damage) {
      account.damage(reader.damage());
      continue;
    }
    const LogEvent& event = reader.event();
    if (const auto* type = schema.find(schema::fingerprint_of(event.data))) {
      if (const auto error = decoded.decode(*type, event.data)) {
        account.undecodable(event, std::string(event.channel) + " does not decode as " +
                                       type->name + ": " + error->reason);
        continue;
      }
    }
    account.event(event);
    repairer.write(event);
  }
  account.finish();
  repairer.finish();
  result.bytes = reader.input().position();
  result.events = static_cast<std::uint64_t>(writer.events());
  if (result.events == 0) {
    throw std::runtime_error("'" + log.string() + "' holds no readable event: nothing written");
  }
  writer.close();
  return result;
}

std::string format_report(const Recovery& r) {
  std::string text;
  for (const Loss& loss : r.losses) {
    text += fmt::format("{}: lost bytes {} to {}", r.file, loss.begin, loss.end);
    if (loss.first_event && *loss.first_event == *loss.last_event) {
      text += fmt::format(", event {}", *loss.first_event);
    } else if (loss.first_event) {
      text += fmt::format(", events {} to {}", *loss.first_event, *loss.last_event);
    }
    if (loss.after_us && loss.before_us) {
      text +=
          fmt::format(", between {} and {} ({:.6f} s)", time_text(*loss.after_us),
                      time_text(*loss.before_us), seconds_between(*loss.after_us, *loss.before_us));
    } else if (loss.after_us) {
      text += fmt::format(", after {}", time_text(*loss.after_us));
    } else if (loss.before_us) {
      text += fmt::format(", before {}", time_text(*loss.before_us));
    }
    text += ": " + loss.reason + '\n';
  }
  if (r.loss_count > r.losses.size()) {
    text += fmt::format("... {} more losses\n", r.loss_count - r.losses.size());
  }
  for (const TimeRepair& t : r.repairs) {
    text += fmt::format("{}: time of event {} repaired: was {}, is {}\n", r.file, t.event,
                        time_text(t.was_us), time_text(t.is_us));
  }
  if (r.repair_count > r.repairs.size()) {
    text += fmt::format("... {} more times repaired\n", r.repair_count - r.repairs.size());
  }
  text += fmt::format(
      "{}: {} events recovered; lost {} bytes of {} in {} places, {} events by "
      "their numbers; {} times repaired\n",
      r.file, r.events, r.lost_bytes, r.bytes, r.loss_count, r.lost_events, r.repair_count);
  return text;
}

}  // namespace maploop::lcm_log
