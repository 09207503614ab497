// Tests `maploop profile`, on messages made by hand and on a replay of the recorded drive.
#include "tools/profile/profile.h"

#include <fstream>

#include "msgs/lcm/conversions.h"
#include "runtime/core/histogram.h"
#include "tests/support/command_test.h"
#include "tools/profile/comparison.h"
#include "tools/profile/trace_ticks.h"

namespace maploop::profile {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using namespace testing;

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// Returns a thread with 100 ticks of 1 ms, and one tick of 105 ms whose stall hid nine more.
Deadlines stalled_thread() {
  runtime::Histogram recorded, omitted;
  for (int i = 0; i < 100; ++i) recorded.record(milliseconds(1));
  recorded.record(milliseconds(105));
  omitted.record_omitted(milliseconds(105), milliseconds(10));
  Deadlines d;
  d.threads = {recorded.summarize("fu<s>ion")};
  d.threads[0].deadline = milliseconds(2);
  d.threads[0].misses = 1;
  d.threads[0].omitted = omitted.data();
  d.threads[0].worst = {{from_nanoseconds(42),
                         milliseconds(105),
                         {{"woken late", milliseconds(100)}, {"running", milliseconds(5)}}}};
  d.threads[0].guilty = "woken late";
  return d;
}

Profile profile_of(const Deadlines& deadlines, const Health& health) {
  ProfileCollector collector;
  collector.add("DEADLINES", encoded(to_lcm(deadlines)));
  collector.add("HEALTH", encoded(to_lcm(health)));
  return collector.profile("test");
}

TEST(Profile, TheCorrectedPercentilesHoldTheHiddenWaits) {
  const Profile p = profile_of(stalled_thread(), {});
  ASSERT_EQ(p.threads.size(), 1u);
  EXPECT_EQ(p.threads[0].hidden, 9u);
  EXPECT_LT(p.threads[0].p99, milliseconds(2)) << "1 of 101";
  EXPECT_GT(p.threads[0].corrected_p99, milliseconds(90)) << "10 of 110";
  EXPECT_EQ(p.threads[0].corrected_p999, milliseconds(105));
}

TEST(Profile, TheLastMessagesCount) {
  Health early, late;
  early.cpu = 1.0;
  late.cpu = 2.0;
  ProfileCollector collector;
  collector.add("HEALTH", encoded(to_lcm(early)));
  collector.add("DEADLINES", encoded(to_lcm(Deadlines{})));
  collector.add("DEADLINES", encoded(to_lcm(stalled_thread())));
  collector.add("HEALTH", encoded(to_lcm(late)));
  collector.add("NAV_STATE", encoded(to_lcm(NavState{})));
  EXPECT_EQ(collector.profile("test").health.cpu, 2.0);
  EXPECT_EQ(collector.profile("test").threads.size(), 1u);
}

TEST(ProfileComparison, HasRatiosAndADashForWhatOneRunLacks) {
  Deadlines slower = stalled_thread();
  slower.threads[0].p50 = 3 * slower.threads[0].p50;
  slower.threads[0].misses = 0;
  slower.threads.push_back(LatencySummary{.name = "ppp"});
  Health health;
  health.cpu = 2.0;
  const Comparison c =
      compare("first", profile_of(stalled_thread(), health), "second", profile_of(slower, health));
  ASSERT_EQ(c.groups.size(), 1u) << "the other groups are empty";
  const std::vector<Compared>& threads = c.groups[0].items;
  ASSERT_EQ(threads.size(), 2u);
  EXPECT_NEAR(threads[0].p50.ratio(), 3.0, 1e-9);
  EXPECT_NEAR(threads[0].missed.a, 100.0 / 101.0, 1e-9);
  EXPECT_EQ(threads[0].missed.b, 0.0);
  EXPECT_FALSE(std::isfinite(threads[1].p50.a)) << "only the second run has ppp, and no epoch";
  EXPECT_NE(to_text(c).find("  3.00"), std::string::npos) << to_text(c);
  EXPECT_EQ(json::parse(to_json(c))["Processor time"]["process"]["processor"]["ratio"], 1.0);
  EXPECT_NE(to_html(c).find("fu&lt;s&gt;ion"), std::string::npos);
}

TEST(Profile, DamagedAndForeignMessagesAreNamed) {
  const auto good = encoded(to_lcm(stalled_thread()));
  const auto refused = [](std::vector<std::uint8_t> deadlines) -> std::string {
    ProfileCollector collector;
    collector.add("HEALTH", encoded(to_lcm(Health{})));
    if (!deadlines.empty()) collector.add("DEADLINES", deadlines);
    try {
      collector.profile("the log");
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "taken";
  };
  EXPECT_EQ(refused(good), "taken");
  EXPECT_EQ(refused({}).substr(0, 24), "the log has no DEADLINES");
  auto other_version = good;
  other_version[3] ^= 1;
  EXPECT_NE(refused(other_version).find("another version"), std::string::npos);
  auto cut = good;
  cut.resize(cut.size() / 2);
  EXPECT_NE(refused(cut).find("damaged"), std::string::npos);

  Deadlines no_histogram = stalled_thread();
  no_histogram.threads[0].histogram.buckets[0].lowest = Duration(257);
  EXPECT_NE(refused(encoded(to_lcm(no_histogram))).find("bucket of 257 ns"), std::string::npos);
}

TEST(Profile, NamesCannotBreakThePage) {
  const std::string html = to_html(profile_of(stalled_thread(), {}), "a & b.lcmlog", {});
  EXPECT_EQ(html.find("fu<s>ion"), std::string::npos);
  EXPECT_NE(html.find("fu&lt;s&gt;ion"), std::string::npos);
  EXPECT_NE(html.find("a &amp; b.lcmlog"), std::string::npos);
}

TEST(Profile, OnVirtualTimeNoDeadlineIsJudged) {
  Deadlines d = stalled_thread();
  d.threads[0].misses = 0;
  d.threads[0].worst.clear();
  const Profile lockstep = profile_of(d, {});
  EXPECT_TRUE(lockstep.virtual_time());
  for (const std::string& said : {to_text(lockstep), to_html(lockstep, "a", {})}) {
    EXPECT_NE(said.find("deadlines have no meaning"), std::string::npos) << said;
    EXPECT_EQ(said.find("No deadline was missed"), std::string::npos) << said;
  }
  d.period_jitter = {d.threads[0]};
  const Profile paced = profile_of(d, {});
  EXPECT_FALSE(paced.virtual_time());
  EXPECT_NE(to_text(paced).find("No deadline was missed"), std::string::npos);
}

// A sample passes two threads; the second one is late for it, and works for another one.
TEST(TraceTicks, ASampleHasTheSpansThatItsMarksAreIn) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "trace.json";
  std::ofstream(file) << R"({"traceEvents":[
    {"name":"thread_name","ph":"M","tid":1,"args":{"name":"camera"}},
    {"name":"release","ph":"X","tid":1,"ts":10.0,"dur":5.0},
    {"name":"camera","ph":"s","tid":1,"ts":11.0,"id":"0x1","args":{"sequence":7}},
    {"name":"thread_name","ph":"M","tid":2,"args":{"name":"stereo"}},
    {"name":"tick","ph":"X","tid":2,"ts":20.0,"dur":50.0},
    {"name":"part","ph":"X","tid":2,"ts":30.0,"dur":10.0},
    {"name":"camera","ph":"f","tid":2,"ts":31.0,"id":"0x1","args":{"sequence":7}},
    {"name":"missed deadline","ph":"i","tid":2,"ts":71.0},
    {"name":"tick","ph":"X","tid":2,"ts":80.0,"dur":1.0}],"otherData":{}})";
  const json all = read_trace_ticks(file);
  EXPECT_EQ(all["flows"],
            json::parse(R"([{"source":"camera","sequence":7,"spans":[[0,0],[1,1]]}])"));
  EXPECT_EQ(all["threads"][1]["start"], json::parse("[200, 100, 500]"));
  EXPECT_EQ(all["threads"][1]["missed"], json::parse("[0]")) << "the tick, not what is in it";
  EXPECT_TRUE(all["until"].is_null());
  const json first = read_trace_ticks(file, 2);
  EXPECT_EQ(first["until"], 300);
  EXPECT_TRUE(first["flows"].empty()) << "it is not there in full";
  std::ofstream(file) << "{}";
  EXPECT_THROW(read_trace_ticks(file), std::runtime_error);
}

