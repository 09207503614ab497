// These tests decode made packets: errors in transit, and their effect on the clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "msgs/frames.h"
#include "sensors/velodyne/velodyne_decoder.h"
#include "tests/sensors/velodyne/made_packets.h"

namespace maploop::sensors {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

const Time begin = parse_time("2026-03-01 10:59:59.5");

// This is a VLP-16 at 10 turns a second, packets 1.3 ms apart, that starts at the rear.
class Vlp16 {
 public:
  static constexpr Duration period{1'327'104};

  Vlp16() : decoder_(VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16)) {}

  void send(int packets, Duration delay = milliseconds(1)) {
    for (int i = 0; i < packets; ++i) {
      const DataBytes packet = next();
      deliver(packet, now_ + delay);
    }
  }
  DataBytes next() {
    now_ += period;
    const double turned = to_seconds(now_ - begin) * 10.0 * 36000.0 + 18000.0;
    const std::int64_t us =
        (3'599'500'000 + (now_ - begin + clock_set_) / microseconds(1)) % 3'600'000'000;
    return data_packet(std::fmod(turned, 36000.0), 39.8, static_cast<std::uint32_t>(us), range,
                       mode);
  }
  // Delivers a packet, which leaves the scanner when it is full.
  void deliver(const DataBytes& packet, Time arrival) {
    LidarScan scan;
    if (decoder_.add(packet, arrival + period, scan)) scans.push_back(scan);
  }
  void set_clock(Duration by) { clock_set_ += by; }
  VelodyneDecoder& decoder() { return decoder_; }
  Time now() const { return now_; }

  std::vector<LidarScan> scans;
  std::uint16_t range = 5000;
  std::uint8_t mode = 0x37;

 private:
  VelodyneDecoder decoder_;
  Time now_ = begin;
  Duration clock_set_{};
};

TEST(VelodyneDecoder, MakesTurnsFromRearToRearAcrossTheEndOfTheHour) {
  Vlp16 scanner;
  scanner.send(800);
  ASSERT_GE(scanner.scans.size(), 9U);
  EXPECT_EQ(scanner.decoder().counts().lost, 0U);
  EXPECT_EQ(scanner.decoder().turns().broken, 0U);
  EXPECT_EQ(scanner.decoder().clock().jumps(), 0U);
  for (std::size_t i = 1; i < scanner.scans.size(); ++i) {
    const LidarScan& scan = scanner.scans[i];
    EXPECT_EQ(scan.start, scanner.scans[i - 1].end);
    EXPECT_NEAR(to_seconds(scan.end - scan.start), 0.1, 20e-6);
    EXPECT_NEAR(to_seconds(scan.stamp - scan.start), 0.05, 20e-6);
    EXPECT_GE(scan.available, scan.end);
    EXPECT_LT(scan.available - scan.end, milliseconds(4));
    EXPECT_EQ(scan.sequence, scanner.scans[i - 1].sequence + 1);
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 0.1 / 55.296e-6 * 16, 40.0);
    EXPECT_LT(scan.points.front().x, 0.0F);  // from the rear ...
    EXPECT_GT(scan.points[100].y, 0.0F);     // ... over the left, clockwise
    EXPECT_NEAR(scan.points[scan.points.size() / 2].y, 0.0F, 0.1F);
  }
}

TEST(VelodyneDecoder, PlacesEveryLaserByItsManual) {
  Vlp16 scanner;
  scanner.send(300);
  ASSERT_FALSE(scanner.scans.empty());
  const LidarScan& scan = scanner.scans.front();
  double lowest = 0.0, highest = 0.0;
  for (const LidarPoint& p : scan.points) {
    const double elevation = degrees(std::atan2(p.z, std::hypot(p.x, p.y)));
    lowest = std::min(lowest, elevation);
    highest = std::max(highest, elevation);
    EXPECT_NEAR(std::hypot(p.x, p.y, p.z), 10.0, 0.012);
    EXPECT_NEAR(p.reflectance, 100.0 / 255.0, 1e-6);
  }
  // The expected angles contain 15 degrees and 11.2 mm at 10 m.
  EXPECT_NEAR(lowest, -15.0 + degrees(0.0112 / 10.0), 0.01);
  EXPECT_NEAR(highest, 15.0 - degrees(0.0112 / 10.0), 0.01);
}

