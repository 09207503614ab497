// The odometry must report each odd pair, made from the recorded drive, with a named status or
// condition. It must never return a wild pose, and must continue afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "estimators/stereo/stereo_odometry.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/real_data.h"

namespace maploop::stereo {
namespace {

using maploop::testing::drive_0013;

class OddPairs : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    const sensors::KittiDrive drive(drive_0013());
    camera_ = drive.calibration().stereo;
    pairs_ = maploop::testing::read_pairs(drive, 12);
    ASSERT_EQ(pairs_.size(), 12u);
  }

  std::vector<RelativeMotion> run(const std::vector<StereoPair>& pairs) const {
    StereoOdometry odometry(camera_, {});
    std::vector<RelativeMotion> motions;
    for (const StereoPair& pair : pairs) motions.push_back(odometry.process(pair));
    return motions;
  }

  static void expect_refused(const RelativeMotion& motion, OdometryStatus status) {
    EXPECT_EQ(motion.status, status) << to_string(motion.status);
    EXPECT_TRUE(motion.translation.isZero());
    EXPECT_TRUE(motion.covariance.isZero());
  }

  // The speed of the drive is 10.5 to 12 m/s.
  static void expect_drives(const RelativeMotion& motion, double pairs) {
    ASSERT_EQ(motion.status, OdometryStatus::ok) << to_string(motion.status);
    EXPECT_NEAR(motion.translation.x(), 1.17 * pairs, 0.12 * pairs);
    EXPECT_LT(motion.translation.tail<2>().norm(), 0.1 * pairs);
  }

  // Adds the sensor's noise, so that two images of a standing car differ.
  static void add_noise(StereoPair* pair, unsigned seed) {
    std::mt19937 random(seed);
    for (GreyImage* image : {&pair->left, &pair->right})
      for (std::uint8_t& grey : image->pixels)
        grey = static_cast<std::uint8_t>(
            std::clamp(static_cast<int>(grey) + static_cast<int>(random() % 5) - 2, 0, 255));
  }

  static void scale_brightness(StereoPair* pair, double factor) {
    for (GreyImage* image : {&pair->left, &pair->right})
      for (std::uint8_t& grey : image->pixels)
        grey = static_cast<std::uint8_t>(std::lround(grey * factor));
  }

  // Adds a lorry alongside: the part of the image above the road shows that of the first pair,
  // moved by `shift` columns.
  void paste_lorry(StereoPair* pair, int shift) const {
    const int last_row = 250, first_column = 300, last_column = 1100;
    const auto paste = [&](const GreyImage& from, GreyImage* to) {
      for (int y = 0; y < last_row; ++y)
        for (int x = first_column; x < last_column; ++x) {
          const int source = std::clamp(x - shift, 0, from.width - 1);
          to->pixels[static_cast<std::size_t>(y * to->width + x)] =
              from.pixels[static_cast<std::size_t>(y * from.width + source)];
        }
    };
    paste(pairs_[0].left, &pair->left);
    paste(pairs_[0].right, &pair->right);
  }

  StereoCalibration camera_;
  std::vector<StereoPair> pairs_;
};

