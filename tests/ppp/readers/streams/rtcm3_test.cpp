// Tests RTCM 3 with RTKLIB's encoding of a real recording, and with made and damaged messages.
#include "ppp/readers/streams/rtcm3.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "ppp/gnss_files.h"
#include "ppp/readers/files/lines.h"
#include "tests/ppp/readers/streams/rtklib_encoder.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

using maploop::testing::BitWriter, maploop::testing::gps_week_frame, maploop::testing::rtcm_frame;

struct Made {
  int number = 1074;
  std::uint64_t time = 1000;
  bool more = false;
  std::vector<int> satellites{5};
  std::uint64_t range_ms = 75;
  std::uint64_t lock = 9;
};

// Makes an MSM4 with one signal, 1C, of each satellite.
std::string msm4(const Made& m) {
  BitWriter w;
  w.put(static_cast<std::uint64_t>(m.number), 12)
      .put(0, 12)
      .put(m.time, 30)
      .put(m.more, 1)
      .put(0, 18);
  std::uint64_t mask = 0;
  for (const int s : m.satellites) mask |= std::uint64_t{1} << (64 - s);
  w.put(mask, 64).put(1U << 30, 32);
  const std::size_t n = m.satellites.size();
  for (std::size_t i = 0; i < n; ++i) w.put(1, 1);
  for (std::size_t i = 0; i < n; ++i) w.put(m.range_ms, 8);
  for (std::size_t i = 0; i < n; ++i) w.put(512, 10);
  for (std::size_t i = 0; i < n; ++i) w.put(1, 15);
  for (std::size_t i = 0; i < n; ++i) w.put(0x3fffff, 22);  // -1
  for (std::size_t i = 0; i < n; ++i) w.put(m.lock, 4);
  for (std::size_t i = 0; i < n; ++i) w.put(0, 1);
  for (std::size_t i = 0; i < n; ++i) w.put(44, 6);
  return rtcm_frame(w);
}

std::vector<Epoch> decode(const std::string& bytes, GpsTime near) {
  MsmDecoder decoder(near);
  std::vector<Epoch> epochs;
  Epoch epoch;
  std::string problem;
  Rtcm3Message message;
  for (Rtcm3Frames frames(bytes); frames.next(message);) {
    if (decoder.decode(message, epoch, problem)) epochs.push_back(epoch);
    EXPECT_EQ(problem, "");
  }
  if (decoder.finish(epoch)) epochs.push_back(epoch);
  return epochs;
}

const Signal* find(const Epoch& epoch, Satellite satellite, const Signal& like) {
  for (const SatelliteSignals& s : epoch.satellites) {
    if (s.satellite != satellite) continue;
    for (const Signal& signal : epoch.of(s)) {
      if (signal.band == like.band && signal.attribute == like.attribute) return &signal;
    }
  }
  return nullptr;
}

// Only the fractions of phases are compared: RTKLIB subtracts whole cycles, as the standard
// requires.
void compare(const Observations& truth, const std::vector<Epoch>& found, double code_tolerance,
             double phase_tolerance, bool rates) {
  ASSERT_EQ(found.size(), truth.epochs.size());
  std::size_t codes = 0, phases = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_LT(std::chrono::abs(found[i].time - truth.epochs[i].time), std::chrono::milliseconds(1));
    for (const SatelliteSignals& s : found[i].satellites) {
      for (const Signal& signal : found[i].of(s)) {
        const Signal* expected = find(truth.epochs[i], s.satellite, signal);
        ASSERT_NE(expected, nullptr) << to_string(s.satellite) << signal.band << signal.attribute;
        if (signal.code != 0.0) {
          EXPECT_NEAR(signal.code, expected->code, code_tolerance) << to_string(s.satellite);
          ++codes;
        }
        if (signal.phase != 0.0 && expected->phase != 0.0) {
          const double difference = signal.phase - expected->phase;
          EXPECT_NEAR(difference - std::round(difference), 0.0, phase_tolerance);
          EXPECT_EQ(signal.half_cycle, expected->half_cycle);
          ++phases;
        }
        if (rates && signal.doppler != 0.0) {
          EXPECT_NEAR(signal.doppler, expected->doppler, 1.2e-3);
        }
        EXPECT_NEAR(signal.cn0, expected->cn0, 0.6);
      }
    }
  }
  EXPECT_GT(codes, 8'000U);
  EXPECT_GT(phases, 6'000U);
}

TEST(Rtcm3, IsWhatRtklibEncoded) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MAPLOOP_REQUIRE_RTKLIB();
  const testing::TemporaryFolder folder;
  const auto ubx = folder.path() / "f9t.ubx", rinex = folder.path() / "f9t.obs";
  std::ofstream(ubx, std::ios::binary)
      << read_file(testing::real_data() / "gnss/parser_samples/F9T-L2-5min.ubx.gz");
  // The truth is RTKLIB's own reading. It leaves out phases because of their standard deviation,
  // and encodes these as constants.
  ASSERT_EQ(testing::run({"convbin", "-r", "ubx", "-od", "-os", "-o", rinex.string(), "-n",
                          (folder.path() / "nav").string(), ubx.string()})
                .status,
            0);
  const Observations truth = parse_observations(read_file(rinex), "f9t.obs");
  ASSERT_FALSE(truth.epochs.empty());
  const GpsTime near = truth.epochs.front().time + std::chrono::hours(24);
  const std::string msm7 = testing::encoded_by_rtklib(ubx, "1077,1097,1127");
  const std::string msm4 = testing::encoded_by_rtklib(ubx, "1074,1094,1124");
  compare(truth, decode(msm7, near), 1e-3, 1.2e-3, true);
  compare(truth, decode(msm4, near), 1e-2, 3e-3, false);
  // The same messages are read as a file, with an ephemeris that gives the week.
  GnssFiles files;
  EXPECT_EQ(parse_into(gps_week_frame(gps_week(near)) + msm7, "made", files), FileKind::rtcm3);
  compare(truth, files.observations.front().epochs, 1e-3, 1.2e-3, true);
  EXPECT_EQ(files.observations.front().refused, 0);
}