TEST(VelodyneDecoder, DualReturnsCountOnceWhereTheyAreEqual) {
  Vlp16 single, dual;
  dual.mode = 0x39;
  // Twelve blocks are six firings, so each packet takes half the time.
  for (int i = 0; i < 600; ++i) {
    const double turned = i * 0.5 * to_seconds(Vlp16::period) * 360000.0;
    const auto us = static_cast<std::uint32_t>(1e6 + i * 0.5 * to_seconds(Vlp16::period) * 1e6);
    DataBytes packet = data_packet(std::fmod(turned, 36000.0), 39.8, us, 5000, 0x39);
    if (i % 2 == 1) put(packet, 100 + 4, 6000, 2);  // another last return of the first laser
    dual.deliver(packet, begin + microseconds(us));
  }
  single.send(400);
  ASSERT_FALSE(dual.scans.empty());
  ASSERT_FALSE(single.scans.empty());
  EXPECT_EQ(dual.decoder().counts().lost, 0U);
  const double more = static_cast<double>(dual.scans.front().points.size()) -
                      static_cast<double>(single.scans.front().points.size());
  EXPECT_NEAR(more, 75.4, 45.0);  // one for every second packet of a turn
}

TEST(VelodyneDecoder, CountsLostAndReorderedPackets) {
  Vlp16 scanner;
  scanner.send(200);
  const auto turns = scanner.scans.size();
  for (int i = 0; i < 3; ++i) scanner.next();  // these never arrive
  scanner.send(20);
  EXPECT_EQ(scanner.decoder().counts().lost, 3U);
  const DataBytes early = scanner.next(), late = scanner.next();
  scanner.deliver(late, scanner.now() + milliseconds(1));
  scanner.deliver(early, scanner.now() + milliseconds(1));
  scanner.deliver(late, scanner.now() + milliseconds(1));  // a second time
  EXPECT_EQ(scanner.decoder().counts().late, 2U);
  scanner.send(100);
  EXPECT_GT(scanner.scans.size(), turns);  // a turn with a small gap counts
  EXPECT_EQ(scanner.decoder().turns().broken, 0U);
}

TEST(VelodyneDecoder, ATurnWithALongGapIsBroken) {
  Vlp16 scanner;
  scanner.send(110);
  const auto before = scanner.scans.size();
  for (int i = 0; i < 25; ++i) scanner.next();
  scanner.send(20);
  EXPECT_EQ(scanner.scans.size(), before);
  EXPECT_EQ(scanner.decoder().turns().broken, 1U);
  scanner.send(200);
  EXPECT_GE(scanner.scans.size(), before + 2);
  EXPECT_NEAR(to_seconds(scanner.scans.back().end - scanner.scans.back().start), 0.1, 20e-6);
}

TEST(VelodyneDecoder, AScannerThatStandsStillMakesNoTurnAndTakesNoMemory) {
  VelodyneDecoder decoder(VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16));
  LidarScan scan;
  for (int i = 0; i < 20'000; ++i) {
    const auto us = static_cast<std::uint32_t>(i) * 1327U;
    EXPECT_FALSE(decoder.add(data_packet(17999.0 + (i > 10 ? 2 : 0), 0.0, us),
                             begin + microseconds(us), scan));
  }
  EXPECT_EQ(decoder.turns().complete, 0U);
}