class ProfileCommand : public CommandTest {
 protected:
  static ProcessResult profile_command(Words words) {
    words.insert(words.begin(), "profile");
    return run_maploop(words);
  }
};

TEST_F(ProfileCommand, AgreesWithWhatTheReplaySaidAtItsEnd) {
  MAPLOOP_REQUIRE_DRIVE();
  const json said = replay(drive_0013().string(),
                           {"--end", "5", "--fault", "slow@fusion:2:0.3,by=0.02", "--record",
                            file("run.lcmlog"), "--trace", file("trace.json")})["deadlines"];
  const ProcessResult result =
      profile_command({file("run.lcmlog"), "--json", file("profile.json"), "--html",
                       file("profile.html"), "--trace", file("trace.json")});
  ASSERT_EQ(result.status, 0) << result.error;
  const json profile = read_json(file("profile.json"));
  for (const char* kind : {"threads", "paths"}) {
    ASSERT_EQ(profile[kind].size(), said[kind].size());
    for (const auto& [name, s] : said[kind].items()) {
      const json& p = profile[kind][name];
      for (const char* figure : {"count", "misses"}) EXPECT_EQ(p[figure], s[figure]) << name;
      for (const char* figure : {"p50_ms", "p99_ms", "max_ms", "deadline_ms"}) {
        EXPECT_NEAR(p[figure].get<double>(), s[figure].get<double>(), 1e-3) << name << figure;
      }
    }
  }
  // The injected fault: 30 ticks of 20 ms, each due every 10 ms.
  const json& fusion = profile["threads"]["fusion"];
  EXPECT_GE(fusion["misses"], 30);
  EXPECT_GT(fusion["omitted"], 0) << "the stalls of the data clock hid ticks";
  EXPECT_GE(fusion["corrected_p99_ms"], fusion["p99_ms"]);
  EXPECT_EQ(profile["worst"].size(), 10u);
  double sum = 0.0;
  for (const auto& [name, thread] : profile["cpu"].items()) {
    EXPECT_GT(thread["cpu_s"], 0.0) << name;
    sum += thread["cpu_s"].get<double>();
  }
  EXPECT_LE(sum, profile["cpu_s"].get<double>() * 1.01);
  for (const char* said_so : {"fusion", "camera stamp -> state", "woken late", "publisher",
                              "Wake-up", "Execution", "Period jitter", "Worst misses"}) {
    EXPECT_NE(result.out.find(said_so), std::string::npos) << said_so;
  }

  const std::string html = read_file(file("profile.html"));
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = html.find("<figure data-plot", at)) != std::string::npos; ++at) {
    ++pictures;
  }
  EXPECT_GE(pictures, 11u) << "distributions";
  EXPECT_NE(html.find("class=\"bar\""), std::string::npos) << "the misses";
  EXPECT_NE(html.find("ticks-data"), std::string::npos) << "the trace";

  const ProcessResult both = profile_command(
      {file("run.lcmlog"), "--compare", file("run.lcmlog"), "--html", file("both.html")});
  EXPECT_EQ(both.status, 0) << both.error;
  EXPECT_NE(both.out.find("fusion"), std::string::npos);
  EXPECT_NE(read_file(file("both.html")).find("<table"), std::string::npos);

  const ProcessResult analysis =
      run_maploop({"analyze", file("run.lcmlog"), "--cpus", "2", "--json", file("analysis.json")});
  EXPECT_EQ(analysis.status, 0) << analysis.error;
  EXPECT_NE(analysis.out.find("fusion: 2 ms cannot be promised"), std::string::npos)
      << "a fault made it slow: " << analysis.out;
  const json threads = read_json(file("analysis.json"))["threads"];
  // A null says that no bound exists: other work on this machine made the measured steps longer.
  const json& bound = threads["fusion"]["response_bound_ms"];
  EXPECT_TRUE(bound.is_null() || bound > 20.0) << bound;
  EXPECT_TRUE(threads.contains("stereo") && threads.contains("camera")) << threads;
}

TEST_F(ProfileCommand, SaysWhatIsWrong) {
  const std::string missing = file("none.lcmlog");
  ProcessResult result = profile_command({missing});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("none.lcmlog"));
  EXPECT_NE(profile_command({}).status, 0);
  EXPECT_NE(profile_command({missing, "--live"}).status, 0);
  EXPECT_NE(profile_command({missing, "--seconds", "3"}).status, 0);
  result = profile_command({"--live", "--seconds", "1", "--lcm-url", "nonsense://"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("nonsense://"));
}

TEST_F(ProfileCommand, ALogWithoutOurChannelsIsNamed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ProcessResult result =
      profile_command({(real_data() / "lcm/vlp16_and_wheels.lcm").string()});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("has no DEADLINES"));
}

}  // namespace
}  // namespace maploop::profile
