#include "tools/log/log_info.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "msgs/lcm/log/log_reader.h"
#include "runtime/core/whole_file.h"
#include "tools/log/interval_statistics.h"
#include "tools/log/log_text.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;

constexpr std::size_t kMaximumCounted = 1000;  // 33 MB
constexpr std::size_t kMaximumTypes = 8;
constexpr double kGapFactor = 2.5;  // two messages missing, or one with much jitter

struct CountedChannel {
  ChannelInfo info;
  IntervalStatistics intervals;
};
using CountedChannels = std::map<std::string, std::unique_ptr<CountedChannel>, std::less<>>;

CountedChannel* find(CountedChannels& channels, std::string_view name) {
  if (const auto found = channels.find(name); found != channels.end()) return found->second.get();
  if (channels.size() == kMaximumCounted) return nullptr;
  auto& channel = channels[std::string(name)];
  channel = std::make_unique<CountedChannel>();
  channel->info.name = name;
  return channel.get();
}

void count_type(ChannelInfo& info, std::uint64_t fingerprint, const schema::Schema& schema) {
  const auto found = std::find_if(info.types.begin(), info.types.end(),
                                  [&](const TypeCount& t) { return t.fingerprint == fingerprint; });
  if (found != info.types.end()) {
    ++found->count;
  } else if (info.types.size() < kMaximumTypes) {
    const schema::Type* type = schema.find(fingerprint);
    info.types.push_back({fingerprint, type == nullptr ? "" : type->name, 1});
  }
}

void add(CountedChannel& channel, const LogEvent& event, const schema::Schema& schema) {
  ChannelInfo& info = channel.info;
  if (info.count == 0) info.first_us = event.time_us;
  info.last_us = event.time_us;
  ++info.count;
  info.bytes += event.data.size();
  channel.intervals.add(event.time_us);
  count_type(info, schema::fingerprint_of(event.data), schema);
}

ChannelInfo finish(CountedChannel& channel) {
  ChannelInfo info = std::move(channel.info);
  const double duration = seconds_between(info.first_us, info.last_us);
  if (duration > 0.0) info.rate_hz = static_cast<double>(info.count - 1) / duration;
  info.median_s = channel.intervals.median_s();
  info.jitter_s = channel.intervals.deviation_s();
  info.longest_s = channel.intervals.longest_s();
  info.longest_from_us = channel.intervals.longest_from_us();
  info.gaps = channel.intervals.longer_than_median(kGapFactor);
  info.backwards = channel.intervals.backwards();
  return info;
}

std::string hex(std::uint64_t fingerprint) {
  return fmt::format("0x{:016x}", fingerprint);
}

std::string type_text(const ChannelInfo& info) {
  std::string text;
  for (const TypeCount& type : info.types) {
    if (!text.empty()) text += ", ";
    text += type.name.empty() ? hex(type.fingerprint) : type.name;
  }
  return text;
}

}  // namespace

LogInfo read_info(const std::filesystem::path& file, const schema::Schema& schema) {
  LogReader reader(file, schema);
  Progress progress(reader.input().file_size());
  LogInfo info;
  info.file = file.string();
  CountedChannels channels;
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    progress.at(reader.input().file_position());
    if (item == LogReader::Item::damage) {
      ++info.damages;
      info.damaged_bytes += reader.damage().end - reader.damage().begin;
      continue;
    }
    const LogEvent& event = reader.event();
    if (info.events == 0) info.first_us = info.last_us = event.time_us;
    info.first_us = std::min(info.first_us, event.time_us);
    info.last_us = std::max(info.last_us, event.time_us);
    ++info.events;
    if (CountedChannel* channel = find(channels, event.channel)) {
      add(*channel, event, schema);
    } else {
      ++info.events_elsewhere;
    }
  }
  info.bytes = reader.input().position();
  if (info.events == 0 && info.damages > 0) {
    throw std::runtime_error("'" + file.string() + "' holds no event: is it an LCM log?");
  }
  for (auto& [name, channel] : channels) info.channels.push_back(finish(*channel));
  return info;
}

