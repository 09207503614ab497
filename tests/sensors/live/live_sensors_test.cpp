// These tests connect sensors over loopback sockets and pseudo-terminals, unplug and reconnect
// them, and send hostile data.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "sensors/imu/imu_line.h"
#include "sensors/imu/ncom_packet.h"
#include "sensors/live/live_sensors.h"
#include "tests/sensors/live/lines.h"
#include "tests/sensors/velodyne/made_packets.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Bytes;
using testing::epoch;
using testing::free_port;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::PseudoTerminal;
using testing::TcpServer;
using testing::UdpSender;
using testing::wait_for;
using testing::wait_until_open;

TEST(Endpoint, IsOnTheLoopbackByDefault) {
  EXPECT_EQ(parse_endpoint("udp://:2368").address, "127.0.0.1");
  EXPECT_EQ(parse_endpoint("udp://0.0.0.0:2368").address, "0.0.0.0");
  EXPECT_EQ(parse_endpoint("tcp://192.168.1.7:5000").port, 5000);
  EXPECT_EQ(parse_endpoint("serial:///dev/ttyUSB0").baud, 115200);
  EXPECT_EQ(parse_endpoint("serial:///dev/ttyUSB0?baud=9600").baud, 9600);
  for (const char* text : {"", "udp", "udp://", "udp://:99999", "udp://:-1", "udp://localhost:5",
                           "tcp://:5", "http://1.2.3.4:5", "serial://ttyUSB0", "udp://1.2.3:4",
                           "serial:///dev/x?baud=12345", "serial:///dev/x?parity=even"}) {
    EXPECT_THROW(parse_endpoint(text), std::invalid_argument) << text;
  }
}

TEST(Endpoint, IsShownWithoutWhatIsSecret) {
  const std::pair<const char*, const char*> cases[] = {
      {"ntrip://me:secret@host/M", "ntrip://***@host/M"},
      {"ntrips://me:s@c:r/e t@host:2102/M?gga=1,2,3", "ntrips://***@host:2102/M?gga=1,2,3"},
      {"rtspsrc location=rtsp://me:secret@host/a ! rtph264depay",
       "rtspsrc location=rtsp://***@host/a ! rtph264depay"},
      {"rtspsrc location=rtsp://host/a user-id=me user-pw=secret ! decodebin",
       "rtspsrc location=rtsp://host/a user-id=me user-pw=*** ! decodebin"},
      {"souphttpsrc user-pw=\"se cret\" location=http://host/",
       "souphttpsrc user-pw=*** location=http://host/"},
      {"udp://:2368", "udp://:2368"},
      {"user-pw=", "user-pw=***"},
      {"", ""}};
  for (const auto& [text, shown] : cases) EXPECT_EQ(without_secrets(text), shown);
  for (const char* text : {"ntrip://me:secret@host/M", "tcp://me:secret@1.2.3.4:5"}) {
    EXPECT_THAT([&] { parse_endpoint(text); },
                ThrowsMessage<std::invalid_argument>(Not(HasSubstr("secret"))));
  }
}

TEST(LiveNmea, SurvivesUnpluggingOfASerialLine) {
  const testing::TemporaryFolder folder;
  const HostClock clock;
  const auto device = folder.path() / "gnss";
  const auto gnss = listen_to_nmea(parse_endpoint("serial://" + device.string()), {}, clock);
  GnssFix fix;
  EXPECT_FALSE(gnss->wait(fix, milliseconds(5)));  // not connected yet
  EXPECT_THAT(gnss->report().connection.problem, HasSubstr("is it plugged in?"));
  Time last{};
  for (int plugged = 0; plugged < 3; ++plugged) {
    {
      const PseudoTerminal line(device);
      ASSERT_TRUE(wait_until_open(*gnss, true));
      line.send("GGA,half a sentence from before\r\n" + epoch(10 * plugged));
      ASSERT_TRUE(wait_for(*gnss, fix));
      EXPECT_NEAR(fix.position.latitude * 180.0 / M_PI, 48.9825, 1e-9);
      EXPECT_NEAR(fix.position.height, 163.1, 1e-9);
      EXPECT_NEAR(fix.velocity_enu.x(), 10.0, 1e-3);
      EXPECT_NEAR(fix.velocity_enu.y(), 0.0, 1e-9);
      EXPECT_NEAR(std::sqrt(fix.position_covariance(0, 0)), 2.4, 1e-9);
      EXPECT_GT(fix.available, last);
      EXPECT_LT(fix.stamp, fix.available);
      EXPECT_LT(fix.available - clock.now(), seconds(1));
      last = fix.available;
      line.send("$GNGGA,half a sen");
    }
    ASSERT_TRUE(wait_until_open(*gnss, false));
  }
  const LiveReport report = gnss->report();
  EXPECT_EQ(report.connection.opened, 3U);
  EXPECT_EQ(report.delivered, 3U);
  EXPECT_EQ(report.refused, 3U);  // the damaged lines
}

