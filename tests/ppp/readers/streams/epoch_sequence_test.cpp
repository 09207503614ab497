// Tests which epochs are kept where their dates contradict each other.
#include "ppp/readers/streams/epoch_sequence.h"

#include <gtest/gtest.h>

#include <numeric>

namespace maploop::ppp {
namespace {

// Returns the seconds of the epochs that are kept.
std::vector<int> kept(const std::vector<int>& seconds) {
  Observations observations;
  const Lines lines("", "o");
  EpochSequence sequence(observations, lines);
  const GpsTime begin = gps_time({2021, 1, 1, 0, 0, 0.0});
  for (const int s : seconds) {
    Epoch epoch;
    epoch.time = begin + std::chrono::seconds(s);
    sequence.add(epoch);
  }
  sequence.finish();
  std::vector<int> result;
  for (const Epoch& epoch : observations.epochs)
    result.push_back(static_cast<int>(to_seconds(epoch.time - begin)));
  EXPECT_EQ(static_cast<int>(seconds.size() - result.size()), observations.refused);
  return result;
}

constexpr int later = 1'000'000;

std::vector<int> range(int first, int count) {
  std::vector<int> seconds(static_cast<std::size_t>(count));
  std::iota(seconds.begin(), seconds.end(), first);
  return seconds;
}

std::vector<int> joined(const std::vector<std::vector<int>>& parts) {
  std::vector<int> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(EpochSequence, SeveralWrongDatesAtTheStartAreRefused) {
  EXPECT_EQ(kept(joined({range(later, 5), range(0, 20)})), range(0, 20));
}

TEST(EpochSequence, SeveralWrongDatesInTheMiddleAreRefused) {
  EXPECT_EQ(kept(joined({range(0, 10), range(later, 5), range(10, 20)})), range(0, 30));
}

TEST(EpochSequence, WrongDatesInThePastAreRefused) {
  EXPECT_EQ(kept(joined({range(0, 10), range(-later, 5), range(10, 20)})), range(0, 30));
}

TEST(EpochSequence, RepeatedEpochsAreRefused) {
  EXPECT_EQ(kept({0, 1, 1, 2, 2, 3}), range(0, 4));
  EXPECT_EQ(kept(joined({range(0, 10), range(5, 10)})), range(0, 15));
}

TEST(EpochSequence, TheLongerRunWinsAtTheEndToo) {
  EXPECT_EQ(kept({0, 1, later, 2, 3}), range(0, 4));
  EXPECT_EQ(kept({0, 1, 2, 3, 1}), range(0, 4));
}

}  // namespace
}  // namespace maploop::ppp
