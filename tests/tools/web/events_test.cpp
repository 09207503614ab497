// Tests how moments become events of a timeline.
#include "tools/web/events.h"

#include <gtest/gtest.h>

namespace maploop::web {
namespace {

TEST(Events, MomentsOfOneKindThatFollowEachOtherAreOneEvent) {
  std::vector<Event> events;
  const Event warning{0, 0, Event::Level::warning, {}}, note{0, 0, Event::Level::note, {}};
  extend(events, 1.0, 0.5, warning).text = "first";
  EXPECT_EQ(extend(events, 1.5, 0.5, warning).text, "first");
  EXPECT_EQ(extend(events, 1.8, 0.5, note).text, "") << "of another level";
  EXPECT_EQ(extend(events, 3.0, 0.5, note).text, "") << "after a gap";
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].from, 1.0);
  EXPECT_EQ(events[0].to, 1.5);
  EXPECT_EQ(events[2].from, 3.0);
}

TEST(Events, AreSortedByTheirBeginning) {
  std::vector<Event> events{{2, 3, {}, "b"}, {1, 4, {}, "a"}, {2, 2, {}, "c"}};
  sort_by_time(events);
  EXPECT_EQ(events[0].text + events[1].text + events[2].text, "abc");
}

}  // namespace
}  // namespace maploop::web
