#include "runtime/vehicle/drivers/gnss_outage.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "msgs/gnss.h"

namespace maploop::vehicle {
namespace {

using ::testing::HasSubstr;

const Time first = from_nanoseconds(1'317'384'506'000'000'000);
const Time last = first + from_seconds(400.0);

double begin_of(const GnssOutage& o) {
  return to_seconds(o.begin - first);
}

TEST(GnssOutages, AreReadInOrder) {
  const auto outages = parse_outages("100:end,20:30", first, last, 1);
  ASSERT_EQ(outages.size(), 2u);
  EXPECT_EQ(begin_of(outages[0]), 20.0);
  EXPECT_EQ(to_seconds(outages[0].end - outages[0].begin), 30.0);
  EXPECT_EQ(outages[1].end, Time::max());
}

TEST(GnssOutages, DrawnAtRandomDependOnTheSeedAndDoNotMeet) {
  const auto once = parse_outages("random:4:60", first, last, 5);
  const auto again = parse_outages("random:4:60", first, last, 5);
  const auto other = parse_outages("random:4:60", first, last, 6);
  ASSERT_EQ(once.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(once[i].begin, again[i].begin);
    EXPECT_GE(begin_of(once[i]), 60.0);
    EXPECT_LE(once[i].end, last);
    if (i > 0) {
      EXPECT_GE(once[i].begin, once[i - 1].end);
    }
  }
  EXPECT_NE(once[0].begin, other[0].begin);
}

TEST(GnssOutages, ThatAreRepeatedLieAMinuteApartAndEndInTheDrive) {
  const auto outages = parse_outages("repeated:50:30", first, last, 1);
  std::vector<double> begins;
  for (const GnssOutage& o : outages) {
    begins.push_back(begin_of(o));
    EXPECT_EQ(to_seconds(o.end - o.begin), 30.0);
  }
  EXPECT_EQ(begins, (std::vector<double>{50, 140, 230, 320}));
}

TEST(GnssOutages, ThatAreInvalidNameTheWrongPart) {
  for (const char* text : {"", "20", "a:3", "20:-1", "20:0", "20:30:40", "random:0:60",
                           "random:3:end", "repeated:3:end", "repeated:3", "1:2,,3:4"}) {
    EXPECT_NE(check_outages(text), "") << text;
  }
  EXPECT_THAT(check_outages("random:a:60"), HasSubstr("'a' is not a count"));
  EXPECT_THAT(check_outages("20:b"), HasSubstr("'b' is not a number of seconds"));
  EXPECT_EQ(check_outages("20:30,random:2:60,300:end"), "");
  EXPECT_THROW(parse_outages("random:1:390", first, last, 1), std::invalid_argument);
  EXPECT_THROW(parse_outages("repeated:350:50", first, last, 1), std::invalid_argument);
  EXPECT_THROW(parse_outages("random:9:60", first, last, 1), std::invalid_argument);
}

TEST(GnssOutages, TakeTheFixesInsideAndNoOthers) {
  auto ten_fixes = sensors::made<GnssFix>([i = 0](GnssFix& fix, sensors::SourceReport&) mutable {
    fix.stamp = first + from_seconds(i);
    return i++ < 10;
  });
  const auto source =
      with_outages<GnssFix>(std::move(ten_fixes), parse_outages("2:3,8:end", first, last, 1));
  std::vector<double> seconds;
  for (GnssFix fix; source->next(fix);) seconds.push_back(to_seconds(fix.stamp - first));
  EXPECT_EQ(seconds, (std::vector<double>{0, 1, 5, 6, 7}));
}

}  // namespace
}  // namespace maploop::vehicle
