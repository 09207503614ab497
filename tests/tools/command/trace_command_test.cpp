// Tests `maploop replay --trace`: the file for a viewer, read by another library.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

struct Event {
  std::string thread, name, phase;
  std::int64_t start, end;  // ns; a span has both
};

// One replay of the beginning of the drive with its result and its trace.
class TracedReplay {
 public:
  explicit TracedReplay(Words options) {
    const TemporaryFolder folder;
    const auto result = folder.path() / "result.json", trace = folder.path() / "trace.json";
    options.insert(options.begin(), {"replay", drive_0013().string(), "--no-lcm", "--end", "4",
                                     "--json", result.string(), "--trace", trace.string()});
    const ProcessResult process = run_maploop(options);
    EXPECT_EQ(process.status, 0) << process.error;
    result_ = read_json(result);
    read(read_json(trace));
  }

  const json& result() const { return result_; }
  const json& other() const { return other_; }
  const std::set<std::string>& threads() const { return threads_; }
  const std::vector<Event>& events() const { return events_; }
  // Returns flows by source and id, each in order of time.
  const std::map<std::pair<std::string, std::string>, std::vector<Event>>& flows() const {
    return flows_;
  }
  int count(const std::string& phase, const std::string& name) const {
    int n = 0;
    for (const Event& e : events_) n += e.phase == phase && e.name == name ? 1 : 0;
    return n;
  }

 private:
  void read(const json& trace) {
    other_ = trace.at("otherData");
    std::map<int, std::string> names;
    for (const json& e : trace.at("traceEvents")) {
      if (e.at("name") == "thread_name") names[e.at("tid")] = e.at("args").at("name");
    }
    for (const auto& [id, name] : names) threads_.insert(name);
    for (const json& e : trace.at("traceEvents")) {
      if (e.at("ph") == "M") continue;
      Event event{names.at(e.at("tid")), e.at("name"), e.at("ph"), nanoseconds(e.at("ts")), 0};
      event.end = event.start + (e.contains("dur") ? nanoseconds(e.at("dur")) : 0);
      EXPECT_FALSE(e.contains("args") && e.at("args").contains("unfinished")) << e;
      if (e.contains("id")) flows_[{event.name, e.at("id")}].push_back(event);
      events_.push_back(std::move(event));
    }
    for (auto& [id, steps] : flows_) {
      std::stable_sort(steps.begin(), steps.end(),
                       [](const Event& a, const Event& b) { return a.start < b.start; });
    }
  }
  static std::int64_t nanoseconds(const json& microseconds) {
    return std::llround(microseconds.get<double>() * 1000.0);
  }

  json result_, other_;
  std::set<std::string> threads_;
  std::vector<Event> events_;
  std::map<std::pair<std::string, std::string>, std::vector<Event>> flows_;
};

// Returns the threads that a flow passes, in order: "camera stereo fusion publisher".
std::string way(const std::vector<Event>& steps) {
  std::string text;
  for (const Event& step : steps) text += (text.empty() ? "" : " ") + step.thread;
  return text;
}

bool inside_a_span(const TracedReplay& trace, const Event& event, const std::string& name) {
  return std::any_of(trace.events().begin(), trace.events().end(), [&](const Event& e) {
    return e.phase == "X" && e.thread == event.thread && e.name == name && e.start <= event.start &&
           event.start <= e.end;
  });
}

const TracedReplay& paced() {
  static const TracedReplay trace({"--speed", "4"});
  return trace;
}

class TraceCommand : public DriveTest {};

TEST_F(TraceCommand, EachImageAndInertialSampleFlowsToAPublishedState) {
  const TracedReplay& trace = paced();
  std::map<std::string, int> complete;
  for (const auto& [id, steps] : trace.flows()) {
    const std::string& source = id.first;
    EXPECT_EQ(way(steps), source == "camera" ? "camera stereo lidar fusion publisher"
                                             : source + " fusion publisher");
    EXPECT_TRUE(inside_a_span(trace, steps.front(), "release"));
    EXPECT_TRUE(inside_a_span(trace, steps.back(), "NAV_STATE"));
    ++complete[source];
  }
  const json& rings = trace.result().at("rings");
  for (const auto& [source, ring] : {std::pair{"camera", "camera -> stereo"},
                                     {"imu", "imu -> fusion"},
                                     {"gnss", "gnss -> fusion"}}) {
    EXPECT_EQ(complete[source], rings.at(ring).at("pushed")) << source;
  }
  EXPECT_GT(complete["camera"], 35);
}

TEST_F(TraceCommand, ShowsEveryThreadAndDropsNothing) {
  const TracedReplay trace({"--lockstep"});
  EXPECT_EQ(
      trace.threads(),
      (std::set<std::string>{"camera", "camera loader", "fusion", "gnss", "health", "imu", "lidar",
                             "publisher", "reference", "stereo", "velodyne", "velodyne loader"}));
  EXPECT_EQ(trace.other().at("dropped"), 0);
  EXPECT_EQ(trace.result().at("trace").at("dropped"), 0);
  EXPECT_GT(trace.result().at("trace").at("recorded"), 1500);
  const json& channels = trace.result().at("channels");
  for (const char* channel : {"NAV_STATE", "VO", "IMU", "GNSS_FIX", "TRUTH"}) {
    EXPECT_EQ(trace.count("X", channel), channels.at(channel).at("count")) << channel;
  }
  EXPECT_EQ(trace.count("C", "fusion -> publisher"), channels.at("NAV_STATE").at("count"));
}

TEST_F(TraceCommand, SpansOfAThreadNest) {
  const TracedReplay& trace = paced();
  std::map<std::string, std::vector<Event>> open;
  std::size_t deepest = 0;
  for (const Event& e : trace.events()) {  // a thread's events are in order of time
    if (e.phase != "X") continue;
    std::vector<Event>& stack = open[e.thread];
    while (!stack.empty() && stack.back().end <= e.start) stack.pop_back();
    if (!stack.empty()) {
      EXPECT_LE(e.end, stack.back().end) << e.thread << ": " << e.name;
    }
    stack.push_back(e);
    deepest = std::max(deepest, stack.size());
  }
  EXPECT_GE(deepest, 2u) << "what a tick takes is inside of it";
}

TEST_F(TraceCommand, AMissedDeadlineIsAnInstant) {
  const TracedReplay trace({"--fault", "slow@stereo:1:2,by=0.07"});
  const json& deadlines = trace.result().at("deadlines");
  const int misses = deadlines.at("misses");
  EXPECT_GE(misses, 15);
  EXPECT_EQ(trace.count("i", "missed deadline"), misses);
  EXPECT_EQ(trace.count("i", "missed deadline: camera path"),
            deadlines.at("paths").at("camera stamp -> state").at("misses"));
  EXPECT_EQ(trace.count("i", "stall"), trace.result().at("replay").at("stalls"));
}

TEST_F(TraceCommand, WhatDoesNotFitIsCountedAndSaid) {
  const std::string config = write("a.toml", "[trace]\nevents_per_thread = 100\n");
  const TracedReplay trace({"--lockstep", "--config", config});
  EXPECT_GT(trace.result().at("trace").at("dropped"), 500);
  EXPECT_EQ(trace.other().at("dropped"), trace.result().at("trace").at("dropped"));
}

TEST_F(TraceCommand, AFileThatCannotBeWrittenIsSaidBeforeTheDrive) {
  const ProcessResult result =
      run_maploop({"replay", drive(), "--no-lcm", "--lockstep", "--trace", "/dev/null/trace.json"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.error, HasSubstr("/dev/null/trace.json"));
}

}  // namespace
}  // namespace maploop
