// Tests raw measurements of u-blox receivers: a real recording against RTKLIB's reading of it, and
// damaged data.
#include "ppp/readers/streams/ubx.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "ppp/gnss_files.h"
#include "ppp/readers/files/lines.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tests/support/ubx_frame.h"

namespace maploop::ppp {
namespace {

using testing::ubx_frame;

constexpr const char* sample = "gnss/parser_samples/F9T-L2-5min.ubx.gz";

template <class T>
void put(std::string& text, std::size_t at, T value) {
  std::memcpy(text.data() + at, &value, sizeof value);
}

struct Measurement {
  std::uint8_t gnss, number, signal;
  double code;
  double phase = 1e8;
  std::uint16_t lock_ms = 5000;
  std::uint8_t status = 7;
};

std::string rawx(double tow, const std::vector<Measurement>& measurements) {
  std::string payload(16 + 32 * measurements.size(), '\0');
  put(payload, 0, tow);
  put(payload, 8, std::uint16_t{2379});
  payload[11] = static_cast<char>(measurements.size());
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    const std::size_t at = 16 + 32 * i;
    put(payload, at, m.code);
    put(payload, at + 8, m.phase);
    put(payload, at + 16, -1234.5F);
    payload[at + 20] = static_cast<char>(m.gnss);
    payload[at + 21] = static_cast<char>(m.number);
    payload[at + 22] = static_cast<char>(m.signal);
    put(payload, at + 24, m.lock_ms);
    payload[at + 26] = 45;
    payload[at + 30] = static_cast<char>(m.status);
  }
  return ubx_frame(0x02, 0x15, payload);
}

TEST(Ubx, ALogMayBeginWithTheTextOfTheReceiversStart) {
  std::string text;
  while (text.size() < 12000) text += "$GNTXT,01,01,02,u-blox AG - www.u-blox.com*4E\r\n";
  EXPECT_EQ(file_kind(text), FileKind::unknown);
  text += rawx(100.0, {{0, 5, 0, 2e7}});
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "start.ubx";
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_EQ(kind_of_file(file), FileKind::ubx);
}

TEST(Ubx, ReadsARecordingOfAnF9T) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files;
  EXPECT_EQ(read_into(testing::real_data() / sample, files), FileKind::ubx);
  ASSERT_EQ(files.observations.size(), 1U);
  const Observations& o = files.observations.front();
  ASSERT_EQ(o.epochs.size(), 299U);
  EXPECT_EQ(format_gps_time(o.epochs.front().time), "2025-08-11 21:31:31.001");
  EXPECT_EQ(format_gps_time(o.epochs.back().time), "2025-08-11 21:36:29.001");
  EXPECT_EQ(o.refused, 0) << (o.refusals.empty() ? "" : o.refusals.front());
}

