#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "msgs/whole_file.h"
#include "runtime/core/histogram.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;

constexpr std::size_t most_types = 8;  // of one channel
constexpr double gap_factor = 2.5;     // two messages missing, or one with much jitter

// What is counted of a channel, in bounded memory.
struct Counts {
  std::uint64_t count = 0, bytes = 0, backwards = 0;
  std::int64_t first_us = 0, last_us = 0;
  std::map<std::uint64_t, std::uint64_t> types;  // fingerprint and number of messages
  runtime::Histogram intervals;
  double mean_s = 0.0, squares = 0.0;  // Welford's running mean and sum of squared deviations
  double longest_s = 0.0;
  std::int64_t longest_from_us = 0;

  void add(const LogEvent& event) {
    const std::uint64_t type = schema::fingerprint_of(event.data);
    if (types.size() < most_types || types.contains(type)) ++types[type];
    bytes += event.data.size();
    if (count++ == 0) {
      first_us = event.time_us;
    } else {
      add_interval(seconds_between(last_us, event.time_us));
    }
    last_us = event.time_us;
  }

  void add_interval(double seconds) {
    if (seconds < 0.0) ++backwards;
    intervals.record(from_seconds(std::clamp(seconds, -1e9, 1e9)));
    const double off = seconds - mean_s;
    mean_s += off / static_cast<double>(count - 1);
    squares += off * (seconds - mean_s);
    if (seconds > longest_s) {
      longest_s = seconds;
      longest_from_us = last_us;
    }
  }
};

// The figures of one channel, as the JSON file has them.
json figures(const Counts& c, const schema::Schema& schema) {
  json types = json::array();
  for (const auto& [fingerprint, count] : c.types) {
    const schema::Type* type = schema.find(fingerprint);
    types.push_back({{"fingerprint", fmt::format("0x{:016x}", fingerprint)},
                     {"name", type != nullptr ? json(type->name) : json(nullptr)},
                     {"count", count}});
  }
  const double duration = seconds_between(c.first_us, c.last_us);
  const double median = to_seconds(c.intervals.percentile(0.5));
  const HistogramData intervals = c.intervals.data();
  std::uint64_t gaps = intervals.above_range;
  for (const auto& [lowest, count] : intervals.buckets) {
    if (to_seconds(lowest) > gap_factor * median) gaps += count;
  }
  return {{"count", c.count},
          {"bytes", c.bytes},
          {"first_us", c.first_us},
          {"last_us", c.last_us},
          {"rate_hz", duration > 0.0 ? static_cast<double>(c.count - 1) / duration : 0.0},
          {"interval_median_s", median},
          {"interval_jitter_s",
           c.count < 3 ? 0.0 : std::sqrt(c.squares / static_cast<double>(c.count - 2))},
          {"interval_longest_s", c.longest_s},
          {"interval_longest_from_us", c.longest_from_us},
          {"gaps", gaps},
          {"backwards", c.backwards},
          {"types", types}};
}

json read_figures(const path& log, const schema::Schema& schema) {
  std::map<std::string, Counts, std::less<>> channels;
  std::uint64_t elsewhere = 0;  // events on channels beyond the most that are counted
  std::int64_t first_us = 0, last_us = 0;
  const auto add = [&](const LogEvent& event) {
    first_us = channels.empty() ? event.time_us : std::min(first_us, event.time_us);
    last_us = channels.empty() ? event.time_us : std::max(last_us, event.time_us);
    auto found = channels.find(event.channel);
    if (found == channels.end() && channels.size() < most_channels) {
      found = channels.try_emplace(std::string(event.channel)).first;
    }
    if (found != channels.end()) {
      found->second.add(event);
    } else {
      ++elsewhere;
    }
  };
  const LogSummary read = read_log(log, schema, add);
  json all = {{"file", log.string()},
              {"bytes", read.bytes},
              {"events", read.events},
              {"first_us", first_us},
              {"last_us", last_us},
              {"duration_s", seconds_between(first_us, last_us)},
              {"events_elsewhere", elsewhere},
              {"damages", read.damages},
              {"damaged_bytes", read.damaged_bytes},
              {"channels", json::object()}};
  for (const auto& [name, counts] : channels) all["channels"][name] = figures(counts, schema);
  return all;
}

