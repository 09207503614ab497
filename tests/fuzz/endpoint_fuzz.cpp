// Endpoints of sensors, as a user writes them.
#include <stdexcept>

#include "sensors/live/endpoint.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    maploop::sensors::parse_endpoint({reinterpret_cast<const char*>(data), size});
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
