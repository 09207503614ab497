// The sources are RTCM 10403.3, sections 3.5.12 and 3.5.13 (messages 1057 to 1068), drafts of the
// same for Galileo, QZSS, phase biases and the ionosphere, and the IGS State Space Representation
// format 1.00.
#include "ppp/readers/corrections/ssr.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

namespace maploop::ppp {
namespace {

enum class Content { orbit, clock, both, bias, phase_bias, ura, high_rate_clock };

struct SsrKind {
  System system;
  Content content;
  bool igs;
};

// The orders are those of RTCM's message numbers and of the IGS's subtypes, for `place` from 1.
constexpr std::array rtcm_order{Content::orbit, Content::clock, Content::bias,
                                Content::both,  Content::ura,   Content::high_rate_clock};
constexpr std::array igs_order{
    Content::orbit, Content::clock,      Content::both, Content::high_rate_clock,
    Content::bias,  Content::phase_bias, Content::ura};
constexpr int rtcm_ionosphere = 1264, igs_ionosphere = 201;

std::optional<SsrKind> ssr_kind(int number, int subtype) {
  if (number == 4076) {
    constexpr std::array igs_systems{System::gps, System::glonass, System::galileo, System::qzss};
    const int group = subtype / 20 - 1, place = subtype % 20;
    if (group < 0 || group >= static_cast<int>(igs_systems.size())) return {};
    const System system = igs_systems[static_cast<std::size_t>(group)];
    if (place < 1 || place > static_cast<int>(igs_order.size())) return {};
    return SsrKind{system, igs_order[static_cast<std::size_t>(place - 1)], true};
  }
  struct First {
    int number;
    System system;
  };
  for (const First f : {First{1057, System::gps}, First{1063, System::glonass},
                        First{1240, System::galileo}, First{1246, System::qzss}}) {
    const int place = number - f.number;
    if (place < 0 || place >= static_cast<int>(rtcm_order.size())) continue;
    return SsrKind{f.system, rtcm_order[static_cast<std::size_t>(place)], false};
  }
  constexpr std::array phase_systems{System::gps, System::glonass, System::galileo, System::qzss};
  const int place = number - 1265;
  if (place >= 0 && place < static_cast<int>(phase_systems.size()))
    return SsrKind{phase_systems[static_cast<std::size_t>(place)], Content::phase_bias, false};
  return {};
}

bool is_ssr(int number) {
  return number == 4076 || (number >= 1057 && number <= 1068) || (number >= 1240 && number <= 1270);
}

// Returns a signal's name by its number (RTCM 10403.3, DF380 and DF381; IGS SSR, tables of signal
// identifiers); empty if the number has no signal.
std::string_view ssr_signal(System system, std::size_t number) {
  using SsrNames = std::span<const std::string_view>;
  static constexpr std::array<std::string_view, 17> of_gps{"1C", "1P", "1W", "1S", "1L", "2C",
                                                           "2D", "2S", "2L", "2X", "2P", "2W",
                                                           "",   "",   "5I", "5Q", "5X"};
  static constexpr std::array<std::string_view, 4> of_glonass{"1C", "1P", "2C", "2P"};
  static constexpr std::array<std::string_view, 18> of_galileo{"1A", "1B", "1C", "1X", "1Z", "5I",
                                                               "5Q", "5X", "7I", "7Q", "7X", "8I",
                                                               "8Q", "8X", "6A", "6B", "6C", "6X"};
  static constexpr std::array<std::string_view, 12> of_qzss{"1C", "1S", "1L", "2S", "2L", "2X",
                                                            "5I", "5Q", "5X", "6S", "6L", "6X"};
  const SsrNames names = system == System::gps       ? SsrNames(of_gps)
                         : system == System::glonass ? SsrNames(of_glonass)
                         : system == System::galileo ? SsrNames(of_galileo)
                                                     : SsrNames(of_qzss);
  return number < names.size() ? names[number] : std::string_view{};
}

Duration update_interval(std::uint64_t index) {
  constexpr std::array<int, 16> table{1,   2,   5,   10,  15,   30,   60,   120,
                                      240, 300, 600, 900, 1800, 3600, 7200, 10800};
  return std::chrono::seconds(table[static_cast<std::size_t>(index & 15U)]);
}

// Reads a signed number of units and converts it to m.
double scaled(Rtcm3Bits& bits, std::size_t width, double unit) {
  return unit * static_cast<double>(bits.signed_number(width));
}

SsrOrbit read_orbit(Rtcm3Bits& bits, std::size_t issue_bits) {
  SsrOrbit o;
  o.issue = static_cast<int>(bits.number(issue_bits) & 0xffU);
  o.offset = {scaled(bits, 22, 1e-4), 0.0, 0.0};
  o.offset.y() = scaled(bits, 20, 4e-4);
  o.offset.z() = scaled(bits, 20, 4e-4);
  o.offset_rate.x() = scaled(bits, 21, 1e-6);
  o.offset_rate.y() = scaled(bits, 19, 4e-6);
  o.offset_rate.z() = scaled(bits, 19, 4e-6);
  return o;
}

SsrClock read_clock(Rtcm3Bits& bits) {
  SsrClock c;
  c.polynomial[0] = scaled(bits, 22, 1e-4);
  c.polynomial[1] = scaled(bits, 21, 1e-6);
  c.polynomial[2] = scaled(bits, 27, 2e-8);
  return c;
}

// Reads the range accuracy, m (RTCM 10403.3, DF389); 0 and 63 mean that it is unknown.
std::optional<double> read_sigma(Rtcm3Bits& bits) {
  const auto index = bits.number(6);
  if (index == 0 || index == 63) return {};
  const double millimetres = std::pow(3.0, static_cast<double>(index >> 3)) *
                                 (1.0 + static_cast<double>(index & 7U) / 4.0) -
                             1.0;
  return 1e-3 * millimetres;
}

void read_biases(Rtcm3Bits& bits, SsrUpdate& update) {
  update.has_biases = true;
  const auto count = bits.number(5);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto name = ssr_signal(update.satellite.system, bits.number(5));
    const double value = scaled(bits, 14, 0.01);
    if (!name.empty()) update.biases.push_back({name[0], name[1], value});
  }
}

void read_phase_biases(Rtcm3Bits& bits, SsrUpdate& update) {
  update.has_phase_biases = true;
  const auto count = bits.number(5);
  bits.skip(9 + 8);  // the yaw and its rate
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto name = ssr_signal(update.satellite.system, bits.number(5));
    SsrPhaseBias bias;
    bias.integer = bits.number(1) != 0;
    bits.skip(2);  // whether the wide lane of several is an integer
    bias.discontinuity = static_cast<int>(bits.number(4));
    bias.value = scaled(bits, 20, 1e-4);
    if (name.empty()) continue;
    bias.band = name[0];
    bias.attribute = name[1];
    update.phase_biases.push_back(bias);
  }
}