std::string format_table(const LogInfo& info) {
  std::string text = info.file + ": ";
  if (info.events == 0) return text + "an empty log\n";
  text += fmt::format("{} events, {}, {:.3f} s from {} to {}\n", info.events, size_text(info.bytes),
                      seconds_between(info.first_us, info.last_us), time_text(info.first_us),
                      time_text(info.last_us));
  std::size_t width = 7;
  for (const ChannelInfo& c : info.channels) width = std::max(width, c.name.size());
  const int w = static_cast<int>(std::min<std::size_t>(width, 40));
  text +=
      fmt::format("\n{:{}} {:>9} {:>9} {:>10} {:>10} {:>9} {:>9} {:>5}  {}\n", "channel", w,
                  "count", "rate Hz", "data", "median ms", "jitter ms", "max ms", "gaps", "type");
  for (const ChannelInfo& c : info.channels) {
    text += fmt::format("{:{}} {:9} {:9.2f} {:>10} {:10.3f} {:9.3f} {:9.1f} {:5}  {}\n", c.name, w,
                        c.count, c.rate_hz, size_text(c.bytes), c.median_s * 1e3, c.jitter_s * 1e3,
                        c.longest_s * 1e3, c.gaps, type_text(c));
  }
  text += "Intervals are of log time; a gap is an interval above 2.5 times the median.\n";
  for (const ChannelInfo& c : info.channels) {
    text +=
        fmt::format("  {}: first {}, last {}", c.name, time_text(c.first_us), time_text(c.last_us));
    if (c.gaps > 0) {
      text +=
          fmt::format(", longest gap {:.3f} s from {}", c.longest_s, time_text(c.longest_from_us));
    }
    if (c.backwards > 0) text += fmt::format(", time goes back {} times", c.backwards);
    text += '\n';
  }
  if (info.events_elsewhere > 0) {
    text += fmt::format("{} events are on more channels than the {} shown\n", info.events_elsewhere,
                        info.channels.size());
  }
  if (info.damages > 0) {
    text += fmt::format("damaged in {} places, {}: see 'maploop log verify'\n", info.damages,
                        size_text(info.damaged_bytes));
  }
  return text;
}

void write_json(const std::filesystem::path& file, const LogInfo& info) {
  json channels = json::object();
  for (const ChannelInfo& c : info.channels) {
    json types = json::array();
    for (const TypeCount& t : c.types) {
      types.push_back({{"fingerprint", hex(t.fingerprint)},
                       {"name", t.name.empty() ? json(nullptr) : json(t.name)},
                       {"count", t.count}});
    }
    channels[c.name] = {{"count", c.count},
                        {"bytes", c.bytes},
                        {"first_us", c.first_us},
                        {"last_us", c.last_us},
                        {"rate_hz", c.rate_hz},
                        {"interval_median_s", c.median_s},
                        {"interval_jitter_s", c.jitter_s},
                        {"interval_longest_s", c.longest_s},
                        {"interval_longest_from_us", c.longest_from_us},
                        {"gaps", c.gaps},
                        {"backwards", c.backwards},
                        {"types", types}};
  }
  const json all = {{"file", info.file},
                    {"bytes", info.bytes},
                    {"events", info.events},
                    {"first_us", info.first_us},
                    {"last_us", info.last_us},
                    {"duration_s", seconds_between(info.first_us, info.last_us)},
                    {"events_elsewhere", info.events_elsewhere},
                    {"damages", info.damages},
                    {"damaged_bytes", info.damaged_bytes},
                    {"channels", channels}};
  // A channel's name may contain any bytes.
  runtime::write_whole_file(file, all.dump(2, ' ', false, json::error_handler_t::replace) + '\n');
}

}  // namespace maploop::lcm_log
