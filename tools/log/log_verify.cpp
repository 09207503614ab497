#include "tools/log/log_verify.h"

#include <fmt/format.h>
#include <map>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/log/log_reader.h"
#include "tools/log/log_text.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kMaximumTimed = 1000;  // channels whose last time is kept

class Verifier {
 public:
  Verifier(const schema::Schema& schema, const VerifyParameters& parameters, Verification& result)
      : schema_(schema), parameters_(parameters), result_(result) {}

  void damage(const Damage& damage) {
    find(damage.begin, -1,
         std::to_string(damage.end - damage.begin) + " bytes are no event: " + damage.reason);
    after_damage_ = true;
  }

  void event(const LogEvent& event) {
    check_number(event);
    check_time(event);
    check_data(event);
    ++result_.events;
    after_damage_ = false;
  }

 private:
  void find(std::uint64_t offset, std::int64_t event, std::string reason) {
    ++result_.finding_count;
    if (result_.findings.size() >= parameters_.max_listed) return;
    result_.findings.push_back({offset, event, std::move(reason)});
  }

  void check_number(const LogEvent& event) {
    const bool first = result_.events == 0;
    const auto expected = first ? 0 : static_cast<std::uint64_t>(number_) + 1;
    const bool lost_with_damage = after_damage_ && event.number > number_;
    if (static_cast<std::uint64_t>(event.number) != expected && !lost_with_damage) {
      find(event.offset, event.number,
           first ? "the log begins with this event number, not with 0"
                 : "its number follows " + std::to_string(number_));
    }
    number_ = event.number;
  }

  void check_time(const LogEvent& event) {
    const double step = seconds_between(time_us_, event.time_us);
    if (result_.events > 0 && step < 0.0) {
      if (-step > parameters_.max_disorder_s) {
        std::string reason;
        reason += fmt::format("time goes back by {:.6f} s", -step);
        find(event.offset, event.number, reason);
      } else {
        ++result_.disorders;
      }
    }
    time_us_ = event.time_us;

    const auto known = last_of_.find(event.channel);
    if (known == last_of_.end()) {
      if (last_of_.size() < kMaximumTimed) last_of_.emplace(event.channel, event.time_us);
      return;
    }
    const double since = seconds_between(known->second, event.time_us);
    if (since < 0.0 && -since <= parameters_.max_disorder_s) {
      std::string reason;
      reason += fmt::format("time of {} goes back by {:.6f} s", known->first, -since);
      find(event.offset, event.number, reason);
    }
    known->second = event.time_us;
  }

  void check_data(const LogEvent& event) {
    const schema::Type* type = schema_.find(schema::fingerprint_of(event.data));
    if (type == nullptr) {
      ++result_.unknown;
      return;
    }
    if (const auto error = decoded_.decode(*type, event.data)) {
      find(event.offset, event.number,
           std::string(event.channel) + " does not decode as " + type->name + ": " + error->reason +
               " (byte " + std::to_string(error->offset) + " of the message)");
    } else {
      ++result_.decoded;
    }
  }

  const schema::Schema& schema_;
  const VerifyParameters& parameters_;
  Verification& result_;
  bool after_damage_ = false;
  std::int64_t number_ = -1;
  std::int64_t time_us_ = 0;
  std::map<std::string, std::int64_t, std::less<>> last_of_;
  schema::DecodedMessage decoded_;
};

}  // namespace

Verification verify(const std::filesystem::path& file, const schema::Schema& schema,
                    const VerifyParameters& parameters) {
  LogReader reader(file, schema);
  Progress progress(reader.input().file_size());
  Verification result;
  result.file = file.string();
  Verifier verifier(schema, parameters, result);
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    progress.at(reader.input().file_position());
    if (item == LogReader::Item::damage) {
      verifier.damage(reader.damage());
    } else {
      verifier.event(reader.event());
    }
  }
  result.bytes = reader.input().position();
  return result;
}

std::string format_findings(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings) {
    text += v.file + ": byte " + std::to_string(f.offset);
    if (f.event >= 0) text += ", event " + std::to_string(f.event);
    text += ": " + f.reason + '\n';
  }
  if (v.finding_count > v.findings.size()) {
    text += "... " + std::to_string(v.finding_count - v.findings.size()) + " more\n";
  }
  text += fmt::format("{}: {} events, {}; {} messages decoded, {} of unknown type; {} findings\n",
                      v.file, v.events, size_text(v.bytes), v.decoded, v.unknown, v.finding_count);
  if (v.disorders > 0) {
    text +=
        fmt::format("times went back {} times by no more than threads may differ\n", v.disorders);
  }
  return text;
}

}  // namespace maploop::lcm_log