TEST(Rtcm3, JoinsTheMessagesOfAnEpoch) {
  const GpsTime near = gps_week_time(2400, 500.0);
  const auto epochs = decode(msm4({.more = true}) + msm4({.number = 1094, .satellites = {3, 7}}) +
                                 msm4({.time = 2000, .more = true}) +  // the last message is lost
                                 msm4({.time = 3000, .lock = 2}),
                             near);
  ASSERT_EQ(epochs.size(), 3U);
  EXPECT_EQ(epochs[0].time, gps_week_time(2400, 1.0));
  ASSERT_EQ(epochs[0].satellites.size(), 3U);
  EXPECT_EQ(to_string(epochs[0].satellites[0].satellite), "G05");
  EXPECT_EQ(to_string(epochs[0].satellites[2].satellite), "E07");
  const Signal& signal = epochs[0].signals[0];
  constexpr double light_ms = speed_of_light * 1e-3;
  EXPECT_NEAR(signal.code, light_ms * (75.5 + std::ldexp(1.0, -24)), 1e-6);
  EXPECT_NEAR(signal.phase, light_ms * (75.5 - std::ldexp(1.0, -29)) * 1575.42e6 / speed_of_light,
              1e-6);
  EXPECT_EQ(signal.cn0, 44.0);
  EXPECT_FALSE(signal.lost_lock);
  EXPECT_EQ(epochs[1].time, gps_week_time(2400, 2.0));
  EXPECT_TRUE(epochs[2].signals[0].lost_lock);  // its time of lock is shorter than before
}

TEST(Rtcm3, FindsTheWeekAndTheDay) {
  // Shortly before and after the end of the week, the nearest week is chosen.
  const GpsTime end = gps_week_time(2400, 0.0);
  EXPECT_EQ(decode(msm4({.time = 604'799'000}), end)[0].time, end - std::chrono::seconds(1));
  EXPECT_EQ(decode(msm4({.time = 1000}), end - std::chrono::hours(1))[0].time,
            end + std::chrono::seconds(1));
  // BeiDou's time is 14 s behind GPS time.
  EXPECT_EQ(decode(msm4({.number = 1124, .time = 1000}), end)[0].time,
            end + std::chrono::seconds(15));
  // For GLONASS, 03:00:00 in Moscow is midnight UTC, 18 s later in GPS time.
  const std::uint64_t moscow = 3 * 3'600'000;
  const auto glonass = decode(msm4({.number = 1084, .time = moscow}), end + std::chrono::hours(2));
  EXPECT_EQ(glonass[0].time, end + std::chrono::seconds(18));
  EXPECT_EQ(glonass[0].signals[0].phase, 0.0);  // MSM4 does not contain its channel
}

TEST(Rtcm3, ReportsWhatIsWrong) {
  const auto message = [](const std::string& bytes) -> std::string {
    try {
      parse_rtcm3(bytes, "made.rtcm3");
    } catch (const ReadError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(msm4({})).find("do not contain their week"), std::string::npos);
  EXPECT_NE(message(gps_week_frame(2400)).find("no observations"), std::string::npos);
  std::string damaged = msm4({.time = 2000});
  damaged[20] = static_cast<char>(damaged[20] ^ 1);
  const Observations o =
      parse_rtcm3(gps_week_frame(2400) + msm4({}) + damaged + msm4({.time = 604'800'000}) +
                      msm4({.time = 5000, .range_ms = 1}) + msm4({.time = 6000}) +
                      msm4({.time = 4000}) + "\xd3",
                  "made.rtcm3");
  EXPECT_EQ(o.epochs.size(), 2U);
  EXPECT_EQ(o.refused, 4);  // no time, an earlier epoch, wrong checksums, an impossible range
}

TEST(Rtcm3, TakesDamagedBytesWithoutHarm) {
  std::mt19937 random(13);
  for (int round = 0; round < 20'000; ++round) {
    // The checksum is right, but the content is random.
    BitWriter w;
    w.put(1070 + random() % 60, 12);
    for (auto i = 4 + random() % 120; i > 0; --i) w.put(random() & random(), 16);
    MsmDecoder decoder(gps_week_time(2400, 0.0));
    Epoch epoch;
    std::string problem;
    Rtcm3Message message;
    const std::string bytes = rtcm_frame(w);
    ASSERT_TRUE(Rtcm3Frames(bytes).next(message));
    const bool whole = decoder.decode(message, epoch, problem) || decoder.finish(epoch);
    if (!whole) continue;
    for (const SatelliteSignals& s : epoch.satellites) {
      for (const Signal& signal : epoch.of(s)) {
        ASSERT_TRUE(std::isfinite(signal.phase) && std::isfinite(signal.doppler));
      }
    }
  }
}

}  // namespace
}  // namespace maploop::ppp
