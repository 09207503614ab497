#include "runtime/core/latest_value.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace maploop::runtime {
namespace {

TEST(LatestValue, NothingPublishedIsNull) {
  LatestValue<int> cell;
  EXPECT_EQ(cell.latest(), nullptr);
  cell.back() = 3;
  EXPECT_EQ(cell.latest(), nullptr) << "filled, not published";
}

TEST(LatestValue, EachValueIsReadOnce) {
  LatestValue<int> cell;
  for (int i = 0; i < 10; ++i) {
    cell.back() = i;
    cell.publish();
    const int* value = cell.latest();
    ASSERT_NE(value, nullptr);
    EXPECT_EQ(*value, i);
    EXPECT_EQ(cell.latest(), nullptr);
  }
}

TEST(LatestValue, NewestWins) {
  LatestValue<int> cell;
  for (int i = 0; i < 5; ++i) {
    cell.back() = i;
    cell.publish();
  }
  EXPECT_EQ(*cell.latest(), 4);
  EXPECT_EQ(cell.latest(), nullptr);
}

TEST(LatestValue, WhatTheReaderHoldsIsNeverWrittenTo) {
  LatestValue<int> cell;
  cell.back() = 1;
  cell.publish();
  const int* held = cell.latest();
  for (int i = 2; i < 20; ++i) {
    EXPECT_NE(&cell.back(), held);
    cell.back() = i;
    cell.publish();
    EXPECT_EQ(*held, 1);
  }
  EXPECT_EQ(*cell.latest(), 19);
}

TEST(LatestValue, BuffersAreReused) {
  LatestValue<std::vector<int>> cell;
  std::set<const int*> seen;
  for (int i = 0; i < 50; ++i) {
    cell.back().assign(100, i);
    seen.insert(cell.back().data());
    cell.publish();
    if (i % 3 == 0) cell.latest();
  }
  EXPECT_LE(seen.size(), 3u);
}

}  // namespace
}  // namespace maploop::runtime
