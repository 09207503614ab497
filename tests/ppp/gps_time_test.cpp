#include "ppp/gps_time.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace maploop::ppp {
namespace {

using std::chrono::seconds;

TEST(GpsTime, WeekAndSecondsOfAKnownDay) {
  const GpsTime t = gps_time({2020, 6, 25, 0, 0, 30.0});
  EXPECT_EQ(gps_week(t), 2111);
  EXPECT_DOUBLE_EQ(seconds_of_week(t), 345630.0);
  EXPECT_EQ(gps_week_time(2111, 345630.0), t);
  EXPECT_EQ(format_gps_time(t), "2020-06-25 00:00:30.000");
}

TEST(GpsTime, UtcIsEighteenSecondsBehindIn2020) {
  const GpsTime t = gps_time({2020, 6, 25, 0, 0, 18.0});
  EXPECT_EQ(format_time(to_utc(t)).substr(0, 19), "2020-06-25 00:00:00");
  EXPECT_EQ(from_utc(to_utc(t)), t);
  EXPECT_FALSE(leap_seconds(t).out_of_date);
}

TEST(GpsTime, TheLastLeapSecondIsASecondLong) {
  const GpsTime before = gps_time({2017, 1, 1, 0, 0, 16.0});  // 23:59:59 UTC
  EXPECT_EQ(leap_seconds(before).gps_minus_utc, seconds(17));
  EXPECT_EQ(leap_seconds(before + seconds(2)).gps_minus_utc, seconds(18));
  EXPECT_EQ(to_utc(before + seconds(2)) - to_utc(before), seconds(1));
}

TEST(GpsTime, ReportsWhenTheTableIsOutOfDate) {
  EXPECT_TRUE(leap_seconds(leap_seconds_valid_until()).out_of_date);
  EXPECT_FALSE(leap_seconds(leap_seconds_valid_until() - seconds(1)).out_of_date);
}

TEST(GpsTime, SecondSixtyIsTheNextMinute) {
  EXPECT_EQ(gps_time({2021, 9, 22, 6, 29, 60.0}), gps_time({2021, 9, 22, 6, 30, 0.0}));
}

TEST(GpsTime, RefusesInvalidDates) {
  EXPECT_THROW(gps_time({2021, 2, 29, 0, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW(gps_time({2021, 1, 1, 0, 60, 0.0}), std::invalid_argument);
  EXPECT_THROW(gps_time({1980, 1, 5, 0, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW(gps_time({2021, 1, 1, 0, 0, -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace maploop::ppp
