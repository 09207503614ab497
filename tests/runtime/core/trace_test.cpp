#include "runtime/core/trace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/runtime/core/trace_document.h"
#include "tests/support/error_of.h"

namespace maploop::runtime {
namespace {

using maploop::testing::error_of;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Trace, SpansNestAndTheirTimesAreMonotonicNanoseconds) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("stereo");
  const MonotonicTime before = monotonic_now();
  {
    TraceSpan outer(buffer, "process");
    { TraceSpan inner(buffer, "track"); }
    { TraceSpan inner(buffer, "adjust"); }
  }
  const MonotonicTime after = monotonic_now();
  const TraceDocument trace(tracer);
  const json outer = trace.event("process"), track = trace.event("track"),
             adjust = trace.event("adjust");
  EXPECT_EQ(outer.at("ph"), "X");
  EXPECT_LE(start_of(outer), start_of(track));
  EXPECT_LE(end_of(track), start_of(adjust));
  EXPECT_LE(end_of(adjust), end_of(outer));
  const auto zero = trace.other().at("start_monotonic_ns").get<std::int64_t>();
  EXPECT_GE(zero + start_of(outer), before.time_since_epoch().count());
  EXPECT_LE(zero + end_of(outer), after.time_since_epoch().count());
}

TEST(Trace, ASpanComesBeforeWhatHappensInIt) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("fusion");
  {
    TraceSpan span(buffer, "tick");
    span.end_flow({"camera", 3});
    trace_instant(buffer, "late");
  }
  std::string phases;
  const TraceDocument trace(tracer);
  for (const json& event : trace.json().at("traceEvents")) {
    phases += event.at("ph").get<std::string>();
  }
  EXPECT_EQ(phases, "MMMXfi");
}

TEST(Trace, ThreadsAreNamedAndKeepTheirOrder) {
  Tracer tracer({});
  trace_instant(&tracer.thread("camera"), "one");
  trace_instant(&tracer.thread("camera"), "two");
  const TraceDocument trace(tracer);
  const auto metadata = trace.events("M");
  ASSERT_EQ(metadata.size(), 5u);
  EXPECT_EQ(metadata[0].at("name"), "process_name");
  EXPECT_EQ(metadata[1].at("args").at("name"), "camera");
  EXPECT_EQ(metadata[2].at("args").at("sort_index"), 1);
  EXPECT_EQ(metadata[3].at("args").at("name"), "camera");
  EXPECT_EQ(metadata[4].at("args").at("sort_index"), 2);
  EXPECT_NE(trace.event("one").at("tid"), trace.event("two").at("tid"));
  EXPECT_EQ(trace.event("one").at("s"), "t");
}

TEST(Trace, AFlowIsJoinedAcrossThreadsByCategoryNameAndId) {
  Tracer tracer({});
  TraceBuffer* camera = &tracer.thread("camera");
  TraceBuffer* stereo = &tracer.thread("stereo");
  TraceBuffer* fusion = &tracer.thread("fusion");
  for (std::uint64_t sequence = 7; sequence < 10; ++sequence) {
    TraceSpan(camera, "release").start_flow({"camera", sequence});
    TraceSpan(stereo, "process").step_flow({"camera", sequence});
    TraceSpan(fusion, "tick").end_flow({"camera", sequence});
  }
  const TraceDocument trace(tracer);
  const auto starts = trace.events("s"), steps = trace.events("t"), ends = trace.events("f");
  ASSERT_EQ(starts.size(), 3u);
  ASSERT_EQ(steps.size(), 3u);
  ASSERT_EQ(ends.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    for (const char* key : {"cat", "name", "id"}) {
      EXPECT_EQ(starts[i].at(key), steps[i].at(key));
      EXPECT_EQ(starts[i].at(key), ends[i].at(key));
    }
    EXPECT_EQ(starts[i].at("args").at("sequence"), 7 + i);
    EXPECT_LE(start_of(starts[i]), start_of(steps[i]));
    EXPECT_LE(start_of(steps[i]), start_of(ends[i]));
    EXPECT_EQ(ends[i].at("bp"), "e");
  }
  EXPECT_NE(starts[0].at("id"), starts[1].at("id"));
  EXPECT_EQ(starts[0].at("id").get<std::string>().substr(0, 2), "0x");
}