// RTKLIB does not name BeiDou's B1C; everything else that it writes must be found with the same
// values.
TEST(Ubx, IsWhatRtklibReads) {
  MAPLOOP_REQUIRE_REAL_DATA();
  if (testing::run({"sh", "-c", "command -v convbin"}).status != 0) {
    GTEST_SKIP() << "SKIPPED, NOT TESTED: RTKLIB's convbin is not installed";
  }
  const testing::TemporaryFolder folder;
  const std::string bytes = read_file(testing::real_data() / sample);
  const auto ubx = folder.path() / "f9t.ubx", rinex = folder.path() / "f9t.obs";
  std::ofstream(ubx, std::ios::binary) << bytes;
  ASSERT_EQ(testing::run({"convbin", "-r", "ubx", "-od", "-os", "-o", rinex.string(), "-n",
                          (folder.path() / "nav").string(), ubx.string()})
                .status,
            0);
  const Observations ours = parse_ubx(bytes, "f9t.ubx");
  const Observations theirs = parse_observations(read_file(rinex), "f9t.obs");
  ASSERT_EQ(ours.epochs.size(), theirs.epochs.size());
  std::size_t compared = 0;
  for (std::size_t i = 0; i < ours.epochs.size(); ++i) {
    const Epoch &a = ours.epochs[i], &b = theirs.epochs[i];
    ASSERT_LT(std::chrono::abs(a.time - b.time), std::chrono::microseconds(1));
    for (const SatelliteSignals& satellite : b.satellites) {
      for (const Signal& expected : b.of(satellite)) {
        const Signal* found = nullptr;
        for (const SatelliteSignals& s : a.satellites) {
          if (s.satellite != satellite.satellite) continue;
          for (const Signal& signal : a.of(s)) {
            if (signal.band == expected.band && signal.attribute == expected.attribute) {
              found = &signal;
            }
          }
        }
        ASSERT_NE(found, nullptr) << to_string(satellite.satellite) << expected.band;
        EXPECT_NEAR(found->code, expected.code, 6e-4);
        EXPECT_NEAR(found->doppler, expected.doppler, 6e-4);
        EXPECT_NEAR(found->cn0, expected.cn0, 1e-3);
        // RTKLIB leaves out phases with a large standard deviation.
        if (expected.phase != 0.0) {
          EXPECT_NEAR(found->phase, expected.phase, 6e-4);
          EXPECT_EQ(found->half_cycle, expected.half_cycle);
        }
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 9'000U);
}

TEST(Ubx, MarksWhereThePhaseMayHaveSlipped) {
  RawxDecoder decoder;
  Epoch epoch;
  std::string problem;
  const auto decode = [&](double tow, Measurement m) {
    const std::string bytes = rawx(tow, {m});
    UbxFrame found;
    EXPECT_TRUE(UbxFrames(bytes).next(found));
    EXPECT_TRUE(decoder.decode(found, epoch, problem)) << problem;
    return epoch.signals.front();
  };
  constexpr double code = 2.2e7;
  EXPECT_FALSE(decode(1, {0, 5, 0, code, 1e8, 5000}).lost_lock);
  EXPECT_FALSE(decode(2, {0, 5, 0, code, 1e8, 6000}).lost_lock);
  EXPECT_TRUE(decode(3, {0, 5, 0, code, 1e8, 500}).lost_lock);
  EXPECT_TRUE(decode(4, {0, 5, 0, code, 1e8, 1500, 3}).half_cycle);
  EXPECT_TRUE(decode(5, {0, 5, 0, code, 1e8, 2500, 15}).lost_lock);  // half a cycle was subtracted
  EXPECT_EQ(decode(6, {0, 5, 0, code, 1e8, 3500, 1}).phase, 0.0);
  EXPECT_TRUE(decode(60, {0, 5, 0, code, 1e8, 20'000}).lost_lock);  // restarted meanwhile
  EXPECT_FALSE(decode(90, {0, 5, 0, code, 1e8, 50'000}).lost_lock);
  EXPECT_EQ(epoch.satellites.front().satellite, (Satellite{System::gps, 5}));
  EXPECT_NEAR(epoch.signals.front().doppler, -1234.5, 1e-3);
}

TEST(Ubx, LeavesOutAndCountsWhatItCannotName) {
  const std::string bytes = "$GNGGA text between\r\n" +
                            rawx(10, {{6, 255, 0, 2.2e7},  // GLONASS with unknown number
                                      {1, 133, 0, 3.8e7},
                                      {0, 7, 3, 2.3e7},
                                      {2, 11, 0, 2.5e7},
                                      {0, 7, 0, 2.3e7},
                                      {0, 7, 0, 2.3e7},    // repeated
                                      {0, 8, 0, 12.0},     // impossible pseudorange
                                      {0, 9, 99, 2.2e7}})  // unknown signal
                            + rawx(9, {{0, 7, 0, 2.3e7}}) +
                            ubx_frame(0x01, 0x07, std::string(92, 'x')) +
                            rawx(11, {{0, 7, 0, 2.3e7}}).substr(0, 30);
  const Observations o = parse_ubx(bytes, "made.ubx");
  ASSERT_EQ(o.epochs.size(), 1U);
  const Epoch& e = o.epochs.front();
  ASSERT_EQ(e.satellites.size(), 3U);
  EXPECT_EQ(to_string(e.satellites[0].satellite), "G07");
  EXPECT_EQ(e.satellites[0].count, 2U);
  EXPECT_EQ(to_string(e.satellites[1].satellite), "E11");
  EXPECT_EQ(to_string(e.satellites[2].satellite), "S33");
  EXPECT_EQ(o.refused, 3);  // the earlier epoch, the cut frame, the measurements
  EXPECT_NE(o.refusals.back().find("4 measurements"), std::string::npos) << o.refusals.back();
  EXPECT_THROW(parse_ubx(ubx_frame(0x01, 0x07, std::string(92, 'x')), "no_raw.ubx"), ReadError);
}

TEST(Ubx, TakesDamagedBytesWithoutHarm) {
  std::mt19937 random(11);
  std::string clean;
  for (int i = 0; i < 6; ++i) {
    clean += rawx(i, {{0, 7, 0, 2.3e7}, {2, 11, 0, 2.5e7}, {6, 3, 0, 2.1e7}});
  }
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = clean;
    for (auto n = 1 + random() % 6; n > 0; --n) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    bytes.resize(random() % (bytes.size() + 1));
    try {
      for (const Epoch& epoch : parse_ubx(bytes, "damaged").epochs) {
        for (const SatelliteSignals& s : epoch.satellites) {
          ASSERT_GT(s.count, 0U);
          for (const Signal& signal : epoch.of(s)) ASSERT_TRUE(std::isfinite(signal.phase));
        }
      }
    } catch (const ReadError&) {
    }
  }
}

}  // namespace
}  // namespace maploop::ppp
