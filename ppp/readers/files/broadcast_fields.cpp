#include "ppp/readers/files/broadcast_fields.h"

#include <cmath>

namespace maploop::ppp {
namespace {

constexpr Duration one_week = std::chrono::hours(24 * 7);

// Returns the user range accuracy of an index (IS-GPS-200), m.
double range_accuracy(int index) {
  constexpr std::array table{2.4,  3.4,   4.85,  6.85,  9.65,   13.65,  24.0,  48.0,
                             96.0, 192.0, 384.0, 768.0, 1536.0, 3072.0, 6144.0};
  return index >= 0 && index < static_cast<int>(table.size())
             ? table[static_cast<std::size_t>(index)]
             : 8192.0;
}

// Returns Galileo's signal-in-space accuracy of an index, m; -1: no prediction.
double signal_accuracy(int index) {
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  if (index < 126) return 2.0 + 0.16 * (index - 100);
  return -1.0;
}

// Returns the number closest to `now` that equals `part` modulo `period`.
int next_to(int now, int part, int period) {
  return part + period * static_cast<int>(std::lround(static_cast<double>(now - part) / period));
}

}  // namespace

void read_fields(Rtcm3Bits& bits, std::span<const BroadcastField> fields, BroadcastValues& values) {
  for (const BroadcastField& f : fields) {
    const auto width = static_cast<std::size_t>(f.bits);
    if (f.what == Quantity::none) {
      bits.skip(width);
      continue;
    }
    double value = 0.0;
    switch (f.coding) {
      case Coding::plain:
        value = static_cast<double>(bits.number(width));
        break;
      case Coding::twos_complement:
        value = static_cast<double>(bits.signed_number(width));
        break;
      case Coding::sign_and_magnitude: {
        const bool negative = bits.number(1) != 0;
        value = static_cast<double>(bits.number(width - 1));
        if (negative) value = -value;
        break;
      }
    }
    values[static_cast<std::size_t>(f.what)] = f.unit * value;
  }
}

std::optional<KeplerMessage> kepler_message(Satellite satellite, const BroadcastValues& values,
                                            GpsTime now) {
  const auto v = [&](Quantity q) { return values[static_cast<std::size_t>(q)]; };
  const bool beidou = satellite.system == System::beidou;
  const bool galileo = satellite.system == System::galileo;
  const int first_week = beidou ? 1356 : galileo ? 1024 : 0;
  const int period = beidou ? 8192 : galileo ? 4096 : 1024;
  const int week = next_to(gps_week(now), first_week + static_cast<int>(v(Quantity::week)), period);
  const Duration to_gps = beidou ? Duration(std::chrono::seconds(14)) : Duration::zero();
  // The week is that of the transmission; the reference time may be in the next or previous one.
  const auto moment = [&](double seconds) {
    GpsTime t = gps_week_time(week, seconds) + to_gps;
    if (now - t > one_week / 2) t += one_week;
    if (t - now > one_week / 2) t -= one_week;
    return t;
  };
  const double toe = v(Quantity::toe) + v(Quantity::toe_high);
  if (v(Quantity::toc) >= 604800.0 || toe >= 604800.0) return {};
  KeplerMessage m;
  m.satellite = satellite;
  m.toc = moment(v(Quantity::toc));
  m.toe = moment(toe);
  m.af0 = v(Quantity::af0), m.af1 = v(Quantity::af1), m.af2 = v(Quantity::af2);
  m.iode = v(Quantity::iode), m.crs = v(Quantity::crs), m.delta_n = v(Quantity::delta_n);
  m.m0 = v(Quantity::m0), m.cuc = v(Quantity::cuc), m.e = v(Quantity::e), m.cus = v(Quantity::cus);
  m.sqrt_a = v(Quantity::sqrt_a), m.cic = v(Quantity::cic), m.omega0 = v(Quantity::omega0);
  m.cis = v(Quantity::cis), m.i0 = v(Quantity::i0), m.crc = v(Quantity::crc);
  m.omega = v(Quantity::omega), m.omega_dot = v(Quantity::omega_dot), m.i_dot = v(Quantity::i_dot);
  m.group_delay = {v(Quantity::group_delay), v(Quantity::second_group_delay)};
  const int accuracy = static_cast<int>(v(Quantity::accuracy));
  m.accuracy = galileo ? signal_accuracy(accuracy) : range_accuracy(accuracy);
  // Galileo's bits are packed as in RINEX.
  m.health = galileo ? v(Quantity::e1_validity) + 2.0 * v(Quantity::e1_health) +
                           8.0 * v(Quantity::e5a_validity) + 16.0 * v(Quantity::e5a_health) +
                           64.0 * v(Quantity::e5b_validity) + 128.0 * v(Quantity::e5b_health)
                     : v(Quantity::health);
  if (!plausible(m)) return {};
  return m;
}

std::optional<GlonassMessage> glonass_message(Satellite satellite, const BroadcastValues& values,
                                              GpsTime now) {
  const auto v = [&](Quantity q) { return values[static_cast<std::size_t>(q)]; };
  // Days count in Moscow time, UTC plus three hours, from the start of the last leap year.
  constexpr auto moscow = std::chrono::hours(3);
  constexpr int four_years = 1461;
  const auto first_day = std::chrono::sys_days{std::chrono::year{1996} / 1 / 1};
  const auto today = std::chrono::floor<std::chrono::days>(to_utc(now) + moscow);
  const int day = static_cast<int>(v(Quantity::day));
  const int interval = static_cast<int>(v(Quantity::interval));
  if (day < 1 || day > four_years || interval < 1 || interval > 95) return {};
  const int days = next_to(static_cast<int>((today - first_day).count()), day - 1, four_years);
  const Time utc =
      Time(first_day + std::chrono::days(days)) - moscow + std::chrono::minutes(15 * interval);
  GlonassMessage m;
  m.satellite = satellite;
  m.toe = from_utc(utc);
  m.minus_tau = -v(Quantity::tau);
  m.gamma = v(Quantity::gamma);
  m.position = {v(Quantity::x), v(Quantity::y), v(Quantity::z)};
  m.velocity = {v(Quantity::vx), v(Quantity::vy), v(Quantity::vz)};
  m.acceleration = {v(Quantity::ax), v(Quantity::ay), v(Quantity::az)};
  m.channel = static_cast<int>(v(Quantity::channel)) - 7;
  m.health = v(Quantity::health);
  if (!plausible(m)) return {};
  return m;
}

IonosphereCoefficients ionosphere_coefficients(System system, const BroadcastValues& values) {
  const auto from = [&]<class Coefficients>(Coefficients c, Quantity first) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), c.values.size(),
                c.values.begin());
    return c;
  };
  if (system == System::galileo) return from(IonisationLevel{}, Quantity::level_0);
  return from(Klobuchar{}, Quantity::alpha_0);
}

}  // namespace maploop::ppp
