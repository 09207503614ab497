// These tests decode what live sensors send, and check their clocks.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "sensors/clock/clock_offset.h"
#include "sensors/gnss/nmea_fixes.h"
#include "sensors/imu/ncom.h"
#include "sensors/imu/ncom_packet.h"
#include "sensors/live/line_splitter.h"

namespace maploop::sensors {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

const Time begin = parse_time("2026-03-01 10:00:00");

// Returns the largest error of the mapping after `from` s, with a clock that runs `ppm` slow and
// delays of at least 1 ms, mostly 2 ms, sometimes 40 ms.
double worst_error(double ppm, double from) {
  ClockOffset clock;
  std::mt19937 random(7);
  std::exponential_distribution<double> delay(1.0 / 1e-3);
  double worst = 0.0;
  for (int i = 0; i < 12'000; ++i) {
    const double t = 0.01 * i;
    const Duration device = from_seconds(1e4 + t * (1.0 - 1e-6 * ppm));
    const Time sent = begin + from_seconds(t);
    const double late = 1e-3 + delay(random) + (random() % 100 == 0 ? 0.04 : 0.0);
    EXPECT_FALSE(clock.add(device, sent + from_seconds(late)));
    const double error = to_seconds(clock.to_host(device) - sent) - 1e-3;
    if (t > from) worst = std::max(worst, std::fabs(error));
  }
  EXPECT_NEAR(clock.drift(), 1e-6 * ppm, 3e-6);
  return worst;
}

TEST(ClockOffset, FindsOffsetAndDriftUnderTheDelays) {
  EXPECT_LT(worst_error(0.0, 40.0), 100e-6);
  EXPECT_LT(worst_error(50.0, 40.0), 150e-6);
  EXPECT_LT(worst_error(-80.0, 40.0), 150e-6);
  EXPECT_LT(worst_error(50.0, 1.0), 600e-6);  // before the drift is estimated
}

TEST(ClockOffset, RestartsAfterAJumpAndNotAfterAHiccup) {
  ClockOffset clock;
  const auto add = [&](double device, double host) {
    return clock.add(from_seconds(device), begin + from_seconds(host));
  };
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(add(0.01 * i, 0.01 * i + 0.002));
  for (int i = 0; i < 80; ++i) EXPECT_FALSE(add(2.0 + 0.01 * i, 2.8));  // delayed, then all at once
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(add(2.8 + 0.01 * i, 2.802 + 0.01 * i));
  EXPECT_NEAR(to_seconds(clock.to_host(from_seconds(4.0)) - begin), 4.002, 1e-6);
  EXPECT_TRUE(add(100.0, 5.0));  // the sensor's clock was set ahead
  int jumps = 0;
  for (int i = 1; i < 300; ++i) jumps += add(50.0 + 0.01 * i, 5.0 + 0.01 * i);  // and back
  EXPECT_EQ(jumps, 1);
  EXPECT_NEAR(to_seconds(clock.to_host(from_seconds(52.0)) - begin), 7.0, 1e-6);
}

TEST(ClockOffset, AClockThatIsSetBackALittleIsWrongForSecondsOnly) {
  for (const double by : {0.1, 0.3, 0.45}) {
    for (const bool seen : {false, true}) {  // whether the messages' times go back with it
      ClockOffset clock;
      int jumps = 0;
      double wrong_until = 0.0;
      for (int i = 0; i < 6000; ++i) {
        const double host = 0.01 * i;
        const double device = host < 20.0 ? host : host - by;
        if (!seen && host >= 20.0 && host < 20.0 + by) continue;  // repeated times were left out
        const Time arrival = begin + from_seconds(host + 0.002);
        jumps += clock.add(from_seconds(device), arrival);
        const double error = to_seconds(clock.to_host(from_seconds(device)) - arrival);
        if (std::fabs(error) > 1e-3) wrong_until = host;
      }
      EXPECT_EQ(jumps, 1) << by;
      EXPECT_LT(wrong_until, seen ? 20.0 : 25.5) << by;
    }
  }
}

TEST(ClockOffset, ABusyConnectionIsNotAClockThatWasSetBack) {
  ClockOffset clock;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> late(0.0, 0.05);
  for (int i = 0; i < 6000; ++i) {
    const double host = 0.01 * i;
    const bool busy = host > 20.0 && host < 40.0;  // no message within 50 ms for seconds
    const double way = busy ? 0.06 + 0.02 * std::floor(host - 20.0) + late(random) : 0.0;
    EXPECT_FALSE(clock.add(from_seconds(host), begin + from_seconds(host + way))) << host;
    EXPECT_NEAR(to_seconds(clock.to_host(from_seconds(host)) - begin), host, 5e-3);
  }
}

TEST(Nmea, AcceptsOnlyCompleteSentences) {
  const auto good =
      parse_nmea("$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*05\r\n");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->talker, "GP");
  EXPECT_EQ(good->kind, "RMC");
  EXPECT_EQ(good->field(8), "230715");
  EXPECT_EQ(good->count, 12U);
  EXPECT_EQ(good->field(12), "");
  for (const char* text : {"", "$", "$GPRMC", "$*00", "$GPRMC,214106*", "$GPRMC,214106*zz",
                           "GPRMC,1*00", "$GPRMC,214106,A,3707.8178,N*00"}) {
    EXPECT_FALSE(parse_nmea(text)) << text;
  }
  EXPECT_EQ(nmea_time_of_day("235959.50"), std::chrono::hours(24) - milliseconds(500));
  EXPECT_EQ(nmea_time_of_day("120000."), std::chrono::hours(12));
  EXPECT_FALSE(nmea_time_of_day("245959"));
  EXPECT_FALSE(nmea_time_of_day("12000"));
  EXPECT_FALSE(nmea_time_of_day("120000x"));
  EXPECT_FALSE(nmea_time_of_day("120000.5e9"));
  EXPECT_EQ(nmea_date("290224"), parse_time("2024-02-29 00:00:00"));
  EXPECT_FALSE(nmea_date("290223"));
  EXPECT_NEAR(*nmea_angle("12139.2690", "W"), radians(-121.65448333), 1e-9);
  EXPECT_FALSE(nmea_angle("9000.1", "N"));
  EXPECT_FALSE(nmea_angle("4860.0", "N"));
  EXPECT_FALSE(nmea_angle("-4859.0", "N"));
  EXPECT_FALSE(nmea_angle("4859.0", "X"));
}