double number(const json& figures, const char* key) {
  return figures[key].get<double>();
}
std::string time(const json& figures, const char* key) {
  return time_text(figures[key].get<std::int64_t>());
}
std::string size(const json& figures, const char* key) {
  return size_text(figures[key].get<std::uint64_t>());
}

std::string type_names(const json& types) {
  std::string text;
  for (const json& type : types) {
    if (!text.empty()) text += ", ";
    text += type[type["name"].is_null() ? "fingerprint" : "name"].get<std::string>();
  }
  return text;
}

void print_table(const json& log, std::ostream& out) {
  fmt::print(out, "{} events, {}, {:.3f} s from {} to {}\n", log["events"].dump(),
             size(log, "bytes"), number(log, "duration_s"), time(log, "first_us"),
             time(log, "last_us"));
  std::size_t width = 7;
  const json& channels = log["channels"];
  for (const auto& [name, c] : channels.items()) width = std::max(width, name.size());
  width = std::min(width, std::size_t{40});
  fmt::print(out, "\n{:{}} {:>9} {:>9} {:>10} {:>10} {:>9} {:>9} {:>5}  {}\n", "channel", width,
             "count", "rate Hz", "data", "median ms", "jitter ms", "max ms", "gaps", "type");
  for (const auto& [name, c] : channels.items()) {
    fmt::print(out, "{:{}} {:>9} {:9.2f} {:>10} {:10.3f} {:9.3f} {:9.1f} {:>5}  {}\n", name, width,
               c["count"].dump(), number(c, "rate_hz"), size(c, "bytes"),
               number(c, "interval_median_s") * 1e3, number(c, "interval_jitter_s") * 1e3,
               number(c, "interval_longest_s") * 1e3, c["gaps"].dump(), type_names(c["types"]));
  }
  out << "Intervals are of log time; a gap is an interval above 2.5 times the median.\n";
  for (const auto& [name, c] : channels.items()) {
    fmt::print(out, "  {}: first {}, last {}", name, time(c, "first_us"), time(c, "last_us"));
    if (c["gaps"] > 0) {
      fmt::print(out, ", longest gap {:.3f} s from {}", number(c, "interval_longest_s"),
                 time(c, "interval_longest_from_us"));
    }
    if (c["backwards"] > 0) fmt::print(out, ", time goes back {} times", c["backwards"].dump());
    out << '\n';
  }
  if (log["events_elsewhere"] > 0) {
    fmt::print(out, "{} events are on more channels than the {} shown\n",
               log["events_elsewhere"].dump(), channels.size());
  }
  if (log["damages"] > 0) {
    fmt::print(out, "damaged in {} places, {}: see 'maploop log verify'\n", log["damages"].dump(),
               size(log, "damaged_bytes"));
  }
}

}  // namespace

void info(const path& log, const schema::Schema& schema, const path& json_file, std::ostream& out) {
  const json figures = read_figures(log, schema);
  if (figures["events"] == 0 && figures["damages"] > 0) {
    throw std::runtime_error("'" + log.string() + "' holds no event: is it an LCM log?");
  }
  out << log.string() << ": ";
  if (figures["events"] == 0) {
    out << "an empty log\n";
  } else {
    print_table(figures, out);
  }
  if (json_file.empty()) return;
  // A channel's name may contain any bytes.
  const std::string text = figures.dump(2, ' ', false, json::error_handler_t::replace);
  write_whole_file(json_file, text + '\n');
}

}  // namespace maploop::lcm_log
