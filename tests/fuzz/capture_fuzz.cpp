// Captures of a network.
#include <exception>

#include "sensors/velodyne/capture_reader.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const maploop::fuzz::MemoryFile file(data, size);
  try {
    maploop::sensors::CaptureReader reader(file.path());
    unsigned sum = 0;
    for (maploop::sensors::CapturedPacket packet; reader.next(packet);) {
      for (const std::uint8_t b : packet.payload) sum += b;
    }
    volatile unsigned sink = sum;
    (void)sink;
  } catch (const std::runtime_error&) {
  }
  return 0;
}