TEST_F(OddPairs, Standstill) {
  std::vector<StereoPair> pairs = pairs_;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].left = pairs_[0].left;
    pairs[i].right = pairs_[0].right;
    add_noise(&pairs[i], static_cast<unsigned>(i));
  }
  const auto motions = run(pairs);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    ASSERT_EQ(motions[i].status, OdometryStatus::ok) << "pair " << i;
    EXPECT_EQ(motions[i].condition, OdometryCondition::standstill) << "pair " << i;
    EXPECT_LT(motions[i].translation.norm(), 0.02) << "pair " << i;
    EXPECT_LT(motions[i].parallax, 0.3) << "pair " << i;
    EXPECT_GT(motions[i].covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST_F(OddPairs, DrivingIsNoStandstill) {
  const auto motions = run(pairs_);
  for (std::size_t i = 1; i < motions.size(); ++i) {
    expect_drives(motions[i], 1.0);
    EXPECT_EQ(motions[i].condition, OdometryCondition::ordinary) << "pair " << i;
    EXPECT_GT(motions[i].parallax, 1.0) << "pair " << i;
  }
}

TEST_F(OddPairs, Night) {
  std::vector<StereoPair> pairs = pairs_;
  for (std::size_t i = 5; i < 7; ++i) scale_brightness(&pairs[i], 0.02);
  const auto motions = run(pairs);
  expect_refused(motions[5], OdometryStatus::too_dark);
  expect_refused(motions[6], OdometryStatus::too_dark);
  EXPECT_EQ(motions[7].from, pairs[4].stamp);
  expect_drives(motions[7], 3.0);
  EXPECT_EQ(motions[7].condition, OdometryCondition::after_gap);
  expect_drives(motions[8], 1.0);
  EXPECT_EQ(motions[8].condition, OdometryCondition::ordinary);
}

TEST_F(OddPairs, MovingObjectsDominate) {
  std::vector<StereoPair> pairs = pairs_;
  for (std::size_t i = 5; i < pairs.size(); ++i)
    paste_lorry(&pairs[i], 6 * static_cast<int>(i - 4));
  const auto motions = run(pairs);
  expect_drives(motions[4], 1.0);
  EXPECT_EQ(motions[6].status, OdometryStatus::moving_objects) << to_string(motions[6].status);
  for (std::size_t i = 5; i < pairs.size(); ++i)
    if (motions[i].status == OdometryStatus::ok) expect_drives(motions[i], 1.0);
}

TEST_F(OddPairs, DroppedFrame) {
  std::vector<StereoPair> pairs = pairs_;
  pairs.erase(pairs.begin() + 5);
  const auto motions = run(pairs);
  EXPECT_EQ(motions[5].from, pairs_[4].stamp);
  expect_drives(motions[5], 2.0);
  EXPECT_EQ(motions[5].condition, OdometryCondition::after_gap);
  EXPECT_EQ(motions[6].condition, OdometryCondition::ordinary);
}

TEST_F(OddPairs, OddFromTheStartAllAreRefusedByName) {
  std::vector<StereoPair> dark = pairs_, swapped = pairs_;
  for (StereoPair& pair : dark) scale_brightness(&pair, 0.02);
  for (StereoPair& pair : swapped) std::swap(pair.left, pair.right);
  for (const RelativeMotion& motion : run(dark)) expect_refused(motion, OdometryStatus::too_dark);
  for (const RelativeMotion& motion : run(swapped))
    expect_refused(motion, OdometryStatus::swapped_images);
}

TEST_F(OddPairs, OneAloneIsRefusedByNameAndTheNextMotionCoversIt) {
  const auto snow = [](StereoPair& pair) {  // covers the windscreen except for a small hole
    for (GreyImage* image : {&pair.left, &pair.right})
      for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x)
          if (std::abs(x - 600) > 60 || std::abs(y - 180) > 60)
            image->pixels[static_cast<std::size_t>(y * image->width + x)] = 200;
  };
  struct Odd {
    const char* what;
    OdometryStatus status;
    std::function<void(StereoPair&)> spoil;
  };
  for (const Odd& odd : {
           Odd{"few features", OdometryStatus::too_few_features, snow},
           Odd{"repeated pair", OdometryStatus::repeated_image,
               [&](StereoPair& pair) {
                 pair.left = pairs_[4].left;
                 pair.right = pairs_[4].right;
               }},
           Odd{"one camera that sends its image again", OdometryStatus::repeated_image,
               [&](StereoPair& pair) { pair.right = pairs_[4].right; }},
           Odd{"swapped images", OdometryStatus::swapped_images,
               [](StereoPair& pair) { std::swap(pair.left, pair.right); }},
       }) {
    SCOPED_TRACE(odd.what);
    std::vector<StereoPair> pairs(pairs_.begin(), pairs_.begin() + 8);
    odd.spoil(pairs[5]);
    const auto motions = run(pairs);
    expect_refused(motions[5], odd.status);
    EXPECT_EQ(motions[6].from, pairs[4].stamp);
    expect_drives(motions[6], 2.0);
  }
}

}  // namespace
}  // namespace maploop::stereo