TEST(Trace, TheFlowsOfTwoSourcesDiffer) {
  EXPECT_NE(flow_id("camera", 5), flow_id("velodyne", 5));
  EXPECT_NE(flow_id("camera", 5), flow_id("camera", 6));
  EXPECT_NE(flow_id("", 0), flow_id("", std::numeric_limits<std::uint64_t>::max()));
}

TEST(Trace, CountersKeepTheirValue) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("health");
  trace_counter(buffer, "third", 1.0 / 3.0);
  trace_counter(buffer, "none", -0.0);
  const TraceDocument trace(tracer);
  EXPECT_EQ(trace.event("third").at("ph"), "C");
  EXPECT_EQ(trace.event("third").at("args").at("value"), 1.0 / 3.0);
  EXPECT_EQ(trace.event("none").at("args").at("value"), 0.0);
}

TEST(Trace, ACounterWithoutAFiniteValueIsShownAsAnInstant) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("health");
  trace_counter(buffer, "rate", std::numeric_limits<double>::infinity());
  trace_counter(buffer, "age", std::numeric_limits<double>::quiet_NaN());
  const TraceDocument trace(tracer);
  EXPECT_EQ(trace.event("rate").at("ph"), "i");
  EXPECT_EQ(trace.event("rate").at("args").at("value"), "inf");
  EXPECT_EQ(trace.event("age").at("args").at("value"), "nan");
}

TEST(Trace, OffRecordsNothingAndCostsNoBuffer) {
  TraceBuffer* off = nullptr;
  TraceSpan span(off, "process");
  span.start_flow({"camera", 1});
  span.step_flow({"camera", 1});
  span.end_flow({"camera", 1});
  trace_instant(off, "late");
  trace_counter(off, "held", 1.0);
}

TEST(Trace, AFullBufferKeepsTheFirstEventsAndCountsTheRestExactly) {
  Tracer tracer({.events_per_thread = 4});
  TraceBuffer& buffer = tracer.thread("imu");
  {
    TraceSpan kept(&buffer, "kept");
    kept.start_flow({"imu", 0});
    trace_instant(&buffer, "third");
    trace_instant(&buffer, "fourth");
    trace_instant(&buffer, "dropped 1");
    kept.start_flow({"imu", 1});  // dropped 2
    TraceSpan dropped(&buffer, "dropped 3");
    dropped.step_flow({"imu", 2});  // dropped 4: it has no span
    trace_counter(&buffer, "dropped 5", 1.0);
  }
  tracer.thread("gnss");
  EXPECT_EQ(buffer.recorded(), 4u);
  EXPECT_EQ(buffer.dropped(), 5u);
  EXPECT_EQ(tracer.recorded(), 4u);
  EXPECT_EQ(tracer.dropped(), 5u);

  const TraceDocument trace(tracer);
  EXPECT_EQ(trace.other().at("dropped"), 5);
  EXPECT_EQ(trace.other().at("threads"),
            json::parse(R"([{"name": "imu", "capacity": 4, "recorded": 4, "dropped": 5},
                            {"name": "gnss", "capacity": 4, "recorded": 0, "dropped": 0}])"));
  const json kept = trace.event("kept");
  EXPECT_FALSE(kept.contains("args")) << "the span that was open when the buffer filled has ended";
  const json drops = trace.event("buffer full: events dropped from here on");
  EXPECT_EQ(drops.at("args").at("dropped"), 5);
  EXPECT_GE(start_of(drops), start_of(trace.event("fourth")));
  EXPECT_LE(start_of(drops), end_of(kept));
}

TEST(Trace, OnDemandASpanThatHasNotEndedLastsToNow) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("stereo");
  TraceSpan outer(buffer, "process");
  { TraceSpan inner(buffer, "track"); }
  {
    const TraceDocument trace(tracer);
    EXPECT_TRUE(trace.event("process").at("args").at("unfinished"));
    EXPECT_FALSE(trace.event("track").contains("args"));
    EXPECT_GE(end_of(trace.event("process")), end_of(trace.event("track")));
  }
  trace_instant(buffer, "later");
  EXPECT_FALSE(TraceDocument(tracer).event("later").is_null()) << "recording goes on";
}

