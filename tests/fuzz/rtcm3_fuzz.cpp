// RTCM 3 streams, as they are and as the payload of a sound frame.
#include <cmath>
#include <string>

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/rtcm3.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    NavigationFile navigation;
    parse_rtcm3(bytes, "input", &navigation);
  } catch (const ReadError&) {
  }
  if (size < 1) return 0;
  Rtcm3Message message{1070 + data[0] % 60, bytes.substr(1), 0};
  MsmDecoder decoder(gps_week_time(2400, 0.0));
  Epoch epoch;
  std::string problem;
  if (!decoder.decode(message, epoch, problem) && !decoder.finish(epoch)) return 0;
  for (const SatelliteSignals& s : epoch.satellites) {
    fuzz::require(s.count > 0 && s.first + s.count <= epoch.signals.size());
    for (const Signal& signal : epoch.of(s)) {
      fuzz::require(std::isfinite(signal.code) && std::isfinite(signal.phase) &&
                    std::isfinite(signal.doppler));
    }
  }
  return 0;
}
