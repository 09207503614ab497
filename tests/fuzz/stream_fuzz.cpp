// A receiver's stream, in pieces.
#include <cmath>

#include "ppp/readers/streams/receiver_stream.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  ReceiverStream stream(gps_week_time(2400, 0.0));
  Epoch epoch;
  while (!input.empty()) {
    stream.push(input.bytes(1 + input.byte()));
    while (stream.next(epoch)) {
      for (const SatelliteSignals& s : epoch.satellites) {
        fuzz::require(s.count > 0 && s.first + s.count <= epoch.signals.size());
        for (const Signal& signal : epoch.of(s)) {
          fuzz::require(std::isfinite(signal.code) && std::isfinite(signal.phase));
        }
      }
    }
    if (input.byte() == 0) stream.restart();
  }
  fuzz::require(stream.navigation().kepler.size() <= size);
  return 0;
}