// The example of the standard's own documentation.
TEST(Nmea, ChecksumIsTheExclusiveOrOfTheBody) {
  EXPECT_EQ(nmea_sentence("GPGLL,5300.97914,N,00259.98174,E,125926,A"),
            "$GPGLL,5300.97914,N,00259.98174,E,125926,A*28\r\n");
}

TEST(Nmea, WritesAnglesThatNeverHave60Minutes) {
  EXPECT_EQ(nmea_angle_fields(radians(48.9825), 2, "NS"), "4858.9500000,N");
  EXPECT_EQ(nmea_angle_fields(radians(-8.5), 3, "EW"), "00830.0000000,W");
  EXPECT_EQ(nmea_angle_fields(radians(8.9999999999), 3, "EW"), "00900.0000000,E");
}

TEST(NmeaFixes, NoFixIsMisstampedAroundALeapSecond) {
  NmeaFixes fixes;
  GnssFix fix;
  const auto add = [&](int at, const std::string& time, const std::string& date) {
    const Time arrival = begin + seconds(at) + milliseconds(50);
    fixes.add(nmea_sentence("GNGGA," + time + ",4858.95,N,00823.42,E,4,12,0.80,115.2,M,47.9,M,,"),
              arrival, fix);
    const bool whole = fixes.add(
        nmea_sentence("GNRMC," + time + ",A,4858.95,N,00823.42,E,19.4,270.0," + date + ",,,A"),
        arrival, fix);
    EXPECT_TRUE(whole) << time;
    EXPECT_NEAR(to_seconds(fix.stamp - begin), at, 1e-6) << time;
  };
  for (int i = 50; i <= 60; ++i) add(i, "2359" + std::to_string(i) + ".00", "311226");
  for (int i = 0; i < 9; ++i) add(61 + i, "00000" + std::to_string(i) + ".00", "010127");
  EXPECT_EQ(fixes.clock().state({}).jumps, 1U);
  EXPECT_EQ(fixes.counts().repeated, 0U);
}

