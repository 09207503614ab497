// Tests the detection of slips of single cycles among the phases of a moving antenna.
#include "ppp/filter/phase_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace maploop::ppp {
namespace {

constexpr double cycle = 0.1903;  // m

// Makes the steps of satellites all over the sky. The antenna has moved by metres more than
// predicted, and its clock has stepped by a millisecond.
std::vector<PhaseStep> steps(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<PhaseStep> all;
  for (int i = 0; i < count; ++i) {
    const double azimuth = 2.0 * M_PI * (i + share(random)) / count;
    const double sine = 0.15 + 0.8 * share(random), cosine = std::sqrt(1.0 - sine * sine);
    PhaseStep s;
    s.to_satellite = {cosine * std::sin(azimuth), cosine * std::cos(azimuth), sine};
    const double noise = 0.004 * (2.0 * share(random) - 1.0);
    s.change = -s.to_satellite.dot(Eigen::Vector3d(3.0, -2.0, 0.4)) + 299792.458 + noise;
    s.limit = 0.052;
    all.push_back(s);
  }
  return all;
}

TEST(PhaseSteps, NoneWhereAllAreOneDisplacement) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    auto all = steps(9, seed);
    find_slips(all);
    for (const PhaseStep& s : all) EXPECT_FALSE(s.slipped);
  }
}

TEST(PhaseSteps, OneCycleOfOneSatellite) {
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    auto all = steps(9, seed);
    all[seed % 9].change += cycle;
    find_slips(all);
    bool right = true;
    for (std::size_t i = 0; i < all.size(); ++i) right &= all[i].slipped == (i == seed % 9);
    whole += right;
  }
  EXPECT_GE(whole, 48) << "in few skies another one hides it";
}

// At a corner many satellites slip together; they are found as long as most have not slipped.
TEST(PhaseSteps, ThreeSlipsAtOnceAmongTwelve) {
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    auto all = steps(12, seed);
    all[1].change += 2.0 * cycle;
    all[4].change -= cycle;
    all[8].change += 14.0 * cycle;
    find_slips(all);
    bool right = true;
    for (std::size_t i = 0; i < all.size(); ++i)
      right &= all[i].slipped == (i == 1 || i == 4 || i == 8);
    whole += right;
  }
  EXPECT_GE(whole, 48);
}

TEST(PhaseSteps, FiveStepsDoNotShowWhichOneIsWrong) {
  auto all = steps(5, 3);
  all[2].change += 3.0 * cycle;
  find_slips(all);
  for (const PhaseStep& s : all) EXPECT_FALSE(s.slipped);
  all.resize(3);
  find_slips(all);
  for (const PhaseStep& s : all) EXPECT_FALSE(s.slipped);
}

}  // namespace
}  // namespace maploop::ppp