TEST(LiveNmea, ReconnectsOverTcp) {
  const HostClock clock;
  TcpServer server;
  const auto gnss = listen_to_nmea(parse_endpoint(server.endpoint()), {}, clock);
  for (int connected = 0; connected < 2; ++connected) {
    ASSERT_TRUE(wait_until_open(*gnss, true) && server.answer());
    GnssFix first, second;
    ASSERT_TRUE(server.send(epoch(10 * connected)));
    ASSERT_TRUE(wait_for(*gnss, first));
    ASSERT_TRUE(server.send(epoch(10 * connected + 1)));
    ASSERT_TRUE(wait_for(*gnss, second));
    EXPECT_GT(second.stamp, first.stamp);
    EXPECT_GT(second.available, first.available);
    server.hang_up();
    ASSERT_TRUE(wait_until_open(*gnss, false));
    EXPECT_THAT(gnss->report().connection.problem, HasSubstr("closed by the other side"));
  }
  server.shut();
  GnssFix fix;
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(gnss->wait(fix, milliseconds(20)));
  EXPECT_THAT(gnss->report().connection.problem, HasSubstr("cannot be connected to"));
}

TEST(LiveNmea, NoticesAPeerThatDisappearsSilently) {
  const HostClock clock;
  TcpServer server;
  const auto gnss = listen_to_nmea(parse_endpoint(server.endpoint()), {}, clock);
  ASSERT_TRUE(wait_until_open(*gnss, true) && server.answer());
  // This simulates a machine that loses its power: a socket closed in this mode sends nothing.
  const int on = 1;
  const bool silenced = setsockopt(server.peer(), IPPROTO_TCP, TCP_REPAIR, &on, sizeof on) == 0;
  server.shut();
  if (!silenced) GTEST_SKIP() << "only an administrator may end a connection without a word";
  EXPECT_TRUE(wait_until_open(*gnss, false));
}

TEST(LiveNcom, StampsByTheUnitsClock) {
  const HostClock clock;
  const std::uint16_t port = free_port();
  const auto imu =
      listen_to_ncom(parse_endpoint("udp://:" + std::to_string(port)), milliseconds(60), clock);
  ASSERT_TRUE(wait_until_open(*imu, true));
  const UdpSender sender(port);
  std::vector<ImuSample> samples;
  for (int i = 0; i < 5; ++i) {
    // These cross the end of the minute and come all at once, as after a network interruption.
    const auto ms = static_cast<std::uint16_t>((59'980 + 10 * i) % 60'000);
    sender.send(ncom_packet(ms, {1.5, -0.25, 0.125}));
  }
  sender.send(ncom_packet(20, {1.5, -0.25, 0.125}));  // again
  NcomBytes damaged = ncom_packet(30, {1.5, -0.25, 0.125});
  damaged[5] ^= 1;
  sender.send(damaged);
  sender.send(Bytes(damaged).first(71));
  sender.send(std::vector<std::uint8_t>(3000, 0xe7));
  ImuSample sample;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(wait_for(*imu, sample));
    samples.push_back(sample);
  }
  EXPECT_FALSE(imu->wait(sample, milliseconds(100)));
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_NEAR(to_seconds(samples[i].stamp - samples[i - 1].stamp), 0.01, 0.01);
    EXPECT_GT(samples[i].available, samples[i - 1].available);
  }
  EXPECT_LE(samples[4].stamp, samples[4].available - milliseconds(60));
  EXPECT_NEAR(samples[0].specific_force_forward, 1.5, 1e-4);
  EXPECT_NEAR(samples[0].specific_force_left, -0.25, 1e-4);
  EXPECT_NEAR(samples[0].yaw_rate, 0.125, 1e-5);
  const LiveReport report = imu->report();
  EXPECT_EQ(report.delivered, 5U);
  EXPECT_EQ(report.refused, 3U);
  EXPECT_EQ(report.connection.too_large, 1U);
}