// GLONASS's messages of RTCM count seconds of the day in Moscow. `datum` states whether there is a
// flag for a regional reference frame.
void read_header(Rtcm3Bits& bits, GpsTime now, bool moscow, bool datum, SsrHeader& header) {
  constexpr Duration day = std::chrono::hours(24);
  const Duration since = std::chrono::seconds(bits.number(moscow ? 17 : 20));
  header.interval = update_interval(bits.number(4));
  bits.skip(1);  // the flag for more messages of this time
  if (datum) bits.skip(1);
  header.issue = static_cast<int>(bits.number(4));
  header.solution = static_cast<std::uint32_t>(bits.number(20));
  header.time = moscow
                    ? nearest_moment(
                          now, since - std::chrono::hours(3) + leap_seconds(now).gps_minus_utc, day)
                    : nearest_moment(now, since, 7 * day);
  // The corrections refer to the middle of the interval, except for the shortest one.
  if (header.interval > std::chrono::seconds(1)) header.time += header.interval / 2;
}

SsrResult decode_ionosphere(Rtcm3Bits& bits, GpsTime now, std::optional<SsrIonosphere>& to) {
  constexpr double coefficient_unit = 0.005, quality_unit = 0.05;  // TECU
  SsrIonosphere all;
  read_header(bits, now, false, false, all);
  all.sigma = quality_unit * static_cast<double>(bits.number(9));
  const auto layers = bits.number(2) + 1;
  for (std::uint64_t i = 0; i < layers && bits.good(); ++i) {
    bits.skip(8);  // the height: each layer counts as the shell of the other models
    SsrLayer layer;
    layer.degree = static_cast<int>(bits.number(4)) + 1;
    layer.order = static_cast<int>(bits.number(4)) + 1;
    if (layer.order > layer.degree) return SsrResult::incomplete;
    for (int m = 0; m <= layer.order; ++m) {
      for (int n = m; n <= layer.degree; ++n)
        layer.cosines.push_back(scaled(bits, 16, coefficient_unit));
    }
    for (int m = 1; m <= layer.order; ++m) {
      for (int n = m; n <= layer.degree; ++n)
        layer.sines.push_back(scaled(bits, 16, coefficient_unit));
    }
    all.layers.push_back(std::move(layer));
  }
  if (!bits.good()) return SsrResult::incomplete;
  to = std::move(all);
  return SsrResult::decoded;
}

}  // namespace

