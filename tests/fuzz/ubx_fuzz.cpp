// Recordings of u-blox receivers, as they are and as the payload of a sound frame.
#include <cmath>
#include <string>

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/ubx.h"
#include "ppp/readers/streams/ubx_pvt.h"
#include "ppp/readers/streams/ubx_subframes.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/ubx_frame.h"

using namespace maploop;
using namespace maploop::ppp;

namespace {

void read(std::string_view bytes) {
  try {
    NavigationFile navigation;
    const Observations o = parse_ubx(bytes, "input", &navigation);
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
  // An epoch tells the week of the subframes behind it.
  const std::string_view payload = bytes.substr(0, 65535);
  const std::string epoch = maploop::testing::ubx_frame(0x02, 0x15, payload);
  read(epoch + epoch + maploop::testing::ubx_frame(0x02, 0x13, payload) + epoch);
  SubframeCollector collector;
  NavigationFile navigation;
  const std::string subframe = maploop::testing::ubx_frame(0x02, 0x13, payload);
  UbxFrames frames(subframe);
  for (UbxFrame frame; frames.next(frame);)
    collector.add(frame, gps_week_time(2379, 0.0), navigation);
  const std::string solution = maploop::testing::ubx_frame(0x01, 0x07, payload.substr(0, 92));
  UbxFrames solutions(solution);
  std::string problem;
  UbxPvt pvt;
  for (UbxFrame frame; solutions.next(frame);) {
    if (!decode_pvt(frame, pvt, problem)) continue;
    fuzz::require(std::abs(pvt.position.latitude) < 1.6 && pvt.velocity_enu.allFinite());
    fuzz::require(pvt.fix == (pvt.horizontal_sigma > 0.0));
  }
  return 0;
}
