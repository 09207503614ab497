#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/profile/profile.h"

namespace maploop::profile {
namespace {

using nlohmann::json;

std::string heading(const char* title) {
  return fmt::format("\n{:24}    count       p50       p90       p99     p99.9       max", title);
}

void append_latencies(std::string& text, const char* title, const std::vector<Latency>& all,
                      bool virtual_time) {
  text += heading(title) + "  deadline  missed       p99*     p99.9*   guilty\n";
  const web::Columns<Latency> judged = judgement(virtual_time);
  for (const Latency& l : all) {
    text += ' ' + web::to_text<LatencySummary>(percentiles, l) + web::to_text(judged, l) + "   " +
            l.guilty + '\n';
  }
}

void append_summaries(std::string& text, const char* title,
                      const std::vector<LatencySummary>& all) {
  text += heading(title) + '\n';
  for (const LatencySummary& s : all) text += ' ' + web::to_text(percentiles, s) + '\n';
}

json to_json(const LatencySummary& s) {
  json j = web::to_json(percentiles, s);
  json& buckets = j["buckets_ns_count"] = json::array();
  for (const auto& bucket : s.histogram.buckets) {
    buckets.push_back({bucket.lowest.count(), bucket.count});
  }
  return j;
}

json to_json(const Latency& l) {
  const LatencySummary& recorded = l;
  json j = to_json(recorded);
  j.update({{"deadline_ms", to_milliseconds(l.deadline)},
            {"misses", l.misses},
            {"guilty", l.guilty},
            {"omitted", l.hidden},
            {"corrected_p99_ms", to_milliseconds(l.corrected_p99)},
            {"corrected_p999_ms", to_milliseconds(l.corrected_p999)}});
  return j;
}

template <class Item>
json by_name(const std::vector<Item>& all) {
  json j = json::object();
  for (const Item& item : all) j[item.name] = to_json(item);
  return j;
}

json to_json(const WorstMiss& w) {
  json parts = json::object();
  for (const MissedDeadline::Part& part : w.miss.parts)
    parts[part.name] = to_milliseconds(part.lasted);
  return {{"of", w.of},
          {"stamp_ns", to_nanoseconds(w.miss.stamp)},
          {"latency_ms", to_milliseconds(w.miss.latency)},
          {"deadline_ms", to_milliseconds(w.deadline)},
          {"guilty", w.miss.guilty()},
          {"parts_ms", std::move(parts)}};
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
  text += fmt::format("\n{:24} {:>8} {:>9}\n", "Processor time", "s", "% of one");
  for (const ProcessorTime& t : processor_time(p.health)) {
    text += fmt::format("  {:22} {:8.3f} {:9.2f}\n", t.name, t.seconds, t.percent);
  }
  if (p.virtual_time()) return text + '\n' + no_deadlines + '\n';
  if (p.worst.empty()) return text + "\nNo deadline was missed.\n";
  text += "\nWorst misses\n";
  for (const WorstMiss& w : p.worst) {
    text += fmt::format("  {}  {:22} {:9.3f} of {:.0f} ms, guilty: {} ({})\n",
                        format_time(w.miss.stamp), w.of, to_milliseconds(w.miss.latency),
                        to_milliseconds(w.deadline), w.miss.guilty(), parts_text(w.miss));
  }
  return text;
}

std::string to_json(const Profile& p) {
  json j{{"stamp_ns", to_nanoseconds(p.stamp)},
         {"virtual_time", p.virtual_time()},
         {"elapsed_s", p.health.elapsed},
         {"cpu_s", p.health.cpu},
         {"threads", by_name(p.threads)},
         {"paths", by_name(p.paths)},
         {"wake_up", by_name(p.wake_up)},
         {"execution", by_name(p.execution)},
         {"period_jitter", by_name(p.period_jitter)},
         {"cpu", json::object()},
         {"worst", json::array()}};
  for (const ThreadHealth& t : p.health.threads) {
    j["cpu"][t.name] = {{"cpu_s", t.cpu}, {"left_out", t.left_out}, {"shed", t.shed}};
  }
  for (const WorstMiss& w : p.worst) j["worst"].push_back(to_json(w));
  return j.dump(2) + '\n';
}

}  // namespace maploop::profile