TEST(Trace, ALongSpanKeepsItsNanoseconds) {
  Tracer tracer({});
  TraceEvent* event = tracer.thread("stereo").begin("long");
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  event->payload = 1'234'567;
  EXPECT_EQ(TraceDocument(tracer).event("long").at("dur").dump(), "1234.567");
}

TEST(Trace, NamesAreEscaped) {
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("a \"thread\" \\ of\nmine \xff");
  trace_instant(buffer, "\x01 <\t> \x7f \"quoted\" gr\xc3\xbc\xc3\x9f");
  const std::string made = "camera -> \"stereo\"";
  trace_counter(buffer, tracer.name(made), 2.0);
  const TraceDocument trace(tracer);
  EXPECT_EQ(trace.events("M")[1].at("args").at("name"), "a \"thread\" \\ of\nmine \xef\xbf\xbd");
  EXPECT_EQ(trace.events("i")[0].at("name"), "\x01 <\t> \x7f \"quoted\" gr\xc3\xbc\xc3\x9f");
  EXPECT_EQ(trace.events("C")[0].at("name"), made);
}

TEST(Trace, ANameMadeAtRunTimeIsKept) {
  Tracer tracer({});
  const TraceName first = tracer.name(std::string("ring ") + "1");
  for (int i = 0; i < 100; ++i) tracer.name("ring " + std::to_string(i));
  EXPECT_STREQ(first.text(), "ring 1");
  EXPECT_EQ(tracer.name("ring 1").text(), first.text()) << "the same text is stored once";
}

TEST(Trace, NoThreadAtAllIsStillATrace) {
  const TraceDocument trace{Tracer({})};
  EXPECT_EQ(trace.json().at("traceEvents").size(), 1u);
  EXPECT_EQ(trace.other().at("threads").size(), 0u);
}

TEST(Trace, AFileLargerThanTheBufferIsWhole) {
  Tracer tracer({.events_per_thread = 20'000});
  TraceBuffer* buffer = &tracer.thread("imu");
  for (int i = 0; i < 20'000; ++i) trace_counter(buffer, "held", i);
  const auto counters = TraceDocument(tracer).events("C");
  ASSERT_EQ(counters.size(), 20'000u);
  for (int i = 0; i < 20'000; ++i) {
    ASSERT_EQ(counters[static_cast<std::size_t>(i)].at("args").at("value"), i);
  }
}

TEST(Trace, WritingAgainReplacesTheFile) {
  const maploop::testing::TemporaryFolder folder;
  Tracer tracer({});
  TraceBuffer* buffer = &tracer.thread("imu");
  for (int i = 0; i < 100; ++i) trace_instant(buffer, "one");
  tracer.write(folder.path() / "trace.json");
  Tracer({}).write(folder.path() / "trace.json");
  std::ifstream file(folder.path() / "trace.json");
  EXPECT_EQ(json::parse(file).at("traceEvents").size(), 1u);
}

TEST(Trace, AFileThatCannotBeWrittenIsNamed) {
  const auto error = [](const std::filesystem::path& file) {
    return error_of([&] { Tracer({}).write(file); });
  };
  EXPECT_EQ(error("/no such folder/trace.json"),
            "cannot write '/no such folder/trace.json': No such file or directory; does its folder "
            "exist, may it be written, and has the disk room?");
  const maploop::testing::TemporaryFolder folder;
  EXPECT_THAT(error(folder.path()), HasSubstr("Is a directory"));
  EXPECT_THAT(error("/dev/full"),
              AllOf(HasSubstr("cannot write '/dev/full'"), HasSubstr("No space left on device")));
}

TEST(Trace, ABufferWithoutRoomForAnEventIsRefused) {
  EXPECT_THROW(Tracer({.events_per_thread = 0}), std::invalid_argument);
  EXPECT_THROW(Tracer({.events_per_thread = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace maploop::runtime
