#include "runtime/core/realtime_scheduling.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "runtime/core/realtime_text.h"
#include "runtime/core/thread.h"
#include "tests/runtime/core/realtime_child.h"

namespace maploop::runtime {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::Not;

Scheduling with_policy(SchedulingPolicy policy) {
  Scheduling scheduling;
  scheduling.policy = policy;
  return scheduling;
}

Scheduling rr(int priority) {
  Scheduling scheduling = with_policy(SchedulingPolicy::rr);
  scheduling.priority = priority;
  return scheduling;
}

Scheduling nice(int value) {
  Scheduling scheduling = with_policy(SchedulingPolicy::other);
  scheduling.nice = value;
  return scheduling;
}

Scheduling deadline(Duration runtime, Duration deadline, Duration period) {
  Scheduling scheduling = with_policy(SchedulingPolicy::deadline);
  scheduling.runtime = runtime;
  scheduling.deadline = deadline;
  scheduling.period = period;
  return scheduling;
}

// Applies the scheduling to a separate thread, so that no other is changed.
std::vector<RealtimeSetting> applied(const Scheduling& scheduling) {
  Thread thread(
      "thread", scheduling, {}, [](const std::stop_token&) {}, [] {});
  thread.join();
  return thread.settings();
}

// Returns "verdict|asked|granted|reason|remedy" of the first item.
std::string first_item(const Scheduling& scheduling) {
  const RealtimeSetting s = applied(scheduling).at(0);
  return std::string(to_string(s.verdict)) + '|' + s.asked + '|' + s.granted + '|' + s.reason +
         '|' + s.remedy;
}

TEST(RealtimeScheduling, NothingAskedNothingChanged) {
  const auto settings = applied({});
  ASSERT_EQ(settings.size(), 1u);
  EXPECT_EQ(settings[0].name, "thread: scheduling");
  EXPECT_EQ(settings[0].asked, "as inherited");
  EXPECT_EQ(settings[0].granted, read_scheduling().policy);
  EXPECT_EQ(settings[0].verdict, Verdict::granted);
}

TEST(RealtimeScheduling, AsRootEveryPolicyIsGrantedAndReadBack) {
  MAPLOOP_REQUIRE_ROOT();
  if (!read_privileges().sys_nice) GTEST_SKIP() << "SKIPPED, NOT TESTED: root without CAP_SYS_NICE";
  EXPECT_EQ(first_item(Scheduling::fifo(50)), "granted|fifo 50|fifo 50||");
  EXPECT_EQ(first_item(rr(3)), "granted|rr 3|rr 3||");
  EXPECT_EQ(first_item(nice(-5)), "granted|other nice -5|other nice -5||");
  EXPECT_EQ(first_item(nice(0)), "granted|other|other||");
}

TEST(RealtimeScheduling, TheKernelItselfSaysFifo) {
  MAPLOOP_REQUIRE_ROOT();
  int policy = -1;
  sched_param parameters{};
  Thread thread(
      "thread", Scheduling::fifo(42), {},
      [&](const std::stop_token&) {
        policy = sched_getscheduler(0);
        sched_getparam(0, &parameters);
      },
      [] {});
  thread.join();
  if (thread.settings().front().granted != "fifo 42")
    GTEST_SKIP() << "SKIPPED, NOT TESTED: refused";
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(parameters.sched_priority, 42);
}

// All of deadline scheduling is in one test, because its last part leaves nothing for other tests
// that run meanwhile.
TEST(RealtimeScheduling, DeadlineIsGrantedMayStartThreadsAndIsRefusedWhenTheCpusAreFull) {
  MAPLOOP_REQUIRE_ROOT();
  if (!read_privileges().sys_nice) GTEST_SKIP() << "SKIPPED, NOT TESTED: root without CAP_SYS_NICE";
  EXPECT_EQ(first_item(deadline(microseconds(500), milliseconds(2), milliseconds(10))),
            "granted|deadline 0.5/2/10 ms|deadline 0.5/2/10 ms||");

  std::string inner = "not started";
  Thread outer(
      "outer", deadline(milliseconds(1), milliseconds(10), milliseconds(10)), {},
      [&](const std::stop_token&) { inner = first_item({}); }, [] {});
  outer.join();
  EXPECT_EQ(outer.failure(), "");
  EXPECT_EQ(inner.substr(0, 8), "granted|");

  // Many threads request a whole CPU each: more than any machine can promise.
  std::string last;
  const std::function<void(int)> nested = [&](int left) {
    Thread thread(
        "thread", deadline(milliseconds(94), milliseconds(100), milliseconds(100)), {},
        [&](const std::stop_token&) {
          if (left > 0) nested(left - 1);
        },
        [] {});
    thread.join();
    const RealtimeSetting setting = thread.settings().at(0);
    if (setting.verdict == Verdict::refused) last = setting.reason;
  };
  const auto cpus = static_cast<int>(sysconf(_SC_NPROCESSORS_CONF));
  if (cpus > 64) GTEST_SKIP() << "SKIPPED, NOT TESTED: too many CPUs to fill";
  nested(cpus + 1);
  EXPECT_EQ(last, "the deadline threads together would take more than the CPUs have to give");
}

TEST(RealtimeScheduling, AnOrdinaryUserIsRefusedAndToldWhy) {
  const ChildLimits limits;
  MAPLOOP_REQUIRE_ORDINARY_USER(limits);
  const std::string inherited = read_scheduling().policy;
  EXPECT_EQ(as_ordinary_user(limits, [] { return first_item(Scheduling::fifo(60)); }),
            "refused|fifo 60|" + inherited +
                "|no CAP_SYS_NICE, and RLIMIT_RTPRIO is 0|add '@GROUP - rtprio 99' "
                "to a file in /etc/security/limits.d and log in again; or run as root");
  EXPECT_EQ(
      as_ordinary_user(limits, [] { return first_item(nice(-20)); }),
      "refused|other nice -20|" + inherited +
          "|no CAP_SYS_NICE, and RLIMIT_NICE allows nice values from "
          "19|add '@GROUP - nice -20' to a file in /etc/security/limits.d and log in again; or "
          "run as root");
  EXPECT_EQ(
      as_ordinary_user(
          limits,
          [] { return first_item(deadline(milliseconds(1), milliseconds(5), milliseconds(10))); }),
      "refused|deadline 1/5/10 ms|" + inherited +
          "|deadline scheduling needs CAP_SYS_NICE|run as root, "
          "or give the program the capability: setcap cap_sys_nice+ep PROGRAM");
}

TEST(RealtimeScheduling, AnOrdinaryUserWithALimitIsGrantedUpToIt) {
  const ChildLimits limits{.rtprio = 50, .nice = 25};
  MAPLOOP_REQUIRE_ORDINARY_USER(limits);
  EXPECT_EQ(as_ordinary_user(limits, [] { return first_item(Scheduling::fifo(50)); }),
            "granted|fifo 50|fifo 50||");
  EXPECT_EQ(as_ordinary_user(limits, [] { return first_item(nice(-5)); }),
            "granted|other nice -5|other nice -5||");
  const std::string refused = "refused|fifo 51|" + read_scheduling().policy +
                              "|no CAP_SYS_NICE, and RLIMIT_RTPRIO is 50|add";
  EXPECT_EQ(as_ordinary_user(limits, [] { return first_item(Scheduling::fifo(51)); })
                .substr(0, refused.size()),
            refused);
}

TEST(RealtimeScheduling, AnInheritedNiceValueIsKept) {
  EXPECT_EQ(in_child([] {
              if (setpriority(PRIO_PROCESS, 0, 19) != 0) return std::string("nice refused");
              return first_item(with_policy(SchedulingPolicy::other)) + "\n" + first_item({});
            }),
            "granted|other|other nice 19||\ngranted|as inherited|other nice 19||");
}

TEST(RealtimeScheduling, ValuesOutOfRangeAreRefusedBeforeTheKernelSeesThem) {
  const auto refused = [](const Scheduling& scheduling, const std::string& reason) {
    const RealtimeSetting setting = applied(scheduling).at(0);
    EXPECT_EQ(setting.verdict, Verdict::refused) << setting.asked;
    EXPECT_EQ(setting.reason, reason);
    EXPECT_EQ(setting.granted, read_scheduling().policy);
    EXPECT_FALSE(setting.remedy.empty());
  };
  refused(Scheduling::fifo(0), "priorities are 1 to 99");
  refused(Scheduling::fifo(-1), "priorities are 1 to 99");
  refused(rr(100), "priorities are 1 to 99");
  refused(nice(20), "nice values are -20 to 19");
  refused(nice(-21), "nice values are -20 to 19");
  const std::string order = "1.024 us <= runtime <= deadline <= period must hold";
  refused(deadline(Duration(1000), milliseconds(1), milliseconds(1)), order);
  refused(deadline(milliseconds(2), milliseconds(1), milliseconds(3)), order);
  refused(deadline(milliseconds(1), milliseconds(3), milliseconds(2)), order);
  refused(deadline(milliseconds(-1), milliseconds(3), milliseconds(4)), order);
}

TEST(RealtimeScheduling, AThreadIsBoundToTheCpusAskedFor) {
  const int last = read_scheduling().cpus.back();
  Scheduling scheduling;
  scheduling.cpus = {last, last};
  const auto settings = applied(scheduling);
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[1].name, "thread: CPUs");
  EXPECT_EQ(settings[1].granted, std::to_string(last));
  EXPECT_EQ(settings[1].verdict, Verdict::granted);
}