SsrResult decode_ssr(const Rtcm3Message& message, GpsTime now, std::vector<SsrUpdate>& to,
                     std::optional<SsrIonosphere>& ionosphere) {
  if (!is_ssr(message.number)) return SsrResult::none;
  Rtcm3Bits bits(message.payload);
  bits.skip(12);
  int subtype = 0;
  if (message.number == 4076) {
    bits.skip(3);  // version
    subtype = static_cast<int>(bits.number(8));
  }
  if (message.number == rtcm_ionosphere || subtype == igs_ionosphere)
    return decode_ionosphere(bits, now, ionosphere);
  const auto kind = ssr_kind(message.number, subtype);
  if (!kind) return SsrResult::unsupported;
  const bool moscow = kind->system == System::glonass && !kind->igs;
  const bool qzss = kind->system == System::qzss;
  const bool orbits = kind->content == Content::orbit || kind->content == Content::both;
  SsrUpdate common;
  read_header(bits, now, moscow, orbits && !kind->igs, common);
  if (orbits && kind->igs) bits.skip(1);
  if (kind->content == Content::phase_bias) bits.skip(2);  // what the biases are consistent with
  const auto count = bits.number(qzss && !kind->igs ? 4 : 6);

  const std::size_t number_bits = kind->igs ? 6 : moscow ? 5 : qzss ? 4 : 6;
  const std::size_t issue_bits = !kind->igs && kind->system == System::galileo ? 10 : 8;
  const std::size_t before = to.size();
  for (std::uint64_t i = 0; i < count && bits.good(); ++i) {
    SsrUpdate u = common;
    u.satellite = {kind->system, static_cast<std::uint8_t>(bits.number(number_bits))};
    if (orbits) u.orbit = read_orbit(bits, issue_bits);
    if (kind->content == Content::clock || kind->content == Content::both)
      u.clock = read_clock(bits);
    if (kind->content == Content::bias) read_biases(bits, u);
    if (kind->content == Content::phase_bias) read_phase_biases(bits, u);
    if (kind->content == Content::ura) u.sigma = read_sigma(bits);
    if (kind->content == Content::high_rate_clock) u.high_rate_clock = scaled(bits, 22, 1e-4);
    if (u.satellite.number > 0) to.push_back(std::move(u));
  }
  if (bits.good()) return SsrResult::decoded;
  to.resize(before);
  return SsrResult::incomplete;
}

}  // namespace maploop::ppp
