#include "msgs/time.h"

#include <gtest/gtest.h>

#include <cmath>

#include <stdexcept>

namespace maploop {
namespace {

TEST(Time, ReadsKittiStampsToTheNanosecond) {
  const Time t = parse_time("2011-09-26 13:10:51.174740992");
  EXPECT_EQ(to_nanoseconds(t), 1'317'042'651'174'740'992);
  EXPECT_EQ(format_time(t), "2011-09-26 13:10:51.174740992");
}

TEST(Time, TakesFewerFractionalDigits) {
  EXPECT_EQ(parse_time("2011-09-26 13:10:51.5"), parse_time("2011-09-26T13:10:51.500000000"));
  EXPECT_EQ(format_time(parse_time("1970-01-01 00:00:00")), "1970-01-01 00:00:00.000000000");
}

TEST(Time, BeforeTheEpoch) {
  EXPECT_EQ(format_time(from_nanoseconds(-1)), "1969-12-31 23:59:59.999999999");
}

TEST(Time, RefusesWhatIsNoStamp) {
  for (const char* text :
       {"", "2011-09-26", "2011-13-26 13:10:51", "2011-02-29 13:10:51", "2011-09-26 24:10:51",
        "2011-09-26 13:10:51.", "2011-09-26 13:10:51.1234567890", "2011-09-26 13:10:51.12x",
        "2011-09-26 13:1a:51", "  2011-09-26 13:10:51"}) {
    EXPECT_THROW(parse_time(text), std::invalid_argument) << text;
  }
}

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1e-9).count(), 1);
  EXPECT_EQ(from_seconds(-0.06).count(), -60'000'000);
  EXPECT_DOUBLE_EQ(to_seconds(from_seconds(0.1)), 0.1);
}

TEST(Time, SecondsOfAFileMustBeWithinWhatATimeHolds) {
  EXPECT_EQ(checked_seconds(-0.06).count(), -60'000'000);
  EXPECT_EQ(Time(checked_seconds(7.2e9)), parse_time("2198-02-27 08:00:00"));
  for (const double seconds : {1e300, -7.3e9, 9.2e9, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(checked_seconds(seconds), std::invalid_argument) << seconds;
  }
}

}  // namespace
}  // namespace maploop
