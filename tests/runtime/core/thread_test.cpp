#include "runtime/core/thread.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <thread>

namespace maploop::runtime {
namespace {

TEST(Thread, AnExceptionEndsTheThreadAloneAndIsKept) {
  bool at_end = false;
  Thread thread(
      "failing", {}, {}, [](const std::stop_token&) { throw std::runtime_error("cable pulled"); },
      [&] { at_end = true; });
  thread.join();
  EXPECT_EQ(thread.failure(), "cable pulled");
  EXPECT_TRUE(at_end);
  EXPECT_TRUE(thread.ended());
}

TEST(Thread, ItsProcessorTimeIsItsOwnAndStaysAfterItsEnd) {
  std::stop_source stop;
  Thread busy(
      "busy", {}, stop.get_token(),
      [](const std::stop_token& token) {
        while (!token.stop_requested()) {
        }
      },
      [] {});
  Thread idle(
      "idle", {}, stop.get_token(),
      [](const std::stop_token& token) {
        while (!token.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      },
      [] {});
  Duration seen{};
  while (seen < std::chrono::milliseconds(200)) {
    const Duration now = busy.cpu_time();
    EXPECT_GE(now, seen);
    seen = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(idle.cpu_time(), seen / 2);
  stop.request_stop();
  busy.join();
  EXPECT_GE(busy.cpu_time(), seen);
}

TEST(Thread, ProcessorTimeMayBeAskedWhileThreadsEnd) {
  for (int i = 0; i < 200; ++i) {
    Thread thread(
        "short", {}, {}, [](const std::stop_token&) {}, [] {});
    std::jthread joiner([&] { thread.join(); });
    while (!thread.ended()) EXPECT_GE(thread.cpu_time(), Duration{});
    EXPECT_GT(thread.cpu_time(), Duration{});
  }
}

TEST(Thread, StopReachesTheBody) {
  std::stop_source stop;
  Thread thread(
      "stopping", {}, stop.get_token(),
      [](const std::stop_token& token) {
        while (!token.stop_requested()) std::this_thread::yield();
      },
      [] {});
  stop.request_stop();
  thread.join();
  EXPECT_EQ(thread.failure(), "");
}

TEST(Thread, SaysWhatTheKernelGrantedOrWhyNot) {
  Thread thread(
      "fifo", Scheduling::fifo(10), {}, [](const std::stop_token&) {}, [] {});
  thread.join();
  const RealtimeSetting& setting = thread.settings().front();
  EXPECT_EQ(setting.name, "fifo: scheduling");
  EXPECT_EQ(setting.asked, "fifo 10");
  EXPECT_EQ(setting.verdict == Verdict::granted, setting.granted == "fifo 10");
  EXPECT_EQ(setting.verdict == Verdict::granted, setting.remedy.empty());
}

TEST(Thread, APriorityThatDoesNotExistIsRefusedNotFatal) {
  Thread thread(
      "bad", Scheduling::fifo(1000), {}, [](const std::stop_token&) {}, [] {});
  thread.join();
  EXPECT_EQ(thread.settings().front().verdict, Verdict::refused);
  EXPECT_EQ(thread.failure(), "");
}

}  // namespace
}  // namespace maploop::runtime
