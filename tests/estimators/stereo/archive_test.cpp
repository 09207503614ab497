// An odometry saved in the middle of the recorded drive continues with the same bits.
#include <gtest/gtest.h>

#include "estimators/stereo/stereo_odometry.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::stereo {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::load;
using maploop::testing::read_pairs;
using maploop::testing::refusal;
using maploop::testing::saved;

void expect_same_bits(const RelativeMotion& a, const RelativeMotion& b) {
  ArchiveWriter of_a, of_b;
  of_a(a);
  of_b(b);
  EXPECT_EQ(of_a.content(), of_b.content()) << "pair " << a.sequence;
}

class StereoArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    camera_ = sensors::KittiDrive(drive_0013()).calibration().stereo;
  }

  StereoCalibration camera_;
};

TEST_F(StereoArchive, ALoadedOdometryGoesOnWithTheSameBits) {
  const auto pairs = read_pairs(sensors::KittiDrive(drive_0013()));
  ASSERT_EQ(pairs.size(), 144u);
  StereoOdometry first(camera_, {});
  for (std::size_t i = 0; i < 72; ++i) first.process(pairs[i]);
  const Bytes archive = saved(first);
  EXPECT_LT(archive.size(), 1'100'000u);

  StereoOdometry second(camera_, {});
  second.process(pairs[3]);  // loading replaces its state
  load(archive, second);
  EXPECT_EQ(saved(second), archive);
  for (std::size_t i = 72; i < pairs.size(); ++i) {
    const RelativeMotion motion = first.process(pairs[i]);
    EXPECT_EQ(motion.status, OdometryStatus::ok);
    expect_same_bits(motion, second.process(pairs[i]));
  }
  EXPECT_EQ(first.disparity_offset(), second.disparity_offset());
  EXPECT_EQ(saved(first), saved(second));
}

TEST_F(StereoArchive, SavedBeforeTheFirstPairAndAfterARefusedOne) {
  auto pairs = read_pairs(sensors::KittiDrive(drive_0013()), 8);
  std::fill(pairs[4].left.pixels.begin(), pairs[4].left.pixels.end(), std::uint8_t{0});
  for (const std::size_t at : {0u, 1u, 5u}) {
    StereoOdometry first(camera_, {}), second(camera_, {});
    for (std::size_t i = 0; i < at; ++i) first.process(pairs[i]);
    load(saved(first), second);
    for (std::size_t i = at; i < pairs.size(); ++i) {
      expect_same_bits(first.process(pairs[i]), second.process(pairs[i]));
    }
  }
}

TEST_F(StereoArchive, RefusesOtherParametersAndAnotherCalibrationByName) {
  const StereoOdometry odometry(camera_, {});
  StereoParameters parameters;
  parameters.max_speed += 1.0;
  StereoOdometry other(camera_, parameters);
  EXPECT_NE(refusal(saved(odometry), other).find("max_speed = "), std::string::npos);
  StereoCalibration calibration = camera_;
  calibration.baseline *= 1.01;
  StereoOdometry another(calibration, {});
  EXPECT_NE(refusal(saved(odometry), another).find("another calibration"), std::string::npos);
}

TEST_F(StereoArchive, RefusesBrokenArchives) {
  StereoOdometry odometry(camera_, {});
  for (const StereoPair& pair : read_pairs(sensors::KittiDrive(drive_0013()), 5))
    odometry.process(pair);
  maploop::testing::expect_refuses_broken(saved(odometry), odometry);
}

}  // namespace
}  // namespace maploop::stereo
