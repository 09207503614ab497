// The errors that the calibration files of a simulated car have.
#pragma once

#include <cstdint>

namespace maploop::simulate {

// Shift in px of an image column: middle + slope x + bowl x^2, with x from -1 at the left edge to 1
// at the right edge. The mean over the columns is middle + bowl / 3.
struct ColumnShift {
  float middle = 0.0F, slope = 0.0F, bowl = 0.0F;

  float at(float column, float width) const {
    const float x = 2.0F * column / width - 1.0F;
    return middle + (slope + bowl * x) * x;
  }
  ColumnShift operator-() const { return {-middle, -slope, -bowl}; }
};

struct CalibrationErrors {
  ColumnShift disparity_lack;      // px, by which disparities are too small
  float range_scale = 0.0F;        // 1, share by which the scanner's ranges are too long
  std::uint64_t scanner_unit = 1;  // seeds the offsets and directions of the scanner's lasers
  // For a scanner that is not triggered by the cameras: when its turn begins within the cameras'
  // interval at the start of the drive (s), and by which share a turn takes longer than that
  // interval.
  double scanner_phase = 0.0, scanner_drift = 0.0;
};

// Draws the errors of a car from a seed. The sizes come from KITTI's drive 0013:
// - Disparities, compared with the depths of a LiDAR, are 0.30 to 0.48 px too small in the mean:
//   0.67 px at the left edge, 0.0 at a third, 0.2 in the middle and 0.6 at the right edge
//   (estimators/lidar/FIGURES.md). This is a bowl of 0.5 px without slope. Here the mean is 0.30 to
//   0.48 px, the bowl 0.3 to 0.7, the slope -0.2 to 0.2.
// - Ranges are wrong by 0.2 %, 1 sigma, in either direction. The scanner of 0013 measures lengths
//   0.2 % longer than its inertial unit; its maker states 2 cm, which is 0.2 % of the 10 m at which
//   a street's surfaces are.
// The scanner's phase is uniform in [0, 0.1) s; its turns are up to 200 ppm longer or shorter, as
// for two crystals of 100 ppm.
CalibrationErrors calibration_errors(std::uint64_t seed);

}  // namespace maploop::simulate
