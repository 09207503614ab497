// Tests what the dashboard relays to browsers, without HTTP.
#include <gtest/gtest.h>

#include <limits>
#include <maploop_lcm/replay_control_t.hpp>
#include <maploop_lcm/run_t.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "tools/dashboard/live_channels.h"
#include "tools/dashboard/relay.h"
#include "tools/log/message_json.h"

namespace maploop::dashboard {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

using schema::encoded;

const std::string a_run = "0000000a";

json as_json(const std::vector<std::uint8_t>& bytes) {
  return json::parse(lcm_log::to_json(try_decode(schema::own_schema(), bytes).value()));
}

NavState state_at(int seconds) {
  NavState s;
  s.stamp = from_nanoseconds(std::int64_t{seconds} * 1'000'000'000);
  s.status = NavStatus::aided;
  s.origin = {0.85, 0.15, 100.0};
  s.position_enu = {1.0 * seconds, -2.0 * seconds, 0.0};
  return s;
}

TEST(MessageJson, NumbersStructsAndArraysHaveTheirNames) {
  NavState s = state_at(2);
  s.covariance(0, 8) = 0.5;
  s.velocity_enu.x() = std::numeric_limits<double>::quiet_NaN();
  const json j = as_json(encoded(to_lcm(s)));
  EXPECT_EQ(j["header"]["stamp_ns"], 2'000'000'000);
  EXPECT_EQ(j["position_enu"], json::parse("[2.0, -4.0, 0.0]"));
  EXPECT_EQ(j["covariance"].size(), 9u);
  EXPECT_EQ(j["covariance"][0][8], 0.5);
  EXPECT_TRUE(j["velocity_enu"][0].is_null());
}

TEST(MessageJson, ListsOfStructsAndTextsMayBeEmpty) {
  Health h;
  EXPECT_EQ(as_json(encoded(to_lcm(h)))["degraded"], json::array());
  h.degraded = {"one", "t\xffwo"};
  h.rings = {{"a -> b", 4, 3, 1, 0, 8}};
  const json j = as_json(encoded(to_lcm(h)));
  EXPECT_EQ(j["degraded"][0], "one");
  EXPECT_EQ(j["degraded"][1], "t\xEF\xBF\xBDwo");
  EXPECT_EQ(j["rings"][0]["lost"], 1);
}

TEST(MessageJson, HistogramsAreLeftOut) {
  Deadlines d;
  d.threads.resize(1);
  d.threads[0].name = "fusion";
  const json thread = as_json(encoded(to_lcm(d)))["threads"][0];
  EXPECT_EQ(thread["name"], "fusion");
  EXPECT_FALSE(thread.contains("histogram"));
}

TEST(LiveChannels, ASlowBrowserGetsTheNewestOfEach) {
  LiveChannels channels;
  std::uint64_t seen = 0;
  EXPECT_TRUE(channels.newer(a_run, seen, milliseconds(0)).empty());
  channels.put(a_run, "A", "1");
  channels.put(a_run, "B", "2");
  channels.put(a_run, "A", "3");
  const auto first = channels.newer(a_run, seen, milliseconds(0));
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].json, "3");
  channels.put(a_run, "B", "4");
  const auto second = channels.newer(a_run, seen, milliseconds(0));
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].channel, "B");
  std::uint64_t later = 0;
  EXPECT_EQ(channels.newer(a_run, later, milliseconds(0)).size(), 2u) << "who comes later sees all";
}

TEST(LiveChannels, AMessageIsForTheBrowsersOfItsRunAlone) {
  LiveChannels channels;
  channels.put(a_run, "A", "1");
  channels.put("0000000b", "A", "2");
  channels.put(LiveChannels::all_runs, "RUNS", "3");
  std::uint64_t seen = 0, later = 0;
  const auto messages = channels.newer("0000000b", seen, milliseconds(0));
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].channel, "RUNS");
  EXPECT_EQ(messages[1].json, "2");
  channels.forget("0000000b");
  EXPECT_EQ(channels.newer("0000000b", later, milliseconds(0)).size(), 1u);
}