TEST(VelodyneDecoder, StampsDoNotWaverWithTheNetwork) {
  Vlp16 scanner;
  std::mt19937 random(1);
  scanner.send(100);
  for (int i = 0; i < 3000; ++i) scanner.send(1, microseconds(1000 + random() % 900));
  for (std::size_t i = 20; i < scanner.scans.size(); ++i) {
    EXPECT_NEAR(to_seconds(scanner.scans[i].end - scanner.scans[i].start), 0.1, 30e-6);
  }
  // Only the minimum delay cannot be observed.
  EXPECT_NEAR(to_seconds(scanner.scans.back().end - begin -
                         milliseconds(100) * (scanner.scans.back().sequence + 1)),
              1e-3, 50e-6);
}

TEST(VelodyneDecoder, GoesOnAfterTheScannerWasSwitchedOff) {
  Vlp16 scanner;
  scanner.send(200);
  const std::size_t before = scanner.scans.size();
  // The clock restarts at the beginning of its own hour.
  for (int i = 0; i < 400; ++i) {
    const auto us = static_cast<std::uint32_t>(i * 1327.104);
    scanner.deliver(data_packet(std::fmod(477.757 * i, 36000.0), 39.8, us),
                    begin + std::chrono::seconds(20) + microseconds(us));
  }
  EXPECT_EQ(scanner.decoder().clock().jumps(), 1U);
  ASSERT_GE(scanner.scans.size(), before + 4);
  EXPECT_GT(scanner.scans.back().stamp, begin + std::chrono::seconds(20));
  EXPECT_LT(scanner.scans.back().end, begin + std::chrono::seconds(21));
}

// Returns the largest error of the ends of turns from `first` on, at 10 turns a second.
double worst_end(const Vlp16& scanner, std::size_t first) {
  double worst = 0.0;
  for (std::size_t i = first; i < scanner.scans.size(); ++i) {
    const LidarScan& scan = scanner.scans[i];
    const double turn = std::round(10.0 * to_seconds(scan.end - begin));
    worst = std::max(worst, std::fabs(to_seconds(scan.end - begin) - 0.1 * turn));
  }
  return worst;
}

TEST(VelodyneDecoder, PacketsThatTheWayHeldUpAndThenSentAtOnceKeepTheirTimes) {
  for (const int packets : {1000, 2000}) {  // for 1.3 s, and 2.7 s
    Vlp16 scanner;
    scanner.send(2000);
    std::vector<DataBytes> held(static_cast<std::size_t>(packets));
    for (DataBytes& packet : held) packet = scanner.next();
    for (std::size_t i = 0; i < held.size(); ++i) {
      scanner.deliver(held[i], scanner.now() + microseconds(i));
    }
    scanner.send(2000);
    EXPECT_EQ(scanner.decoder().clock().jumps(), 0U);
    EXPECT_LT(worst_end(scanner, 2), 3e-3) << packets;
  }
}

TEST(VelodyneDecoder, PacketsThatWereLostWhileTheWayWasHeldUpMoveNoStamp) {
  Vlp16 scanner;
  scanner.send(2000);
  std::vector<DataBytes> held(3000);
  for (DataBytes& packet : held) packet = scanner.next();
  for (std::size_t i = 0; i < 1500; ++i) {  // as many as the socket could hold
    scanner.deliver(held[i], scanner.now() + microseconds(i));
  }
  scanner.send(2000);
  EXPECT_EQ(scanner.decoder().clock().jumps(), 0U);
  EXPECT_LT(worst_end(scanner, 2), 3e-3);
}

TEST(VelodyneDecoder, AClockThatIsSetBackShowsAtOnce) {
  for (const double by : {0.06, 0.3, 0.45}) {
    Vlp16 scanner;
    scanner.send(2000);
    const std::size_t before = scanner.scans.size();
    scanner.set_clock(from_seconds(-by));
    scanner.send(2000);
    EXPECT_EQ(scanner.decoder().clock().jumps(), 1U) << by;
    EXPECT_LT(worst_end(scanner, before + 2), 3e-3) << by;
  }
}