TEST(RealtimeScheduling, CpusThatDoNotExistAreRefused) {
  const std::vector<int> all = read_scheduling().cpus;
  for (const int wrong : {-1, 1023, 100'000}) {
    Scheduling scheduling;
    scheduling.cpus = {wrong};
    const RealtimeSetting setting = applied(scheduling).at(1);
    EXPECT_EQ(setting.verdict, Verdict::refused) << wrong;
    EXPECT_EQ(setting.granted, to_cpu_list(all)) << "it may run where it could before";
    EXPECT_THAT(setting.remedy, HasSubstr("CPUs online"));
  }
}

TEST(RealtimeScheduling, OfSeveralCpusThoseThatExistAreGrantedAndSaid) {
  const int first = read_scheduling().cpus.front();
  Scheduling scheduling;
  scheduling.cpus = {first, 1023};
  const RealtimeSetting setting = applied(scheduling).at(1);
  EXPECT_EQ(setting.verdict, Verdict::refused);
  EXPECT_EQ(setting.asked, std::to_string(first) + ",1023");
  EXPECT_EQ(setting.granted, std::to_string(first));
}

TEST(RealtimeScheduling, TimerSlackIsSetAndReadBack) {
  Scheduling scheduling;
  scheduling.timer_slack = microseconds(1);
  const RealtimeSetting setting = applied(scheduling).at(1);
  EXPECT_EQ(setting.name, "thread: timer slack");
  EXPECT_EQ(setting.granted, "1000 ns");
  EXPECT_EQ(setting.verdict, Verdict::granted);
  scheduling.timer_slack = Duration(-5);
  EXPECT_EQ(applied(scheduling).at(1).verdict, Verdict::refused);
}

TEST(RealtimeScheduling, AThreadSaysWhatItWasRefused) {
  const ChildLimits limits;
  MAPLOOP_REQUIRE_ORDINARY_USER(limits);
  const std::string cpu = std::to_string(read_scheduling().cpus.front());
  EXPECT_EQ(as_ordinary_user(limits,
                             [] {
                               Scheduling scheduling = Scheduling::fifo(60);
                               scheduling.cpus = {read_scheduling().cpus.front()};
                               Thread thread(
                                   "thread", scheduling, {}, [](const std::stop_token&) {}, [] {});
                               thread.join();
                               std::string text;
                               for (const RealtimeSetting& s : thread.settings()) {
                                 text += s.name + ' ' + s.granted + '/' + s.asked + ' ' +
                                         std::string(to_string(s.verdict)) + "; ";
                               }
                               return text;
                             }),
            "thread: scheduling " + read_scheduling().policy + "/fifo 60 refused; thread: CPUs " +
                cpu + '/' + cpu + " granted; ");
}

// This machine cannot be made to return these errors.
TEST(RealtimeScheduling, RefusalsOfOtherMachinesAreExplained) {
  Privileges root;
  root.sys_nice = true;
  const auto why = [](const Scheduling& s, int error, const Privileges& p) {
    const auto [reason, remedy] = explain_refusal(s, error, p);
    EXPECT_FALSE(remedy.empty());
    EXPECT_THAT(remedy, Not(HasSubstr("\n")));
    return reason;
  };
  EXPECT_EQ(why(Scheduling::fifo(1), EPERM, root),
            "CAP_SYS_NICE is there, but this control group gives real-time threads no time");
  const Scheduling guaranteed = deadline(milliseconds(1), milliseconds(2), milliseconds(3));
  EXPECT_EQ(why(guaranteed, EPERM, root),
            "CAP_SYS_NICE is there, but a deadline thread must be allowed on all CPUs");
  EXPECT_EQ(why(guaranteed, EBUSY, root),
            "the deadline threads together would take more than the CPUs have to give");
  EXPECT_EQ(why(Scheduling::fifo(1), ENOSYS, root), "Function not implemented");
  EXPECT_EQ(why(Scheduling::fifo(1), 0, root), "the kernel accepted it and says otherwise");
  Privileges desktop;
  desktop.nice = 31;
  EXPECT_EQ(why(nice(-15), EPERM, desktop),
            "no CAP_SYS_NICE, and RLIMIT_NICE allows nice values from -11");
}

TEST(RealtimeScheduling, ALimitOnRealtimeCpuTimeIsSaid) {
  EXPECT_EQ(assess_time_limit({}).verdict, Verdict::granted);
  Privileges desktop;
  desktop.realtime_time = 200'000;
  const RealtimeSetting setting = assess_time_limit(desktop);
  EXPECT_EQ(setting.verdict, Verdict::limiting);
  EXPECT_EQ(setting.granted, "200000 us");
}

}  // namespace
}  // namespace maploop::runtime
