#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/profile/profile.h"

namespace maploop::profile {
namespace {

using nlohmann::json;

void append_figures(std::string& text, const LatencySummary& s) {
  text += fmt::format("  {:22} {:8} {:9.3f} {:9.3f} {:9.3f} {:9.3f} {:9.3f}", s.name, s.count,
                      to_milliseconds(s.p50), to_milliseconds(s.p90), to_milliseconds(s.p99),
                      to_milliseconds(s.p999), to_milliseconds(s.max));
}

void append_latencies(std::string& text, const char* title, const std::vector<Latency>& all,
                      bool virtual_time) {
  text +=
      fmt::format("\n{:24} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} {:>10} {:>10}   {}\n",
                  title, "count", "p50", "p90", "p99", "p99.9", "max", "deadline", "missed", "p99*",
                  "p99.9*", "guilty");
  for (const Latency& l : all) {
    append_figures(text, l.recorded);
    if (virtual_time) {
      text += fmt::format(" {:>9} {:>7}", "-", "-");
    } else {
      text += fmt::format(" {:9.0f} {:7}", to_milliseconds(l.recorded.deadline), l.recorded.misses);
    }
    if (l.omitted > 0) {
      text += fmt::format(" {:10.3f} {:10.3f}   ", to_milliseconds(l.corrected_p99),
                          to_milliseconds(l.corrected_p999));
    } else {
      text += fmt::format(" {:>10} {:>10}   ", "-", "-");
    }
    text += l.recorded.guilty + '\n';
  }
}

void append_summaries(std::string& text, const char* title,
                      const std::vector<LatencySummary>& all) {
  text += fmt::format("\n{:24} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}\n", title, "count", "p50", "p90",
                      "p99", "p99.9", "max");
  for (const LatencySummary& s : all) {
    append_figures(text, s);
    text += '\n';
  }
}

void append_threads(std::string& text, const Health& health) {
  const double all = std::max(health.elapsed, 1e-9);
  text += fmt::format("\n{:24} {:>8} {:>9}\n", "Processor time", "s", "% of one");
  double known = 0.0;
  for (const ThreadHealth& t : health.threads) {
    text += fmt::format("  {:22} {:8.3f} {:9.2f}\n", t.name, t.cpu, 100.0 * t.cpu / all);
    known += t.cpu;
  }
  const double rest = std::max(0.0, health.cpu - known);
  text +=
      fmt::format("  {:22} {:8.3f} {:9.2f}\n", "loaders and the rest", rest, 100.0 * rest / all);
  text += fmt::format("  {:22} {:8.3f} {:9.2f}\n", "process", health.cpu, 100.0 * health.cpu / all);
}

json figures(const LatencySummary& s) {
  json buckets = json::array();
  for (const auto& bucket : s.histogram.buckets) {
    buckets.push_back({bucket.lowest.count(), bucket.count});
  }
  return {{"count", s.count},
          {"p50_ms", to_milliseconds(s.p50)},
          {"p90_ms", to_milliseconds(s.p90)},
          {"p99_ms", to_milliseconds(s.p99)},
          {"p999_ms", to_milliseconds(s.p999)},
          {"max_ms", to_milliseconds(s.max)},
          {"buckets_ns_count", buckets}};
}

json figures(const std::vector<Latency>& all) {
  json j = json::object();
  for (const Latency& l : all) {
    json one = figures(l.recorded);
    one["deadline_ms"] = to_milliseconds(l.recorded.deadline);
    one["misses"] = l.recorded.misses;
    one["guilty"] = l.recorded.guilty;
    one["omitted"] = l.omitted;
    one["corrected_p99_ms"] = to_milliseconds(l.corrected_p99);
    one["corrected_p999_ms"] = to_milliseconds(l.corrected_p999);
    j[l.recorded.name] = std::move(one);
  }
  return j;
}

json figures(const std::vector<LatencySummary>& all) {
  json j = json::object();
  for (const LatencySummary& s : all) j[s.name] = figures(s);
  return j;
}

}  // namespace

std::string to_text(const Profile& p) {
  std::string text = fmt::format("The run up to {}, {:.1f} s on this machine. Latencies in ms.\n",
                                 format_time(p.stamp), p.health.elapsed);
  append_latencies(text, "From release to result", p.threads, p.virtual_time());
  append_latencies(text, "From stamp to state", p.paths, p.virtual_time());
  text += "  * with the waits that stalls of the data clock hid\n";
  append_summaries(text, "Wake-up", p.wake_up);
  append_summaries(text, "Execution", p.execution);
  append_summaries(text, "Period jitter", p.period_jitter);
  append_threads(text, p.health);
  if (p.virtual_time()) return text + '\n' + no_deadlines + '\n';
  if (p.worst.empty()) return text + "\nNo deadline was missed.\n";
  text += "\nWorst misses\n";
  for (const WorstMiss& w : p.worst) {
    text += fmt::format("  {}  {:22} {:9.3f} of {:.0f} ms, guilty: {} (", format_time(w.miss.stamp),
                        w.of, to_milliseconds(w.miss.latency), to_milliseconds(w.deadline),
                        w.miss.guilty());
    const char* separator = "";
    for (const MissedDeadline::Part& part : w.miss.parts) {
      text += fmt::format("{}{} {:.3f}", separator, part.name, to_milliseconds(part.lasted));
      separator = ", ";
    }
    text += ")\n";
  }
  return text;
}

std::string to_json(const Profile& p) {
  json j;
  j["stamp_ns"] = to_nanoseconds(p.stamp);
  j["virtual_time"] = p.virtual_time();
  j["elapsed_s"] = p.health.elapsed;
  j["cpu_s"] = p.health.cpu;
  j["threads"] = figures(p.threads);
  j["paths"] = figures(p.paths);
  j["wake_up"] = figures(p.wake_up);
  j["execution"] = figures(p.execution);
  j["period_jitter"] = figures(p.period_jitter);
  j["cpu"] = json::object();
  for (const ThreadHealth& t : p.health.threads) {
    j["cpu"][t.name] = {{"cpu_s", t.cpu}, {"left_out", t.left_out}, {"shed", t.shed}};
  }
  j["worst"] = json::array();
  for (const WorstMiss& w : p.worst) {
    json parts = json::object();
    for (const MissedDeadline::Part& part : w.miss.parts)
      parts[part.name] = to_milliseconds(part.lasted);
    j["worst"].push_back({{"of", w.of},
                          {"stamp_ns", to_nanoseconds(w.miss.stamp)},
                          {"latency_ms", to_milliseconds(w.miss.latency)},
                          {"deadline_ms", to_milliseconds(w.deadline)},
                          {"guilty", w.miss.guilty()},
                          {"parts_ms", std::move(parts)}});
  }
  return j.dump(2) + '\n';
}

}  // namespace maploop::profile
