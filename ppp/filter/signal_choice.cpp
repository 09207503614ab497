#include "ppp/filter/signal_choice.h"

namespace maploop::ppp {

void choose_signals(const Epoch& epoch, const RangeInputs& inputs, const PppParameters& parameters,
                    std::vector<Measurement>& measured, std::vector<SatelliteReport>& reports) {
  measured.clear();
  reports.clear();
  for (const SatelliteSignals& s : epoch.satellites) {
    if (parameters.systems.find(letter(s.satellite.system)) == std::string::npos) continue;
    SatelliteReport& report = reports.emplace_back();
    report.satellite = s.satellite;
    auto m =
        measure(s.satellite, epoch.of(s), inputs.glonass_channels, *inputs.ephemeris, epoch.time);
    if (!m) {
      report.refused = PppRefusal::no_signals;
      continue;
    }
    report.cn0 = m->first.cn0;
    if (report.cn0 > 0.0 && report.cn0 < parameters.cn0_mask) {
      report.refused = PppRefusal::weak;
      continue;
    }
    m->report = reports.size() - 1;
    measured.push_back(*m);
  }
}

}  // namespace maploop::ppp
