#include "ppp/filter/measurement.h"

#include <cmath>

namespace maploop::ppp {
namespace {

// Lists the attributes of a band in the order of preference; the signal that clocks refer to comes
// first.
std::string_view preference(System system, char band) {
  switch (system) {
    case System::gps:
      return band == '5' ? "QXI" : "WPCLXSYMN";
    case System::glonass:
      return "PC";
    case System::galileo:
      return "CXQBAI";
    case System::beidou:
      return "IXQDP";
    case System::qzss:
      return "CLXSZ";
    default:
      return "CXI";
  }
}

bool measured(double value) {
  return value != 0.0 && std::isfinite(value);
}

// Returns the carrier of a band; its frequency is 0 if it has no code or no known frequency.
Carrier carrier_of(Satellite satellite, char band, std::span<const Signal> signals,
                   double frequency) {
  Carrier c;
  const Signal *code = nullptr, *phase = nullptr;
  for (const char attribute : preference(satellite.system, band)) {
    for (const Signal& s : signals) {
      if (s.band != band || s.attribute != attribute) continue;
      if (!code && measured(s.code)) code = &s;
      if (!phase && measured(s.phase) && !s.half_cycle) phase = &s;
    }
  }
  if (!code || frequency <= 0.0) return c;
  c.band = band;
  c.attribute = code->attribute;
  c.frequency = frequency;
  c.wavelength = speed_of_light / frequency;
  c.code = code->code;
  c.cn0 = code->cn0;
  if (phase) {
    c.phase = phase->phase * c.wavelength;
    c.phase_attribute = phase->attribute;
    c.lost_lock = phase->lost_lock;
    c.doppler = phase->doppler;
    c.cn0 = phase->cn0 > 0.0 ? phase->cn0 : c.cn0;
  }
  if (c.doppler == 0.0) c.doppler = code->doppler;
  if (!measured(c.doppler)) c.doppler = 0.0;
  if (!measured(c.cn0)) c.cn0 = 0.0;
  return c;
}

}  // namespace

double ionosphere_factor(const Carrier& carrier) {
  const double ratio = carrier_frequency(System::gps, '1') / carrier.frequency;
  return ratio * ratio;
}

std::array<double, 2> Measurement::weights(Combination c) const {
  if (!dual()) return {1.0, 0.0};  // (2) of METHOD.md
  // (1) of METHOD.md
  return c == Combination::range ? std::array{0.5, 0.5} : std::array{-0.5, 0.5};
}

double Measurement::code(Combination c) const {
  const auto [a, b] = weights(c);
  return a * first.code + b * second.code;
}

double Measurement::phase(Combination c) const {
  const auto [a, b] = weights(c);
  return a * first.phase + b * second.phase;
}

double Measurement::ionosphere(Combination c) const {
  const auto [a, b] = weights(c);
  return a * ionosphere_factor(first) + (dual() ? b * ionosphere_factor(second) : 0.0);
}

double Measurement::ionosphere_free_weight() const {
  return -ionosphere(Combination::range) / ionosphere(Combination::ionosphere);
}

double Measurement::sigma(Combination c, double own, double common) const {
  const auto [a, b] = weights(c);
  return std::hypot(own * std::hypot(a, b), common * (a + b));  // (10) of METHOD.md
}

double Measurement::wide_lane() const {
  // (18) of METHOD.md
  const double f1 = first.frequency, f2 = second.frequency;
  return (f1 * first.phase - f2 * second.phase) / (f1 - f2) -
         (f1 * first.code + f2 * second.code) / (f1 + f2);
}

double Measurement::wide_lane_length() const {
  return speed_of_light / (first.frequency - second.frequency);
}

std::optional<Measurement> measure(Satellite satellite, std::span<const Signal> signals,
                                   const std::array<std::optional<int>, 100>& glonass_channels,
                                   const Ephemeris& ephemeris, GpsTime t) {
  const auto bands = bands_of(satellite.system);
  std::optional<int> channel;
  if (satellite.system == System::glonass) {
    channel = glonass_channels[satellite.number];
    if (!channel) channel = ephemeris.glonass_channel(satellite.number);
  }
  Measurement m;
  m.satellite = satellite;
  m.first = carrier_of(satellite, bands[0], signals,
                       carrier_frequency(satellite.system, bands[0], channel));
  m.second = carrier_of(satellite, bands[1], signals,
                        carrier_frequency(satellite.system, bands[1], channel));
  if (m.first.frequency == 0.0) return {};
  for (Carrier* c : {&m.first, &m.second}) {
    if (c->frequency > 0.0) {
      c->code -= ephemeris.code_bias(satellite, c->band, c->attribute, t);
    }
  }
  if (!m.dual() || !m.has_phase()) return m;
  const auto bias1 = ephemeris.phase_bias(satellite, m.first.band, m.first.phase_attribute, t);
  const auto bias2 = ephemeris.phase_bias(satellite, m.second.band, m.second.phase_attribute, t);
  m.integer = bias1 && bias2;
  if (m.integer) {
    m.first.phase -= *bias1;
    m.second.phase -= *bias2;
  }
  return m;
}

}  // namespace maploop::ppp