TEST(NmeaFixes, JoinsTheSentencesOfAnEpoch) {
  NmeaFixes fixes;
  GnssFix fix;
  const auto add = [&](const std::string& body) {
    const Time arrival = begin + seconds(std::stoi(body.substr(10, 2)));
    return fixes.add(nmea_sentence(body), arrival, fix);
  };
  const std::string gga = ",4858.95,N,00823.42,E,4,12,0.80,115.2,M,47.9,M,,";
  const std::string rmc = ",A,4858.95,N,00823.42,E,19.438,270.0,010326,,,A";
  EXPECT_FALSE(add("GNGST,100000.00,,,,,0.02,0.01,0.03"));
  EXPECT_FALSE(add("GNRMC,100000.00" + rmc));
  EXPECT_TRUE(add("GNGGA,100000.00" + gga));
  EXPECT_NEAR(std::sqrt(fix.position_covariance(0, 0)), 0.01, 1e-12);  // east
  EXPECT_NEAR(std::sqrt(fix.position_covariance(1, 1)), 0.02, 1e-12);
  EXPECT_NEAR(fix.velocity_enu.x(), -10.0, 1e-3);
  EXPECT_EQ(fix.sequence, 0U);
  // A sentence pair of different epochs gives no fix. Then follows an epoch without its own GST.
  EXPECT_FALSE(add("GNRMC,100001.00" + rmc));
  EXPECT_FALSE(add("GNGGA,100002.00" + gga));
  EXPECT_TRUE(add("GNRMC,100002.00" + rmc));
  EXPECT_NEAR(std::sqrt(fix.position_covariance(0, 0)), 0.03 * 0.8, 1e-12);
  // These have no fix, repeat an epoch, or are dead reckoning.
  EXPECT_FALSE(add("GNGGA,100003.00,,,,,0,00,99.9,,,,,,"));
  EXPECT_FALSE(add("GNRMC,100003.00,V,,,,,,,010326,,,N"));
  EXPECT_FALSE(add("GNGGA,100002.00" + gga));
  EXPECT_FALSE(add("GNRMC,100002.00" + rmc));
  EXPECT_FALSE(add("GNGGA,100004.00,4858.95,N,00823.42,E,6,12,0.80,115.2,M,47.9,M,,"));
  EXPECT_FALSE(add("GNRMC,100004.00" + rmc));
  EXPECT_EQ(fixes.counts().fixes, 2U);
  EXPECT_EQ(fixes.counts().repeated, 1U);
  EXPECT_EQ(fixes.counts().no_fix, 2U);
}

TEST(Ncom, RefusesInvalidPacketsWithTheReason) {
  NcomFault fault{};
  const InertialValues values{-3.0, 2.0, -0.5, true, 9.75, 0.25, -0.125};
  const NcomBytes good = ncom_packet(59'999, values);
  const auto sample = parse_ncom(good, fault);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->minute_ms, 59'999);
  EXPECT_EQ(sample->values, values);
  const auto fault_of = [](const NcomBytes& bytes, std::size_t size = ncom_size) {
    NcomFault found{};
    EXPECT_FALSE(parse_ncom(std::span(bytes).first(size), found));
    return found;
  };
  EXPECT_EQ(fault_of(good, 71), NcomFault::wrong_size);
  EXPECT_EQ(fault_of(ncom_packet(60'000, {})), NcomFault::out_of_range);
  for (const InertialValues& large : {InertialValues{150.0},
                                      {0.0, -150.0},
                                      {0.0, 0.0, 11.0},
                                      {0.0, 0.0, 0.0, true, 150.0},
                                      {0.0, 0.0, 0.0, true, 9.8, 11.0},
                                      {0.0, 0.0, 0.0, true, 9.8, 0.0, -11.0}})
    EXPECT_EQ(fault_of(ncom_packet(0, large)), NcomFault::out_of_range);
  for (std::size_t i = 0; i < ncom_size; ++i) {
    NcomBytes bad = good;
    bad[i] ^= 0x10;
    EXPECT_EQ(fault_of(bad), i == 0 ? NcomFault::no_sync : NcomFault::wrong_checksum) << i;
  }
}

TEST(LineSplitter, DropsWhatIsTooLong) {
  LineSplitter lines;
  const std::string text = "one\r\n" + std::string(300, 'x') + "\ntwo\n\nthr";
  std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()),
                                      text.size());
  std::vector<std::string> found;
  for (std::string_view line; lines.next(bytes, line);) found.emplace_back(line);
  EXPECT_EQ(found, (std::vector<std::string>{"one\r", "two"}));
  EXPECT_EQ(lines.dropped(), 1U);
}

}  // namespace
}  // namespace maploop::sensors
