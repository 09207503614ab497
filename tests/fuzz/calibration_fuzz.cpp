// Calibration files of Velodyne scanners.
#include <cmath>
#include <stdexcept>

#include "sensors/velodyne/lasers.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  try {
    const auto lasers =
        sensors::read_velodyne_calibration(file.path(), sensors::VelodyneModel::vlp16);
    fuzz::require(lasers.size() == 16);
    for (const auto& laser : lasers) fuzz::require(std::isfinite(laser.range_correction));
  } catch (const std::runtime_error&) {
  }
  return 0;
}
