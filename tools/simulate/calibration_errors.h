// What the calibration of a simulated car does not know.
#pragma once

#include <cstdint>

namespace maploop::simulate {

// px by column of an image: middle + slope x + bowl x^2, x from -1 at the left edge to 1 at the
// right one. Its mean over the columns is middle + bowl / 3.
struct ColumnShift {
  float middle = 0.0F, slope = 0.0F, bowl = 0.0F;

  float at(float column, float width) const {
    const float x = 2.0F * column / width - 1.0F;
    return middle + (slope + bowl * x) * x;
  }
  ColumnShift operator-() const { return {-middle, -slope, -bowl}; }
};

struct CalibrationErrors {
  ColumnShift disparity_lack;      // by how much disparities are too small
  float range_scale = 0.0F;        // 1, by how much the scanner's ranges are too long
  std::uint64_t scanner_unit = 1;  // which scanner: offsets and directions of its lasers
  // Of a scanner that nothing triggers: when its turn begins in each interval of the cameras at the
  // begin of the drive (s), and by how much longer than that interval its turn takes (1).
  double scanner_phase = 0.0, scanner_drift = 0.0;
};

// Of the car of a seed. Drive 0013 of KITTI is what the sizes come from:
// - disparities, against the depths that a LiDAR gives: 0.30 to 0.48 px too small in the mean,
//   0.67 px at the left edge, 0.0 at a third, 0.2 in the middle and 0.6 at the right edge
//   (estimators/lidar/README.md), which is a bowl of 0.5 px without slope. Here the mean is 0.30 to
//   0.48 px, the bowl 0.3 to 0.7, the slope -0.2 to 0.2.
// - ranges: 0.2 %, 1 sigma, either way. 0013's scanner says lengths 0.2 % longer than its inertial
//   unit; its maker states 2 cm, which is 0.2 % of the 10 m at which a street's surfaces are.
// The scanner's phase is anything; its turns are up to 200 ppm longer or shorter, two crystals of
// 100 ppm.
CalibrationErrors calibration_errors(std::uint64_t seed);

}  // namespace maploop::simulate
