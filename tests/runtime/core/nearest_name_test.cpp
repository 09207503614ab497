#include "runtime/core/nearest_name.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace maploop::runtime {
namespace {

TEST(EditDistance, ByHand) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("rate", "raet"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "no letter is edited twice";
}

TEST(NearestName, ClosestOrNone) {
  const std::vector<std::string> names = {"deadline_ms", "rate_hz", "rate_max"};
  EXPECT_EQ(nearest_name("rate_h", names), "rate_hz");
  EXPECT_EQ(nearest_name("dedline_ms", names), "deadline_ms");
  EXPECT_EQ(nearest_name("colour", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
}  // namespace maploop::runtime
