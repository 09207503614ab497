// Tests a receiver's own solutions with a recording and with made frames.
#include "ppp/readers/streams/ubx_pvt.h"

#include <gtest/gtest.h>

#include <optional>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "ppp/readers/files/lines.h"
#include "tests/support/real_data.h"
#include "tests/support/ubx_frame.h"

namespace maploop::ppp {
namespace {

using maploop::testing::raw_bytes;
using maploop::testing::ubx_frame;

// The time is 2020-06-25 12:34:37.999999750 GPS time, 18 s ahead of UTC. The fields have different
// values.
struct MadePvt {
  std::uint32_t time_of_week = 390878'000;  // ms: Thursday, 12:34:38
  std::uint16_t year = 2020;
  std::uint8_t month = 6, day = 25, hour = 12, minute = 34, second = 20;
  std::uint8_t valid = 7;
  std::int32_t nanoseconds = -250;
  std::uint8_t kind = 3, flags = 1;
  std::uint32_t horizontal = 1500;
  std::int32_t latitude = 490'000'000;

  std::string payload() const {
    return raw_bytes(time_of_week) + raw_bytes(year) + raw_bytes(month) + raw_bytes(day) +
           raw_bytes(hour) + raw_bytes(minute) + raw_bytes(second) + raw_bytes(valid) +
           raw_bytes(std::uint32_t{20}) + raw_bytes(nanoseconds) + raw_bytes(kind) +
           raw_bytes(flags) + raw_bytes(std::uint8_t{0}) + raw_bytes(std::uint8_t{11}) +
           raw_bytes(std::int32_t{84'000'000}) + raw_bytes(latitude) +
           raw_bytes(std::int32_t{164'500}) + raw_bytes(std::int32_t{115'000}) +
           raw_bytes(horizontal) + raw_bytes(std::uint32_t{2500}) + raw_bytes(std::int32_t{3000}) +
           raw_bytes(std::int32_t{4000}) + raw_bytes(std::int32_t{-100}) +
           raw_bytes(std::int32_t{5000}) + raw_bytes(std::int32_t{0}) +
           raw_bytes(std::uint32_t{70}) + raw_bytes(std::uint32_t{0}) +
           raw_bytes(std::uint16_t{150}) + std::string(14, '\0');
  }
};

struct Decoded {
  std::optional<UbxPvt> pvt;
  std::string problem;
};

Decoded decoded(const std::string& payload) {
  const std::string bytes = ubx_frame(0x01, 0x07, payload);
  UbxFrames frames(bytes);
  UbxFrame frame;
  Decoded d;
  EXPECT_TRUE(frames.next(frame));
  UbxPvt pvt;
  if (decode_pvt(frame, pvt, d.problem)) d.pvt = pvt;
  return d;
}

TEST(UbxPvt, HasEveryQuantityInItsUnit) {
  const Decoded d = decoded(MadePvt{}.payload());
  ASSERT_TRUE(d.pvt && d.pvt->fix) << d.problem;
  EXPECT_EQ(d.problem, "");
  EXPECT_EQ(d.pvt->time, gps_time({2020, 6, 25, 12, 34, 38.0}) - Duration(250));
  EXPECT_NEAR(degrees(d.pvt->position.latitude), 49.0, 1e-12);
  EXPECT_NEAR(degrees(d.pvt->position.longitude), 8.4, 1e-12);
  EXPECT_DOUBLE_EQ(d.pvt->position.height, 164.5) << "above the ellipsoid, not the sea";
  EXPECT_EQ(d.pvt->velocity_enu, Eigen::Vector3d(4.0, 3.0, 0.1));
  EXPECT_EQ(d.pvt->horizontal_sigma, 1.5);
  EXPECT_EQ(d.pvt->vertical_sigma, 2.5);
  EXPECT_DOUBLE_EQ(d.pvt->speed_sigma, 0.07);
  EXPECT_EQ(d.pvt->satellites, 11);
}

TEST(UbxPvt, TheWeekBeginsEighteenSecondsBeforeUtcsDay) {
  const Decoded d = decoded(MadePvt{.time_of_week = 5000,
                                    .month = 6,
                                    .day = 27,
                                    .hour = 23,
                                    .minute = 59,
                                    .second = 47,
                                    .nanoseconds = 300'000}
                                .payload());
  ASSERT_TRUE(d.pvt) << d.problem;
  EXPECT_EQ(d.pvt->time, gps_time({2020, 6, 28, 0, 0, 5.0}) + Duration(300'000));
}

TEST(UbxPvt, WithoutAFixItHasOnlyATime) {
  for (const MadePvt& made : {MadePvt{.kind = 0}, MadePvt{.kind = 1}, MadePvt{.kind = 2},
                              MadePvt{.kind = 5}, MadePvt{.flags = 0}}) {
    const Decoded d = decoded(made.payload());
    ASSERT_TRUE(d.pvt);
    EXPECT_FALSE(d.pvt->fix);
    EXPECT_EQ(d.problem, "");
  }
}

TEST(UbxPvt, WithoutADateOrTimeThereIsNoSolution) {
  for (const MadePvt& made :
       {MadePvt{.valid = 0}, MadePvt{.valid = 1}, MadePvt{.valid = 2}, MadePvt{.valid = 4}}) {
    const Decoded d = decoded(made.payload());
    EXPECT_FALSE(d.pvt);
    EXPECT_EQ(d.problem, "") << "a receiver that has just begun";
  }
}

TEST(UbxPvt, RefusesInvalidTimesPositionsAndAccuracies) {
  EXPECT_NE(decoded(MadePvt{}.payload().substr(0, 84)).problem.find("84 bytes"), std::string::npos);
  for (const MadePvt& made :
       {MadePvt{.time_of_week = 604'800'000}, MadePvt{.month = 13}, MadePvt{.year = 1979}}) {
    const Decoded d = decoded(made.payload());
    EXPECT_FALSE(d.pvt);
    EXPECT_NE(d.problem.find("an invalid date or time of week"), std::string::npos);
  }
  for (const MadePvt& made : {MadePvt{.horizontal = 0}, MadePvt{.latitude = 1'000'000'000}}) {
    const Decoded d = decoded(made.payload());
    EXPECT_FALSE(d.pvt);
    EXPECT_NE(d.problem.find("an invalid position or accuracy"), std::string::npos);
  }
}

// Each message is followed by NAV-POSECEF and NAV-VELECEF of the same epoch, in centimetres.
TEST(UbxPvt, AgreesWithTheReceiversEarthFixedSolution) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string bytes =
      read_file(maploop::testing::real_data() / "gnss/parser_samples/F9T-L2-5min.ubx.gz");
  const auto in_metres = [](const UbxFrame& frame) -> Eigen::Vector3d {
    return 0.01 * Eigen::Vector3d(ubx_number<std::int32_t>(frame.payload, 4),
                                  ubx_number<std::int32_t>(frame.payload, 8),
                                  ubx_number<std::int32_t>(frame.payload, 12));
  };
  std::string problem;
  UbxPvt pvt;
  int fixes = 0, positions = 0, velocities = 0;
  UbxFrames frames(bytes);
  for (UbxFrame frame; frames.next(frame);) {
    if (decode_pvt(frame, pvt, problem)) fixes += pvt.fix;
    if (frame.message_class != 0x01 || (frame.id != 0x01 && frame.id != 0x11)) continue;
    EXPECT_NEAR(seconds_of_week(pvt.time), 1e-3 * ubx_number<std::uint32_t>(frame.payload, 0),
                1e-3);
    if (frame.id == 0x01) {
      ++positions;
      EXPECT_LT((ecef_from_geodetic(pvt.position) - in_metres(frame)).norm(), 0.02);
    } else {
      ++velocities;
      EXPECT_LT((rotation_enu_ecef(pvt.position).transpose() * pvt.velocity_enu - in_metres(frame))
                    .norm(),
                0.02);
    }
  }
  EXPECT_EQ(problem, "");
  EXPECT_EQ(fixes, 299);
  EXPECT_EQ(positions, 299);
  EXPECT_EQ(velocities, 299);
}

}  // namespace
}  // namespace maploop::ppp
