// Tests a receiver's own fixes, as it recorded them, on a loopback socket.
#include "runtime/vehicle/drivers/live_gnss.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <thread>

#include "ppp/readers/files/lines.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/live/ntrip_client.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using ::testing::HasSubstr;

TEST(LiveFixes, AreThoseOfARecordingWithItsDamageCounted) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::string recording =
      ppp::read_file(maploop::testing::real_data() / "gnss/parser_samples/F9T-L2-5min.ubx.gz");
  recording[recording.size() / 2] ^= 1;
  maploop::testing::TcpServer receiver;
  const sensors::HostClock clock;
  const auto source =
      listen_to_fixes(sensors::open_stream(receiver.endpoint()), from_seconds(0.05), clock);
  std::thread sending([&] {
    ASSERT_TRUE(receiver.answer());
    ASSERT_TRUE(receiver.send("$GNTXT,01,01,02,u-blox AG*4E\r\n" + recording));
    ASSERT_TRUE(receiver.send(recording.substr(0, 20'000)));  // these have been sent before
  });
  GnssFix fix;
  std::vector<GnssFix> found;
  for (int i = 0; i < 200 && found.size() < 299; ++i) {
    while (source->wait(fix, std::chrono::milliseconds(50))) found.push_back(fix);
  }
  sending.join();
  ASSERT_GE(found.size(), 298U);
  for (std::size_t i = 1; i < found.size(); ++i) {
    ASSERT_GT(found[i].stamp, found[i - 1].stamp);
    ASSERT_GT(found[i].available, found[i - 1].available);
    ASSERT_EQ(found[i].velocity_stamp, found[i].stamp);
    EXPECT_LT(found[i].velocity_enu.norm(), 0.1) << "it stands on a roof";
    EXPECT_GT(found[i].position_covariance.diagonal().minCoeff(), 0.0);
  }
  const sensors::LiveReport report = source->report();
  EXPECT_EQ(report.delivered, found.size());
  const std::string said = maploop::testing::all_of(report);
  for (const char* what : {"1 frames with a wrong checksum", "UBX frames", "last fix: "})
    EXPECT_THAT(said, HasSubstr(what));
}

TEST(LiveFixes, AreWhatUbxInTheConfigurationMeans) {
  VehicleConfig config;
  config.live.gnss = "udp://:" + std::to_string(maploop::testing::free_port());
  config.live.gnss_protocol = GnssProtocol::ubx;
  const LiveSensors sensors = open_live_sensors(config);
  EXPECT_TRUE(sensors.gnss);
  EXPECT_FALSE(sensors.epochs);
  EXPECT_FALSE(sensors.ppp);
}

}  // namespace
}  // namespace maploop::vehicle
