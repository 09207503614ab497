#include "tools/profile/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "runtime/core/histogram.h"
#include "runtime/vehicle/graph/graph.h"
#include "tools/log/log_files.h"

namespace maploop::profile {
namespace {

constexpr std::size_t shown_misses = 10;

using nlohmann::json;
using Summary = LatencySummary;

auto milliseconds(Duration Summary::*figure) {
  return [figure](const Summary& s) { return to_milliseconds(s.*figure); };
}

auto corrected(Duration Latency::*figure) {
  return [figure](const Latency& l) {
    return l.hidden > 0 ? json(to_milliseconds(l.*figure)) : json();
  };
}

Latency with_correction(const LatencySummary& s) {
  runtime::Histogram all, omitted;
  all.merge(s.histogram);
  omitted.merge(s.omitted);
  all.merge(omitted);
  return {{s}, all.percentile(0.99), all.percentile(0.999), omitted.count()};
}

void add_worst(const std::vector<LatencySummary>& summaries, std::vector<WorstMiss>& worst) {
  for (const LatencySummary& s : summaries) {
    for (const MissedDeadline& miss : s.worst) {
      worst.push_back({s.name, s.deadline, miss});
    }
  }
}

}  // namespace

const web::Columns<Summary> percentiles{
    {"", "ms", -22, 0, &Summary::name},
    {"count", "count", 8, 0, &Summary::count},
    {"p50_ms", "p50", 9, 3, milliseconds(&Summary::p50)},
    {"p90_ms", "p90", 9, 3, milliseconds(&Summary::p90)},
    {"p99_ms", "p99", 9, 3, milliseconds(&Summary::p99)},
    {"p999_ms", "p99.9", 9, 3, milliseconds(&Summary::p999)},
    {"max_ms", "max", 9, 3, milliseconds(&Summary::max)},
};

web::Columns<Latency> judgement(bool virtual_time) {
  const auto judged = [virtual_time](auto value) {
    return [=](const Latency& l) { return virtual_time ? json() : json(value(l)); };
  };
  return {
      {"", "deadline", 9, 0, judged(milliseconds(&Summary::deadline))},
      {"", "missed", 7, 0, judged([](const Summary& s) { return s.misses; })},
      {"", "", 10, 3, corrected(&Latency::corrected_p99)},
      {"", "p99.9 corrected", 10, 3, corrected(&Latency::corrected_p999)},
  };
}

std::string parts_text(const MissedDeadline& miss) {
  std::string text;
  for (const MissedDeadline::Part& part : miss.parts) {
    text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", part.name,
                        to_milliseconds(part.lasted));
  }
  return text;
}

std::vector<ProcessorTime> processor_time(const Health& health) {
  std::vector<ProcessorTime> times;
  const auto add = [&](const std::string& name, double seconds) {
    times.push_back({name, seconds, 100.0 * seconds / std::max(health.elapsed, 1e-9)});
  };
  double rest = health.cpu;
  for (const ThreadHealth& t : health.threads) {
    add(t.name, t.cpu);
    rest -= t.cpu;
  }
  add("loaders and the rest", std::max(rest, 0.0));
  add("process", health.cpu);
  return times;
}

Profile profile_of(const Deadlines& deadlines, const Health& health) {
  Profile p;
  p.stamp = deadlines.stamp;
  p.health = health;
  for (const LatencySummary& s : deadlines.threads) p.threads.push_back(with_correction(s));
  for (const LatencySummary& s : deadlines.paths) p.paths.push_back(with_correction(s));
  for (const auto* summaries :
       {&deadlines.wake_up, &deadlines.execution, &deadlines.period_jitter}) {
    for (const LatencySummary& s : *summaries) runtime::Histogram().merge(s.histogram);
  }
  p.wake_up = deadlines.wake_up;
  p.execution = deadlines.execution;
  p.period_jitter = deadlines.period_jitter;
  add_worst(deadlines.threads, p.worst);
  add_worst(deadlines.paths, p.worst);
  std::stable_sort(p.worst.begin(), p.worst.end(), [](const WorstMiss& a, const WorstMiss& b) {
    return a.miss.latency - a.deadline > b.miss.latency - b.deadline;
  });
  if (p.worst.size() > shown_misses) p.worst.resize(shown_misses);
  return p;
}

void ProfileCollector::add(std::string_view channel, std::span<const std::uint8_t> data) {
  const auto take = [&](auto message, auto& to, bool& heard) {
    if (!schema::checked_decode(schema::own_schema(), data, message)) {
      ++not_understood_;
      return;
    }
    to = from_lcm(message);
    heard = true;
  };
  if (channel == vehicle::channels::deadlines.name) {
    take(maploop_lcm::deadlines_t{}, deadlines_, heard_deadlines_);
  } else if (channel == vehicle::channels::health.name) {
    take(maploop_lcm::health_t{}, health_, heard_health_);
  }
}

Profile ProfileCollector::profile(const std::string& source) const {
  if (!heard_deadlines_ || !heard_health_) {
    throw std::runtime_error(source + " has no " + (heard_deadlines_ ? "HEALTH" : "DEADLINES") +
                             (not_understood_ > 0
                                  ? " of this version, but " + std::to_string(not_understood_) +
                                        " messages of another version or damaged"
                                  : std::string()) +
                             "; a run publishes DEADLINES and HEALTH once a second, and writes "
                             "them with '--record LOG'");
  }
  try {
    return profile_of(deadlines_, health_);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error("the last DEADLINES of " + source + " is damaged: " + e.what());
  }
}

Profile profile_of_log(const std::filesystem::path& log) {
  ProfileCollector collector;
  lcm_log::read_log(log, schema::own_schema(), [&](const lcm_log::LogEvent& event) {
    collector.add(event.channel, event.data);
  });
  return collector.profile("'" + log.string() + "'");
}

}  // namespace maploop::profile