TEST(LiveChannels, EachOfSeveralBrowsersSeesTheLastMessage) {
  LiveChannels channels;
  std::vector<std::string> last(3);
  std::vector<std::thread> browsers;
  browsers.reserve(last.size());
  for (std::string& mine : last) {
    browsers.emplace_back([&channels, &mine] {
      std::uint64_t seen = 0;
      while (mine != "999") {
        for (const auto& m : channels.newer(a_run, seen, milliseconds(1000))) mine = m.json;
      }
    });
  }
  for (int i = 0; i < 1000; ++i) channels.put(a_run, "A", std::to_string(i));
  for (std::thread& browser : browsers) browser.join();
  EXPECT_EQ(last, std::vector<std::string>(3, "999"));
}

TEST(LiveChannels, ClosingEndsAWait) {
  LiveChannels channels;
  std::thread waits([&] {
    std::uint64_t seen = 0;
    EXPECT_TRUE(channels.newer(a_run, seen, std::chrono::hours(1)).empty());
  });
  channels.close();
  waits.join();
}

TEST(Relay, PassesOnTheNewestAndLeavesOutCommands) {
  LiveChannels channels;
  Relay relay(channels);
  relay.take("a", "NAV_STATE", encoded(to_lcm(state_at(1))), Duration(0));
  relay.take("a", "NAV_STATE", encoded(to_lcm(state_at(2))), Duration(0));
  relay.take("a", "REPLAY_CONTROL", encoded_command("0123abcd", "pause", 0.0), Duration(0));
  relay.take("a", "SOMEBODY", std::vector<std::uint8_t>{1, 2, 3}, Duration(0));
  std::uint64_t seen = 0;
  relay.pass_on(milliseconds(100));
  EXPECT_EQ(channels.newer("others", seen, milliseconds(0)).size(), 1u) << "it may yet announce";
  relay.pass_on(milliseconds(1600));
  const auto messages = channels.newer("others", seen, milliseconds(0));
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(json::parse(messages[0].json)[0]["id"], "others");
  EXPECT_EQ(json::parse(messages[1].json)["header"]["stamp_ns"], 2'000'000'000);
  EXPECT_EQ(relay.not_understood(), 1u);
  relay.pass_on(milliseconds(1700));
  EXPECT_TRUE(channels.newer("others", seen, milliseconds(0)).empty()) << "nothing new has come";
}

TEST(Relay, TheTrailForgetsWhatAReplayGoesBackOver) {
  LiveChannels channels;
  Relay relay(channels);
  ReferencePose truth;
  truth.position = state_at(0).origin;
  relay.take("a", "TRUTH", encoded(to_lcm(truth)), Duration(0));  // ignored before the first state
  for (int t = 1; t <= 10; ++t)
    relay.take("a", "NAV_STATE", encoded(to_lcm(state_at(t))), Duration(0));
  truth.stamp = state_at(10).stamp;
  relay.take("a", "TRUTH", encoded(to_lcm(truth)), Duration(0));
  relay.pass_on(milliseconds(1600));
  json trail = json::parse(relay.trail("others"));
  EXPECT_EQ(trail["fused"].size(), 10u);
  ASSERT_EQ(trail["truth"].size(), 1u);
  EXPECT_NEAR(trail["truth"][0][1].get<double>(), 0.0, 0.01);
  EXPECT_EQ(trail["origin"][0].get<double>(), 0.85);
  relay.take("a", "NAV_STATE", encoded(to_lcm(state_at(4))), Duration(0));
  trail = json::parse(relay.trail("others"));
  ASSERT_EQ(trail["fused"].size(), 4u);
  EXPECT_EQ(trail["fused"][3], json::parse("[4.0, 4.0, -8.0, 0.0]"));
}

TEST(Relay, KeepsTheRunsAndTheirPlayersApart) {
  LiveChannels channels;
  Relay relay(channels);
  const auto say = [&](const char* id, Duration now) {
    maploop_lcm::run_t run{};
    run.id = id;
    run.what = std::string("replay of \"") + id + '"';
    relay.take(id, "RUN", encoded(run), now);
  };
  const auto state = [&](const char* id, double speed, Duration now) {
    maploop_lcm::replay_control_t state{};
    state.kind = maploop_lcm::replay_control_t::STATE;
    state.run = id;
    state.speed = speed;
    relay.take("a", "REPLAY_CONTROL", encoded(state), now);
  };
  std::uint64_t seen = 0;
  const auto runs = [&](Duration now) {
    relay.pass_on(now);
    const auto messages = channels.newer(a_run, seen, milliseconds(0));
    return messages.empty() ? json() : json::parse(messages.back().json);
  };
  say("0000000a", milliseconds(0));
  say("0000000b", milliseconds(0));
  state("0000000a", 1.0, milliseconds(10));
  state("0000000b", 2.0, milliseconds(10));
  state("0000000c", 3.0, milliseconds(10));  // of a run that has not announced itself
  json all = runs(milliseconds(20));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["what"], "replay of \"0000000a\"");
  EXPECT_EQ(all[0]["player"]["speed"], 1.0);
  EXPECT_EQ(all[1]["player"]["speed"], 2.0);
  EXPECT_TRUE(runs(milliseconds(30)).is_null()) << "nothing has changed";
  say("0000000b", milliseconds(2000));
  all = runs(milliseconds(4000));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["ended"], true) << "it is silent";
  EXPECT_EQ(all[1]["ended"], false);
  say("0000000d", milliseconds(4100));
  all = runs(milliseconds(4200));
  ASSERT_EQ(all.size(), 2u) << "the next run takes its place";
  EXPECT_EQ(all[0]["id"], "0000000b");
  EXPECT_EQ(all[1]["id"], "0000000d");
}