TEST(LiveImuLines, AreStampedByTheUnitsClockOverASerialLine) {
  const testing::TemporaryFolder folder;
  const HostClock clock;
  const auto device = folder.path() / "imu";
  const PseudoTerminal line(device);
  const auto imu =
      listen_to_imu_lines(parse_endpoint("serial://" + device.string()), milliseconds(20), clock);
  ASSERT_TRUE(wait_until_open(*imu, true));
  ImuSample sample;
  const InertialValues three{1.5, -0.25, 0.125}, six{1.5, -0.25, 0.125, true, 9.75, 0.25, -0.5};
  Time last{};
  for (int i = 0; i < 5; ++i) {
    // The third line is delayed in transit.
    if (i == 3) usleep(50'000);
    line.send(imu_line({milliseconds(1000 + 10 * i), i < 4 ? three : six}));
    ASSERT_TRUE(wait_for(*imu, sample));
    if (i > 0) {
      EXPECT_NEAR(to_seconds(sample.stamp - last), 0.01, 0.005);
    }
    last = sample.stamp;
    usleep(10'000);
  }
  EXPECT_EQ(sample.values(), six);
  EXPECT_GT(sample.available - sample.stamp, milliseconds(20));
  line.send(imu_line({milliseconds(1000), {}}));  // earlier
  line.send("$PIMU,2.0,1.0,nan,0.1*00\r\n$PIMU,1,2,3*11\r\n" + imu_line({seconds(2), {900.0}}));
  EXPECT_FALSE(imu->wait(sample, milliseconds(200)));
  EXPECT_EQ(imu->report().refused, 4U);
}

TEST(LiveVelodyne, MakesScansOfDatagrams) {
  const HostClock clock;
  const std::uint16_t port = free_port();
  const auto velodyne =
      listen_to_velodyne({parse_endpoint("udp://:" + std::to_string(port)), std::nullopt,
                          VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16)},
                         clock);
  ASSERT_TRUE(wait_until_open(*velodyne, true));
  const UdpSender sender(port);
  LidarScan scan;
  int scans = 0;
  for (int i = 0; i < 300; ++i) {
    const auto us = static_cast<std::uint32_t>(1327.104 * i);
    sender.send(data_packet(std::fmod(477.757 * i, 36000.0), 39.8, us));
    if (i % 10 == 0) sender.send(std::vector<std::uint8_t>(1248, 0xff));  // from another program
    usleep(1327);
    if (!velodyne->wait(scan, Duration::zero())) continue;
    ++scans;
    EXPECT_GT(scan.points.size(), 25'000U);
    EXPECT_LE(scan.end, scan.available);
  }
  EXPECT_EQ(scans, 3);
  for (int i = 0; i < 100 && velodyne->report().refused < 30; ++i) {
    velodyne->wait(scan, milliseconds(20));
  }
  EXPECT_EQ(velodyne->report().refused, 30U);
}

TEST(LiveSensors, AFloodOfGarbageNeitherHoldsThemNorFillsMemory) {
  const HostClock clock;
  const std::uint16_t port = free_port();
  const auto imu =
      listen_to_ncom(parse_endpoint("udp://:" + std::to_string(port)), Duration::zero(), clock);
  const testing::TemporaryFolder folder;
  const auto device = folder.path() / "gnss";
  const PseudoTerminal line(device);
  const auto gnss = listen_to_nmea(parse_endpoint("serial://" + device.string()), {}, clock);
  ASSERT_TRUE(wait_until_open(*imu, true));
  ASSERT_TRUE(wait_until_open(*gnss, true));
  const UdpSender sender(port);
  std::mt19937 random(5);
  ImuSample sample;
  GnssFix fix;
  for (int round = 0; round < 50; ++round) {
    std::vector<std::uint8_t> garbage(1 + random() % 1400);
    for (auto& b : garbage) b = static_cast<std::uint8_t>(random());
    for (int i = 0; i < 100; ++i) sender.send(garbage);
    line.send(std::string(garbage.begin(), garbage.end()));
    const Time before = clock.now();
    EXPECT_FALSE(imu->wait(sample, milliseconds(5)));
    EXPECT_FALSE(gnss->wait(fix, milliseconds(5)));
    EXPECT_LT(clock.now() - before, seconds(5));
  }
  while (imu->wait(sample, milliseconds(5)) || imu->report().refused < 10) {
  }
  // Afterwards the unit's packets are accepted again.
  for (int i = 0; i < 200 && imu->report().delivered == 0; ++i) {
    sender.send(ncom_packet(static_cast<std::uint16_t>(1000 + 10 * i), {}));
    imu->wait(sample, milliseconds(20));
  }
  EXPECT_GT(imu->report().delivered, 0U);
  line.send("\r\n" + epoch(1));
  EXPECT_TRUE(wait_for(*gnss, fix));
}

}  // namespace
}  // namespace maploop::sensors
