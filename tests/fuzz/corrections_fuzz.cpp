// A stream of corrections, in pieces; and the payload of a sound message of them.
#include <cmath>

#include "ppp/products/ssr_electrons.h"
#include "ppp/readers/corrections/correction_stream.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const GpsTime now = gps_week_time(2400, 0.0);
  fuzz::Input input(data, size);
  CorrectionStream stream(now);
  while (!input.empty()) stream.push(input.bytes(1 + input.byte()));
  if (size < 2) return 0;
  constexpr int numbers[] = {1057, 1058, 1059, 1060, 1061, 1062, 1063, 1068,
                             1240, 1242, 1243, 1246, 1258, 1264, 1265, 4076};
  const std::string_view payload(reinterpret_cast<const char*>(data + 1), size - 1);
  std::vector<SsrUpdate> updates;
  std::optional<SsrIonosphere> ionosphere;
  const SsrResult result =
      decode_ssr({numbers[data[0] % 16], payload, 0}, now, updates, ionosphere);
  fuzz::require(result == SsrResult::decoded || updates.empty());
  fuzz::require(updates.size() <= 63);
  for (const SsrUpdate& u : updates) {
    fuzz::require(u.satellite.number > 0 && u.satellite.number <= 63 && u.biases.size() <= 31);
    fuzz::require(u.phase_biases.size() <= 31);
    fuzz::require(std::abs(to_seconds(u.time - now)) <= 4 * 86400.0);
    fuzz::require(!u.sigma || std::isfinite(*u.sigma));
  }
  if (ionosphere) {
    fuzz::require(result == SsrResult::decoded && updates.empty());
    SsrElectrons electrons;
    const GpsTime t = ionosphere->time;
    electrons.set(std::move(*ionosphere));
    const auto above = electrons.at({0.8, 0.1}, t);
    fuzz::require(above && std::isfinite(above->value) && above->sigma > 0.0);
  }
  return 0;
}
