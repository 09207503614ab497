#include "mapmatch/osm_tags.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace maploop::mapmatch {
namespace {

std::optional<Road> road(const std::map<std::string, std::string>& tags) {
  return road_from_tags(1, [&](const char* key) {
    const auto found = tags.find(key);
    return found == tags.end() ? std::string_view() : std::string_view(found->second);
  });
}

TEST(OsmTags, OnlyDrivableWaysAreRoads) {
  EXPECT_TRUE(road({{"highway", "residential"}}));
  EXPECT_FALSE(road({{"highway", "footway"}}));
  EXPECT_FALSE(road({{"highway", "construction"}}));
  EXPECT_FALSE(road({{"building", "yes"}}));
  EXPECT_FALSE(road({{"highway", "service"}, {"area", "yes"}}));
}

TEST(OsmTags, OneWaySaidAndImplied) {
  const auto directions = [](const std::map<std::string, std::string>& tags) {
    const Road r = *road(tags);
    return std::pair(r.forward, r.backward);
  };
  const std::pair both(true, true), with(true, false), against(false, true);
  EXPECT_EQ(directions({{"highway", "primary"}}), both);
  EXPECT_EQ(directions({{"highway", "primary"}, {"oneway", "yes"}}), with);
  EXPECT_EQ(directions({{"highway", "primary"}, {"oneway", "-1"}}), against);
  EXPECT_EQ(directions({{"highway", "motorway"}}), with);
  EXPECT_EQ(directions({{"highway", "motorway"}, {"oneway", "no"}}), both);
  EXPECT_EQ(directions({{"highway", "tertiary"}, {"junction", "roundabout"}}), with);
}

TEST(OsmTags, TheMostSpecificAccessTagDecides) {
  EXPECT_TRUE(road({{"highway", "service"}, {"access", "private"}})->restricted);
  EXPECT_FALSE(road({{"highway", "service"}, {"access", "no"}, {"motorcar", "yes"}})->restricted);
  EXPECT_TRUE(road({{"highway", "track"}, {"motor_vehicle", "agricultural"}})->restricted);
}

TEST(OsmTags, AttributesAndOddValues) {
  const Road r = *road({{"highway", "trunk"},
                        {"bridge", "viaduct"},
                        {"tunnel", "no"},
                        {"layer", "1"},
                        {"lanes", "2;3"},
                        {"maxspeed", "30 mph"},
                        {"ref", "B 3"}});
  EXPECT_TRUE(r.bridge);
  EXPECT_FALSE(r.tunnel);
  EXPECT_EQ(r.layer, 1);
  EXPECT_EQ(r.lanes, 2);
  EXPECT_NEAR(r.speed_limit, 13.4, 0.1);
  EXPECT_EQ(r.name, "B 3");
  EXPECT_EQ(road({{"highway", "road"}, {"layer", "1e99"}})->layer, 9);
  EXPECT_EQ(road({{"highway", "road"}, {"lanes", "-3"}})->lanes, 0);
  EXPECT_EQ(road({{"highway", "road"}, {"lanes:forward", "2"}})->lanes_forward, 2);
  EXPECT_EQ(road({{"highway", "road"}, {"lanes:backward", "1"}})->lanes_backward, 1);
  EXPECT_EQ(road({{"highway", "road"}, {"width", "7.5 m"}})->width, 7.5);
  EXPECT_NEAR(parse_width("20 ft"), 6.096, 1e-9);
  EXPECT_NEAR(parse_width("20'"), 6.096, 1e-9);
  for (const char* no_width : {"", "narrow", "-3", "1000", "nan", "0"})
    EXPECT_EQ(parse_width(no_width), 0.0) << no_width;
  EXPECT_EQ(parse_speed_limit("none"), 0.0);
  EXPECT_EQ(parse_speed_limit("DE:urban"), 0.0);
  EXPECT_EQ(parse_speed_limit("nan"), 0.0);
  EXPECT_EQ(parse_speed_limit("99999"), 0.0);
  EXPECT_NEAR(parse_speed_limit("50"), 13.889, 1e-3);
  EXPECT_NEAR(parse_speed_limit("walk"), 1.94, 0.01);
}

}  // namespace
}  // namespace maploop::mapmatch
