// Defines the fields of broadcast messages as bits: their positions and units.
//
// Sources are IS-GPS-200 (subframes 1 to 3, page 18 of 4), Galileo OS SIS ICD 2.0 (I/NAV words 1 to
// 5), BeiDou BDS-SIS-ICD-B1I 3.0 (D1 subframes 1 to 3), GLONASS ICD 5.1 (strings 1 to 4), and RTCM
// 10403.3 (1019, 1020, 1042, 1044, 1045, 1046).
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <span>

#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/rtcm3_frames.h"

namespace maploop::ppp {

enum class Quantity {
  none,  // skipped
  week,
  toc,  // s of the week
  toe,
  toe_high,  // upper bits of BeiDou's, which is in two subframes
  af0,
  af1,
  af2,
  iode,
  crs,
  delta_n,
  m0,
  cuc,
  e,
  cus,
  sqrt_a,
  cic,
  omega0,
  cis,
  i0,
  crc,
  omega,
  omega_dot,
  i_dot,
  group_delay,
  second_group_delay,
  accuracy,  // index into the system's table
  health,
  e1_health,  // Galileo's health bits, and whether the data are valid
  e1_validity,
  e5a_health,
  e5a_validity,
  e5b_health,
  e5b_validity,
  // The following quantities are GLONASS's.
  channel,
  day,       // within four years
  interval,  // of 15 minutes, in Moscow time
  gamma,
  tau,
  x,
  y,
  z,
  vx,
  vy,
  vz,
  ax,
  ay,
  az,
  // These are coefficients of the ionosphere, contiguous: eight of GPS, three of Galileo.
  alpha_0,
  alpha_1,
  alpha_2,
  alpha_3,
  beta_0,
  beta_1,
  beta_2,
  beta_3,
  level_0,
  level_1,
  level_2,
  count
};
using BroadcastValues = std::array<double, static_cast<std::size_t>(Quantity::count)>;

enum class Coding { plain, twos_complement, sign_and_magnitude };

struct BroadcastField {
  Quantity what = Quantity::none;
  int bits = 0;
  double unit = 1.0;
  Coding coding = Coding::plain;
};

// Reads the fields in their order; skipped fields leave `values` unchanged.
void read_fields(Rtcm3Bits& bits, std::span<const BroadcastField> fields, BroadcastValues& values);

// `now` is a moment that differs from the reception by less than half a week (GLONASS: two years).
// Returns nothing if the values cannot be those of an orbit.
std::optional<KeplerMessage> kepler_message(Satellite satellite, const BroadcastValues& values,
                                            GpsTime now);
std::optional<GlonassMessage> glonass_message(Satellite satellite, const BroadcastValues& values,
                                              GpsTime now);
// Returns the coefficients of GPS or Galileo.
IonosphereCoefficients ionosphere_coefficients(System system, const BroadcastValues& values);

namespace broadcast_fields {

constexpr double power(int exponent) {
  double value = 1.0;
  for (; exponent < 0; ++exponent) value /= 2.0;
  for (; exponent > 0; --exponent) value *= 2.0;
  return value;
}
constexpr BroadcastField skip(int bits) {
  return {Quantity::none, bits};
}
constexpr BroadcastField number(Quantity q, int bits, double unit = 1.0) {
  return {q, bits, unit};
}
constexpr BroadcastField two(Quantity q, int bits, int exponent) {
  return {q, bits, power(exponent), Coding::twos_complement};
}
// The field is in semicircles; the value is in rad.
constexpr BroadcastField angle(Quantity q, int bits, int exponent) {
  return {q, bits, power(exponent) * std::numbers::pi, Coding::twos_complement};
}
constexpr BroadcastField glonass(Quantity q, int bits, int exponent) {
  return {q, bits, power(exponent) * 1e3, Coding::sign_and_magnitude};
}

using Q = Quantity;

template <std::size_t... sizes>
constexpr auto join(const std::array<BroadcastField, sizes>&... parts) {
  std::array<BroadcastField, (sizes + ...)> all;
  auto end = all.begin();
  ((end = std::copy(parts.begin(), parts.end(), end)), ...);
  return all;
}

// GPS's and Galileo's messages contain the same fields before and after the reference time.
inline constexpr std::array orbit_before_toe{two(Q::crs, 16, -5),
                                             angle(Q::delta_n, 16, -43),
                                             angle(Q::m0, 32, -31),
                                             two(Q::cuc, 16, -29),
                                             number(Q::e, 32, power(-33)),
                                             two(Q::cus, 16, -29),
                                             number(Q::sqrt_a, 32, power(-19))};
inline constexpr std::array orbit_after_toe{two(Q::cic, 16, -29),        angle(Q::omega0, 32, -31),
                                            two(Q::cis, 16, -29),        angle(Q::i0, 32, -31),
                                            two(Q::crc, 16, -5),         angle(Q::omega, 32, -31),
                                            angle(Q::omega_dot, 24, -43)};
inline constexpr std::array gps_toe{number(Q::toe, 16, 16.0)};
inline constexpr auto gps_orbit = join(orbit_before_toe, gps_toe, orbit_after_toe);
inline constexpr std::array gps_clock{number(Q::toc, 16, 16.0), two(Q::af2, 8, -55),
                                      two(Q::af1, 16, -43), two(Q::af0, 22, -31)};

// --- These are fields of IS-GPS-200, without parity, after the handover word.
inline constexpr auto gps_subframe_1 =
    join(std::array{number(Q::week, 10), skip(2), number(Q::accuracy, 4), number(Q::health, 6),
                    skip(2 + 1 + 87), two(Q::group_delay, 8, -31), skip(8)},
         gps_clock);
inline constexpr auto gps_subframe_2 =
    join(std::array{number(Q::iode, 8)}, orbit_before_toe, gps_toe);
inline constexpr auto gps_subframe_3 =
    join(orbit_after_toe, std::array{skip(8), angle(Q::i_dot, 14, -43)});

// These follow the identifier of the page.
inline constexpr std::array gps_ionosphere{two(Q::alpha_0, 8, -30), two(Q::alpha_1, 8, -27),
                                           two(Q::alpha_2, 8, -24), two(Q::alpha_3, 8, -24),
                                           two(Q::beta_0, 8, 11),   two(Q::beta_1, 8, 14),
                                           two(Q::beta_2, 8, 16),   two(Q::beta_3, 8, 16)};

// --- These are fields of RTCM, after the satellite's number.
inline constexpr auto rtcm_1019 =
    join(std::array{number(Q::week, 10), number(Q::accuracy, 4), skip(2), angle(Q::i_dot, 14, -43),
                    number(Q::iode, 8)},
         gps_clock, std::array{skip(10)}, gps_orbit,
         std::array{two(Q::group_delay, 8, -31), number(Q::health, 6)});
inline constexpr auto rtcm_1044 =
    join(gps_clock, std::array{number(Q::iode, 8)}, gps_orbit,
         std::array{angle(Q::i_dot, 14, -43), skip(2), number(Q::week, 10), number(Q::accuracy, 4),
                    number(Q::health, 6), two(Q::group_delay, 8, -31)});
inline constexpr std::array rtcm_1042{
    number(Q::week, 13),
    number(Q::accuracy, 4),
    angle(Q::i_dot, 14, -43),
    number(Q::iode, 5),
    number(Q::toc, 17, 8.0),
    two(Q::af2, 11, -66),
    two(Q::af1, 22, -50),
    two(Q::af0, 24, -33),
    skip(5),
    two(Q::crs, 18, -6),
    angle(Q::delta_n, 16, -43),
    angle(Q::m0, 32, -31),
    two(Q::cuc, 18, -31),
    number(Q::e, 32, power(-33)),
    two(Q::cus, 18, -31),
    number(Q::sqrt_a, 32, power(-19)),
    number(Q::toe, 17, 8.0),
    two(Q::cic, 18, -31),
    angle(Q::omega0, 32, -31),
    two(Q::cis, 18, -31),
    angle(Q::i0, 32, -31),
    two(Q::crc, 18, -6),
    angle(Q::omega, 32, -31),
    angle(Q::omega_dot, 24, -43),
    BroadcastField{Q::group_delay, 10, 1e-10, Coding::twos_complement},
    BroadcastField{Q::second_group_delay, 10, 1e-10, Coding::twos_complement},
    number(Q::health, 1)};
// These are the fields of 1045 and 1046 up to the first group delay.
inline constexpr auto rtcm_galileo =
    join(std::array{number(Q::week, 12), number(Q::iode, 10), number(Q::accuracy, 8),
                    angle(Q::i_dot, 14, -43), number(Q::toc, 14, 60.0), two(Q::af2, 6, -59),
                    two(Q::af1, 21, -46), two(Q::af0, 31, -34)},
         orbit_before_toe, std::array{number(Q::toe, 14, 60.0)}, orbit_after_toe,
         std::array{two(Q::group_delay, 10, -32)});
inline constexpr std::array rtcm_1045_end{number(Q::e5a_health, 2), number(Q::e5a_validity, 1)};
inline constexpr std::array rtcm_1046_end{two(Q::second_group_delay, 10, -32),
                                          number(Q::e5b_health, 2), number(Q::e5b_validity, 1),
                                          number(Q::e1_health, 2), number(Q::e1_validity, 1)};
inline constexpr std::array rtcm_1020{
    number(Q::channel, 5),
    skip(1 + 1 + 2 + 12),
    number(Q::health, 1),
    skip(1),
    number(Q::interval, 7),
    glonass(Q::vx, 24, -20),
    glonass(Q::x, 27, -11),
    glonass(Q::ax, 5, -30),
    glonass(Q::vy, 24, -20),
    glonass(Q::y, 27, -11),
    glonass(Q::ay, 5, -30),
    glonass(Q::vz, 24, -20),
    glonass(Q::z, 27, -11),
    glonass(Q::az, 5, -30),
    skip(1),
    BroadcastField{Q::gamma, 11, power(-40), Coding::sign_and_magnitude},
    skip(2 + 1),
    BroadcastField{Q::tau, 22, power(-30), Coding::sign_and_magnitude},
    skip(5 + 5 + 1 + 4),
    number(Q::day, 11)};

// --- These are Galileo's I/NAV words, after the type.
inline constexpr std::array galileo_word_1{number(Q::iode, 10), number(Q::toe, 14, 60.0),
                                           angle(Q::m0, 32, -31), number(Q::e, 32, power(-33)),
                                           number(Q::sqrt_a, 32, power(-19))};
inline constexpr std::array galileo_word_2{skip(10), angle(Q::omega0, 32, -31),
                                           angle(Q::i0, 32, -31), angle(Q::omega, 32, -31),
                                           angle(Q::i_dot, 14, -43)};
inline constexpr std::array galileo_word_3{skip(10),
                                           angle(Q::omega_dot, 24, -43),
                                           angle(Q::delta_n, 16, -43),
                                           two(Q::cuc, 16, -29),
                                           two(Q::cus, 16, -29),
                                           two(Q::crc, 16, -5),
                                           two(Q::crs, 16, -5),
                                           number(Q::accuracy, 8)};
inline constexpr std::array galileo_word_4{
    skip(10 + 6),         two(Q::cic, 16, -29), two(Q::cis, 16, -29), number(Q::toc, 14, 60.0),
    two(Q::af0, 31, -34), two(Q::af1, 21, -46), two(Q::af2, 6, -59)};
inline constexpr std::array galileo_word_5{number(Q::level_0, 11, power(-2)),
                                           two(Q::level_1, 11, -8),
                                           two(Q::level_2, 14, -15),
                                           skip(5),
                                           two(Q::group_delay, 10, -32),
                                           two(Q::second_group_delay, 10, -32),
                                           number(Q::e5b_health, 2),
                                           number(Q::e1_health, 2),
                                           number(Q::e5b_validity, 1),
                                           number(Q::e1_validity, 1),
                                           number(Q::week, 12)};

// --- These are BeiDou's D1 subframes, without parity, after the second of the week.
inline constexpr std::array beidou_subframe_1{
    number(Q::health, 1),
    skip(5),
    number(Q::accuracy, 4),
    number(Q::week, 13),
    number(Q::toc, 17, 8.0),
    BroadcastField{Q::group_delay, 10, 1e-10, Coding::twos_complement},
    BroadcastField{Q::second_group_delay, 10, 1e-10, Coding::twos_complement},
    skip(64),
    two(Q::af2, 11, -66),
    two(Q::af0, 24, -33),
    two(Q::af1, 22, -50),
    number(Q::iode, 5)};
inline constexpr std::array beidou_subframe_2{angle(Q::delta_n, 16, -43),
                                              two(Q::cuc, 18, -31),
                                              angle(Q::m0, 32, -31),
                                              number(Q::e, 32, power(-33)),
                                              two(Q::cus, 18, -31),
                                              two(Q::crc, 18, -6),
                                              two(Q::crs, 18, -6),
                                              number(Q::sqrt_a, 32, power(-19)),
                                              number(Q::toe_high, 2, 8.0 * 32768.0)};
inline constexpr std::array beidou_subframe_3{
    number(Q::toe, 15, 8.0),      angle(Q::i0, 32, -31),   two(Q::cic, 18, -31),
    angle(Q::omega_dot, 24, -43), two(Q::cis, 18, -31),    angle(Q::i_dot, 14, -43),
    angle(Q::omega0, 32, -31),    angle(Q::omega, 32, -31)};

// --- These are GLONASS's strings, after their number.
inline constexpr std::array glonass_string_1{skip(2 + 2 + 12), glonass(Q::vx, 24, -20),
                                             glonass(Q::ax, 5, -30), glonass(Q::x, 27, -11)};
inline constexpr std::array glonass_string_2{number(Q::health, 1),    skip(2 + 1),
                                             number(Q::interval, 7),  skip(5),
                                             glonass(Q::vy, 24, -20), glonass(Q::ay, 5, -30),
                                             glonass(Q::y, 27, -11)};
inline constexpr std::array glonass_string_3{
    skip(1),
    BroadcastField{Q::gamma, 11, power(-40), Coding::sign_and_magnitude},
    skip(1 + 2 + 1),
    glonass(Q::vz, 24, -20),
    glonass(Q::az, 5, -30),
    glonass(Q::z, 27, -11)};
inline constexpr std::array glonass_string_4{
    BroadcastField{Q::tau, 22, power(-30), Coding::sign_and_magnitude},
    skip(5 + 5 + 14 + 1 + 4 + 3), number(Q::day, 11)};

}  // namespace broadcast_fields
}  // namespace maploop::ppp