TEST(VelodyneDecoder, TellsItsGpsReceiversTime) {
  Vlp16 scanner;
  scanner.send(100);
  LidarScan scan;
  const auto heard = [&](std::uint8_t pulse, std::string_view sentence) {
    const DataBytes packet = scanner.next();
    scanner.deliver(packet, scanner.now() + milliseconds(1));
    PacketFault fault{};
    const auto us = DataPacket::check(packet, fault).device_time();
    scanner.decoder().add(position_packet(us, pulse, sentence), scanner.now(), scan);
    return scanner.decoder().clock().gps_offset();
  };
  // It is 08:59:59 (the made scanner's clock is at 59:59.6), 1 h and 2 s before the host's time.
  constexpr std::string_view rmc =
      "$GPRMC,085959,A,4858.95,N,00823.42,E,10.3,188.2,010326,,,D*48\r\n";
  EXPECT_FALSE(heard(0, rmc)) << "no pulse";
  EXPECT_FALSE(heard(2, "$GPRMC,085959,V,,,,,,,010326,,,N*5D\r\n")) << "no fix";
  EXPECT_FALSE(heard(2, "$GPRMC,085959,A,4858.95,N,00823.42,E,10.3,188.2,010326,,,D*49\r\n"))
      << "wrong checksum";
  const auto offset = heard(2, rmc);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(to_seconds(*offset), -7200.0, 2e-3);
  EXPECT_EQ(scanner.decoder().counts().positions, 4U);
}

TEST(VelodyneDecoder, RefusesInvalidPacketsAndThoseOfAnotherModelAndCountsWhy) {
  VelodyneDecoder decoder(VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16));
  LidarScan scan;
  DataBytes flag = data_packet(0, 40, 0), azimuth = flag, model = flag;
  flag[700] = 0;
  put(azimuth, 502, 36000, 2);
  model[1205] = 0x21;
  const DataBytes whole = data_packet(0, 40, 0);
  const std::span<const std::uint8_t> bytes(whole);
  EXPECT_FALSE(decoder.add(flag, begin, scan));
  EXPECT_FALSE(decoder.add(azimuth, begin, scan));
  EXPECT_FALSE(decoder.add(model, begin, scan));
  EXPECT_FALSE(decoder.add(bytes.first(1205), begin, scan));
  EXPECT_FALSE(decoder.add({}, begin, scan));
  using enum PacketFault;
  const auto& refused = decoder.counts().refused;
  EXPECT_EQ(refused[static_cast<std::size_t>(wrong_block)], 1U);
  EXPECT_EQ(refused[static_cast<std::size_t>(wrong_azimuth)], 1U);
  EXPECT_EQ(refused[static_cast<std::size_t>(other_model)], 1U);
  EXPECT_EQ(refused[static_cast<std::size_t>(wrong_size)], 2U);
  EXPECT_EQ(decoder.counts().data, 0U);
}

TEST(VelodyneDecoder, AnyBytesAreHarmless) {
  std::mt19937 random(3);
  for (const auto model : {VelodyneModel::vlp16, VelodyneModel::hdl32e}) {
    VelodyneDecoder decoder(model, factory_lasers(model));
    LidarScan scan;
    Time arrival = begin;
    for (int i = 0; i < 20'000; ++i) {
      DataBytes packet =
          data_packet(static_cast<double>(random() % 36000), static_cast<double>(random() % 500),
                      static_cast<std::uint32_t>(random()), 5000, random() % 2 ? 0x37 : 0x39,
                      model == VelodyneModel::vlp16 ? 0x22 : 0x21);
      for (unsigned n = random() % 8; n > 0; --n) {
        packet[random() % packet.size()] = static_cast<std::uint8_t>(random());
      }
      arrival += Duration(random() % 3'000'000);
      if (!decoder.add(packet, arrival, scan)) continue;
      EXPECT_LT(scan.start, scan.stamp);
      EXPECT_LT(scan.stamp, scan.end);
      EXPECT_LE(scan.end, scan.available);
      for (const LidarPoint& p : scan.points) ASSERT_LT(std::hypot(p.x, p.y, p.z), 132.0F);
    }
  }
}

}  // namespace
}  // namespace maploop::sensors
