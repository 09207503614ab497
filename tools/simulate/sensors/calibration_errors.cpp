#include "tools/simulate/sensors/calibration_errors.h"

#include "tools/simulate/random.h"

namespace maploop::simulate {

CalibrationErrors calibration_errors(std::uint64_t seed) {
  Random random(seed, 32);
  CalibrationErrors errors;
  const float mean = random.uniform_float(0.30, 0.48);
  ColumnShift& lack = errors.disparity_lack;
  lack.slope = random.uniform_float(-0.2, 0.2);
  lack.bowl = random.uniform_float(0.3, 0.7);
  lack.middle = mean - lack.bowl / 3.0F;
  errors.range_scale = static_cast<float>(0.002 * random.normal());
  errors.scanner_unit = random.bits();
  errors.scanner_phase = random.uniform(0.0, 0.1);
  errors.scanner_drift = random.uniform(-200e-6, 200e-6);
  return errors;
}

}  // namespace maploop::simulate