TEST(Relay, MessagesAreOfTheRunThatTheirSenderAnnounces) {
  LiveChannels channels;
  Relay relay(channels);
  for (const int second : {1, 2}) {
    const std::string sender = "10.0.0." + std::to_string(second);
    relay.take(sender, "NAV_STATE", encoded(to_lcm(state_at(second))), milliseconds(0));
    maploop_lcm::run_t run{};
    run.id = "0000000" + std::to_string(second);
    relay.take(sender, "RUN", encoded(run), milliseconds(10));
  }
  relay.pass_on(milliseconds(20));
  for (const int second : {1, 2}) {
    const std::string run = "0000000" + std::to_string(second);
    std::uint64_t seen = 0;
    const auto messages = channels.newer(run, seen, milliseconds(0));
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_EQ(json::parse(messages[1].json)["position_enu"][0], 1.0 * second);
    const json trail = json::parse(relay.trail(run));
    ASSERT_EQ(trail["fused"].size(), 1u);
    EXPECT_EQ(trail["fused"][0][1], 1.0 * second);
  }
  EXPECT_TRUE(json::parse(relay.trail("00000003"))["fused"].empty());
}

TEST(Relay, SaysHowARunEnded) {
  LiveChannels channels;
  Relay relay(channels);
  maploop_lcm::run_t run{};
  run.id = "0000000a";
  run.what = "replay of a drive";
  relay.take("a", "RUN", encoded(run), milliseconds(0));
  run.ended = 1;
  run.verdict = "One line.\nAnother.\n\xff";  // a byte that is not valid UTF-8
  relay.take("a", "RUN", encoded(run), milliseconds(10));
  relay.pass_on(milliseconds(10));
  std::uint64_t seen = 0;
  for (const LiveChannels::Message& m : channels.newer(a_run, seen, milliseconds(0))) {
    if (m.channel != "VERDICT") continue;
    EXPECT_EQ(json::parse(m.json)["what"], "replay of a drive");
    EXPECT_EQ(json::parse(m.json)["lines"], "One line.\nAnother.\n\xef\xbf\xbd");
    return;
  }
  FAIL() << "nothing on VERDICT";
}

TEST(Relay, CommandsHaveTheirNames) {
  const auto bytes = encoded_command("0123abcd", "seek", 6.5);
  maploop_lcm::replay_control_t command{};
  ASSERT_GT(command.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  EXPECT_EQ(int{command.kind}, int{maploop_lcm::replay_control_t::SEEK});
  EXPECT_EQ(command.value, 6.5);
  EXPECT_EQ(command.run, "0123abcd");
  EXPECT_TRUE(encoded_command("0123abcd", "explode", 0.0).empty());
}

}  // namespace
}  // namespace maploop::dashboard
