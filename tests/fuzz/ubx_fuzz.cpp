// Recordings of u-blox receivers, as they are and as the payload of a sound frame.
#include <cmath>
#include <string>

#include "ppp/readers/lines.h"
#include "ppp/readers/ubx.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

namespace {

void read(std::string_view bytes) {
  try {
    const Observations o = parse_ubx(bytes, "input");
    for (const Epoch& epoch : o.epochs) {
      for (const SatelliteSignals& s : epoch.satellites) {
        fuzz::require(s.count > 0 && s.first + s.count <= epoch.signals.size());
        for (const Signal& signal : epoch.of(s)) {
          fuzz::require(std::isfinite(signal.code) && std::isfinite(signal.phase) &&
                        std::isfinite(signal.doppler));
        }
      }
    }
  } catch (const ReadError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  read(bytes);
  const std::string_view payload = bytes.substr(0, 65535);
  std::string frame("\xb5\x62\x02\x15", 4);
  frame += static_cast<char>(payload.size() & 0xff);
  frame += static_cast<char>(payload.size() >> 8);
  frame += payload;
  unsigned a = 0, b = 0;
  for (std::size_t i = 2; i < frame.size(); ++i) {
    a = (a + static_cast<unsigned char>(frame[i])) & 0xff;
    b = (b + a) & 0xff;
  }
  frame += static_cast<char>(a);
  frame += static_cast<char>(b);
  read(frame + frame);
  return 0;
}
