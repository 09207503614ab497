#include "tools/profile/trace_ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace maploop::profile {
namespace {

using nlohmann::json;

constexpr auto forever = std::numeric_limits<std::int64_t>::max();

struct Span {
  std::int64_t start, end;  // 100 ns
  std::size_t what;
};

struct TracedThread {
  std::string name;
  std::vector<Span> spans{};
  std::vector<std::size_t> open{};  // indices of spans that contain the newest event
  std::size_t outermost = 0;        // index of the newest span that no other one contains
  std::vector<std::size_t> missed{};
};

struct Flow {
  std::string source;
  std::uint64_t sequence = 0;
  std::vector<std::pair<std::size_t, std::size_t>> spans{};  // of threads
  bool arrived = false;
  std::int64_t released = 0;
};

// Takes the events of a file one after the other. Those of a thread are in the order of their
// times, a span before what is inside it.
class TraceReader {
 public:
  void take(const json& event) {
    const std::string_view phase = event.at("ph").get_ref<const std::string&>();
    const auto& name = event.at("name").get_ref<const std::string&>();
    const auto id = event.at("tid").get<std::size_t>();
    if (name == "thread_name" && phase == "M") {
      threads_[id].name = event.at("args").at("name").get<std::string>();
      return;
    }
    if (phase == "X") {
      take_span(threads_[id], name, tenths(event.at("ts")), tenths(event.at("dur")));
    } else if (phase == "s" || phase == "t" || phase == "f") {
      take_mark(id, name, event);
    } else if (phase == "i" && name.starts_with("missed deadline")) {
      // A thread says so within the span of its tick, or after that of the sample.
      TracedThread& thread = threads_[id];
      if (!thread.spans.empty()) thread.missed.push_back(thread.outermost);
    }
  }

  json data(std::size_t most) {
    const std::int64_t until = end_of(most);
    json all{{"names", names_list()}, {"threads", json::array()}, {"flows", json::array()}};
    all["until"] = until == forever ? json() : json(until);
    std::map<std::size_t, std::size_t> place;
    for (auto& [id, thread] : threads_) {
      std::erase_if(thread.missed, [&](std::size_t i) { return thread.spans[i].start >= until; });
      std::erase_if(thread.spans, [&](const Span& span) { return span.start >= until; });
      if (thread.spans.empty()) continue;
      place[id] = all["threads"].size();
      all["threads"].push_back(json_of(thread));
    }
    std::vector<Flow> flows;
    for (auto& [id, flow] : flows_) {
      if (flow.arrived && arrange(flow)) flows.push_back(std::move(flow));
    }
    std::sort(flows.begin(), flows.end(),
              [](const Flow& a, const Flow& b) { return a.released < b.released; });
    for (const Flow& flow : flows) {
      json spans = json::array();
      for (const auto& [thread, span] : flow.spans) spans.push_back({place.at(thread), span});
      all["flows"].push_back(
          {{"source", flow.source}, {"sequence", flow.sequence}, {"spans", std::move(spans)}});
    }
    return all;
  }

 private:
  static std::int64_t tenths(const json& microseconds) {
    return std::llround(microseconds.get<double>() * 10.0);
  }

  static void close(TracedThread& thread, std::int64_t now) {
    while (!thread.open.empty() && thread.spans[thread.open.back()].end < now)
      thread.open.pop_back();
  }

  void take_span(TracedThread& thread, const std::string& name, std::int64_t start,
                 std::int64_t lasted) {
    close(thread, start);
    if (thread.open.empty()) thread.outermost = thread.spans.size();
    thread.open.push_back(thread.spans.size());
    thread.spans.push_back(
        {start, start + lasted, names_.try_emplace(name, names_.size()).first->second});
  }

  // A mark belongs to the innermost span that is open.
  void take_mark(std::size_t id, const std::string& source, const json& event) {
    TracedThread& thread = threads_[id];
    close(thread, tenths(event.at("ts")));
    if (thread.open.empty()) return;
    Flow& flow = flows_[{source, event.at("id").get<std::string>()}];
    flow.source = source;
    flow.sequence = event.at("args").at("sequence").get<std::uint64_t>();
    flow.spans.emplace_back(id, thread.open.back());
    flow.arrived |= event.at("ph") == "f";
  }

  // Returns the time before which at most `most` spans start.
  std::int64_t end_of(std::size_t most) const {
    std::vector<std::int64_t> starts;
    for (const auto& [id, thread] : threads_) {
      for (const Span& span : thread.spans) starts.push_back(span.start);
    }
    if (starts.size() <= most) return forever;
    const auto end = starts.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(starts.begin(), end, starts.end());
    return *end;
  }

  // Puts the spans of a flow in the order of time; returns whether none was left out.
  bool arrange(Flow& flow) const {
    const auto spans_of = [&](std::size_t thread) -> const std::vector<Span>& {
      return threads_.at(thread).spans;
    };
    for (const auto& [thread, span] : flow.spans) {
      if (span >= spans_of(thread).size()) return false;
    }
    const auto start = [&](const auto& at) { return spans_of(at.first)[at.second].start; };
    std::sort(flow.spans.begin(), flow.spans.end(),
              [&](const auto& a, const auto& b) { return start(a) < start(b); });
    flow.released = start(flow.spans.front());
    return true;
  }

  std::vector<std::string> names_list() const {
    std::vector<std::string> list(names_.size());
    for (const auto& [name, index] : names_) list[index] = name;
    return list;
  }

  static json json_of(const TracedThread& thread) {
    json start = json::array(), lasted = json::array(), what = json::array();
    std::int64_t before = 0;
    for (const Span& span : thread.spans) {
      start.push_back(span.start - std::exchange(before, span.start));
      lasted.push_back(span.end - span.start);
      what.push_back(span.what);
    }
    return {{"name", thread.name},
            {"start", std::move(start)},
            {"lasted", std::move(lasted)},
            {"what", std::move(what)},
            {"missed", thread.missed}};
  }

  std::map<std::string, std::size_t> names_;
  std::map<std::size_t, TracedThread> threads_;  // by the trace's numbers
  std::map<std::pair<std::string, std::string>, Flow> flows_;
};

}  // namespace

json read_trace_ticks(const std::filesystem::path& trace, std::size_t most) {
  const auto refuse = [&](const std::string& why) -> std::runtime_error {
    return std::runtime_error("'" + trace.string() + "' is no trace of '--trace': " + why);
  };
  std::ifstream file(trace);
  if (!file) throw refuse("it cannot be read");
  TraceReader reader;
  bool any = false;
  // An event is taken when it ends, and not kept: a trace may be larger than the memory.
  const auto take = [&](int depth, json::parse_event_t event, json& parsed) {
    constexpr int depth_of_events = 2;
    if (depth != depth_of_events || event != json::parse_event_t::object_end ||
        !parsed.contains("ph"))
      return true;
    reader.take(parsed);
    any = true;
    return false;
  };
  try {
    const json rest = json::parse(file, take);
  } catch (const json::exception& e) {
    throw refuse(e.what());
  }
  if (!any) throw refuse("it has no events");
  return reader.data(most);
}

}  // namespace maploop::profile
