// RINEX, CRINEX, SP3, clocks, ANTEX, Bias-SINEX, DCB, earth rotation, ocean loading, IONEX, ORBEX:
// what the begin of the text says.
#include <cmath>

#include "ppp/gnss_files.h"
#include "ppp/models/antenna.h"
#include "ppp/products/ionosphere_maps.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  GnssFiles files;
  try {
    parse_into(input.text(), "input", files);
  } catch (const ReadError&) {
    return 0;
  }
  for (const Observations& o : files.observations)
    for (const Epoch& epoch : o.epochs)
      for (const SatelliteSignals& s : epoch.satellites)
        fuzz::require(s.first + s.count <= epoch.signals.size());
  for (const OrbitFile& o : files.orbits)
    for (const auto& [satellite, points] : o.points)
      fuzz::require(points.size() == o.epochs.size());
  for (const AntennaFile& file : files.antennas)
    for (const Antenna& antenna : file.antennas)
      for (const PhaseCentre& carrier : antenna.carriers)
        for (const double angle : {-3.2, 0.0, 0.7, 3.2, 7.0})
          (void)phase_variation(antenna, carrier, std::abs(angle), angle);
  const IonosphereMaps maps(files.ionosphere_maps);
  for (const IonosphereMapFile& file : files.ionosphere_maps) {
    for (const IonosphereMap& map : file.maps) {
      for (const double longitude : {-7.0, 0.1, 3.1}) (void)maps.at({0.7, longitude}, map.time);
    }
  }
  return 0;
}
