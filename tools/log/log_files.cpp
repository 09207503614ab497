#include "tools/log/log_files.h"

#include <fmt/format.h>

#include <stdexcept>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/lcm/decoded_message.h"
#include "msgs/time.h"
#include "sensors/replay/log_events.h"
#include "tools/command/progress.h"

namespace maploop::lcm_log {

schema::Schema load_types(std::span<const std::filesystem::path> files) {
  const auto own = schema::own_types();
  std::vector<schema::TypeText> texts(own.begin(), own.end());
  for (const auto& file : files) {
    texts.push_back({file.string(), read_text(file, input_limits::settings)});
  }
  return schema::Schema(texts);
}

LogSummary read_log(const std::filesystem::path& file, const schema::Schema& schema,
                    const std::function<void(const LogEvent&)>& event,
                    const std::function<void(const Damage&)>& damage) {
  const auto log = sensors::open_log(file, schema);
  tools::Progress progress("MB");
  const double megabytes = 1e-6 * static_cast<double>(log->file_size());
  LogSummary summary;
  for (auto item = log->next(); item != sensors::LogEvents::Item::end; item = log->next()) {
    progress.at(1e-6 * static_cast<double>(log->file_position()), megabytes);
    if (item == sensors::LogEvents::Item::event) {
      ++summary.events;
      event(log->event());
    } else {
      ++summary.damages;
      summary.damaged_bytes += log->damage().bytes();
      if (damage) damage(log->damage());
    }
  }
  summary.bytes = log->position();
  return summary;
}

std::optional<std::string> why_undecodable(const LogEvent& event, const schema::Schema& schema) {
  const schema::Type* type = schema.find(schema::fingerprint_of(event.data));
  if (type == nullptr) return std::nullopt;
  try {
    decode(*type, event.data);
    return std::nullopt;
  } catch (const schema::DecodeError& e) {
    return fmt::format("{} does not decode as {}: {} (byte {} of the message)", event.channel,
                       type->name, e.what(), e.offset());
  }
}

void refuse_same_file(const std::filesystem::path& input, const std::filesystem::path& output) {
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error)) {
    throw std::invalid_argument("'" + output.string() +
                                "' is read and cannot be the output too: name another output file");
  }
}

std::string time_text(std::int64_t time_us) {
  constexpr std::int64_t year_2200 = 7'258'118'400'000'000;
  if (time_us < 0 || time_us >= year_2200) return std::to_string(time_us) + " us";
  const std::string nanoseconds = format_time(from_nanoseconds(time_us * 1000));
  return nanoseconds.substr(0, nanoseconds.size() - 3);
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " B";
  double value = static_cast<double>(bytes) / 1000.0;
  for (const char* unit : {"kB", "MB", "GB"}) {
    if (value < 999.95) return fmt::format("{:.1f} {}", value, unit);
    value /= 1000.0;
  }
  return fmt::format("{:.1f} TB", value);
}

double seconds_between(std::int64_t a_us, std::int64_t b_us) {
  return (static_cast<double>(b_us) - static_cast<double>(a_us)) / 1e6;
}

}  // namespace maploop::lcm_log
