// An Xsens unit's messages, in pieces.
#include <cmath>

#include "sensors/imu/xsens.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop::sensors;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  maploop::fuzz::Input input(data, size);
  XsensDecoder decoder;
  XsensSample sample;
  while (!input.empty()) {
    auto bytes = input.bytes(1 + input.byte());
    while (decoder.next(bytes, sample)) {
      for (int i = 0; i < 3; ++i) {
        maploop::fuzz::require(std::abs(sample.specific_force[i]) <= 500.0);
        maploop::fuzz::require(std::abs(sample.rate[i]) <= 100.0);
      }
    }
  }
  return 0;
}
