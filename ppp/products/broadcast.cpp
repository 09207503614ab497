#include "ppp/products/broadcast.h"

#include <algorithm>
#include <cmath>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

// Returns how far from its reference time a message is still used. Galileo would allow hours, but
// is then wrong by tens of metres; a new message comes every ten minutes.
Duration longest_age(System system) {
  using std::chrono::minutes;
  switch (system) {
    case System::galileo:
      return minutes(60);
    case System::glonass:
      return minutes(31);
    case System::beidou:
      return minutes(90);
    default:
      return minutes(121);
  }
}

double polynomial(const KeplerMessage& m, GpsTime t) {
  const double dt = to_seconds(t - m.toc);
  return m.af0 + m.af1 * dt + m.af2 * dt * dt;
}

double gravity_constant(System system) {
  return system == System::gps || system == System::qzss ? 3.9860050e14 : 3.986004418e14;
}

double rotation_rate(System system) {
  return system == System::beidou ? 7.292115e-5 : earth_rotation_rate;
}

struct Orbit {
  Eigen::Vector3d position;
  double relativity;  // s
};

Orbit orbit(const KeplerMessage& m, GpsTime t) {
  const double mu = gravity_constant(m.satellite.system);
  const double rate = rotation_rate(m.satellite.system);
  const double tk = to_seconds(t - m.toe);
  const double a = m.sqrt_a * m.sqrt_a;
  const double mean_anomaly = m.m0 + (std::sqrt(mu / (a * a * a)) + m.delta_n) * tk;
  double eccentric = mean_anomaly;
  for (int i = 0; i < 12; ++i) {
    eccentric -=
        (eccentric - m.e * std::sin(eccentric) - mean_anomaly) / (1.0 - m.e * std::cos(eccentric));
  }
  const double sin_e = std::sin(eccentric), cos_e = std::cos(eccentric);
  const double argument = std::atan2(std::sqrt(1.0 - m.e * m.e) * sin_e, cos_e - m.e) + m.omega;
  const double s2 = std::sin(2.0 * argument), c2 = std::cos(2.0 * argument);
  const double u = argument + m.cus * s2 + m.cuc * c2;
  const double r = a * (1.0 - m.e * cos_e) + m.crs * s2 + m.crc * c2;
  const double i = m.i0 + m.i_dot * tk + m.cis * s2 + m.cic * c2;
  const double x = r * std::cos(u), y = r * std::sin(u);
  // The time of the week is in the time of the message's own system.
  const bool beidou = m.satellite.system == System::beidou;
  const double toe_of_week = seconds_of_week(m.toe) - (beidou ? 14.0 : 0.0);
  const bool geostationary = beidou && (m.satellite.number <= 5 || m.satellite.number >= 59);
  const double node =
      m.omega0 + (geostationary ? m.omega_dot : m.omega_dot - rate) * tk - rate * toe_of_week;
  Eigen::Vector3d p(x * std::cos(node) - y * std::cos(i) * std::sin(node),
                    x * std::sin(node) + y * std::cos(i) * std::cos(node), y * std::sin(i));
  if (geostationary) {
    // The message refers to a frame that is inclined by five degrees and does not rotate.
    const double tilt = -5.0 / 180.0 * 3.14159265358979323846, angle = rate * tk;
    const Eigen::Vector3d q(p.x(), p.y() * std::cos(tilt) + p.z() * std::sin(tilt),
                            -p.y() * std::sin(tilt) + p.z() * std::cos(tilt));
    p = {q.x() * std::cos(angle) + q.y() * std::sin(angle),
         -q.x() * std::sin(angle) + q.y() * std::cos(angle), q.z()};
  }
  return {p, -2.0 * std::sqrt(mu * a) * m.e * sin_e / (speed_of_light * speed_of_light)};
}

using GlonassState = Eigen::Matrix<double, 6, 1>;

GlonassState derivative(const GlonassState& s, const Eigen::Vector3d& acceleration) {
  constexpr double mu = 3.9860044e14, j2 = 1.0826257e-3, radius = 6378136.0, rate = 7.292115e-5;
  const Eigen::Vector3d p = s.head<3>();
  const double r2 = p.squaredNorm(), r3 = r2 * std::sqrt(r2);
  const double a = 1.5 * j2 * mu * radius * radius / (r2 * r3);
  const double b = 5.0 * p.z() * p.z() / r2;
  const double c = -mu / r3 - a * (1.0 - b);
  GlonassState d;
  d.head<3>() = s.tail<3>();
  d[3] = (c + rate * rate) * p.x() + 2.0 * rate * s[4] + acceleration.x();
  d[4] = (c + rate * rate) * p.y() - 2.0 * rate * s[3] + acceleration.y();
  d[5] = (c - 2.0 * a) * p.z() + acceleration.z();
  return d;
}

GlonassState integrate(const GlonassMessage& m, GpsTime t) {
  GlonassState s;
  s << m.position, m.velocity;
  constexpr double longest_step = 60.0;  // s
  double left = to_seconds(t - m.toe);
  while (std::abs(left) > 1e-9) {
    const double h = std::clamp(left, -longest_step, longest_step);
    const GlonassState k1 = derivative(s, m.acceleration);
    const GlonassState k2 = derivative(s + k1 * (h / 2), m.acceleration);
    const GlonassState k3 = derivative(s + k2 * (h / 2), m.acceleration);
    const GlonassState k4 = derivative(s + k3 * h, m.acceleration);
    s += (k1 + 2.0 * k2 + 2.0 * k3 + k4) * (h / 6.0);
    left -= h;
  }
  return s;
}

int issue_of(const KeplerMessage& m) {
  return static_cast<int>(m.iode) & 0xff;
}

int issue_of(const GlonassMessage& m) {
  const Duration day =
      (to_utc(m.toe).time_since_epoch() + std::chrono::hours(3)) % Duration(std::chrono::hours(24));
  return static_cast<int>((day + std::chrono::minutes(7)) / std::chrono::minutes(15));
}

template <class Message>
const Message* with_issue(const std::vector<Message>& messages, int issue, GpsTime t,
                          Duration longest) {
  const auto found = std::find_if(messages.rbegin(), messages.rend(), [&](const Message& m) {
    return issue_of(m) == issue && std::chrono::abs(t - m.toe) <= longest;
  });
  return found == messages.rend() ? nullptr : &*found;
}

std::optional<SatelliteState> state_by(const GlonassMessage* m, GpsTime t) {
  if (!m || m->health != 0.0) return {};
  const GlonassState s = integrate(*m, t);
  SatelliteState state;
  state.position = s.head<3>();
  state.velocity = s.tail<3>();
  state.clock = m->minus_tau + m->gamma * to_seconds(t - m->toe);
  state.clock_drift = m->gamma;
  state.message = m->toe;
  state.sigma = 3.0;
  return state;
}

std::optional<SatelliteState> state_by(const KeplerMessage* m, GpsTime t) {
  // Galileo's health has bits for each signal; for the other systems zero means healthy.
  if (!m || m->health != 0.0) return {};
  constexpr double step = 1e-2;  // s
  const Orbit now = orbit(*m, t), soon = orbit(*m, t + from_seconds(step));
  SatelliteState state;
  state.position = now.position;
  state.velocity = (soon.position - now.position) / step;
  state.clock = polynomial(*m, t) + now.relativity;
  state.clock_drift = m->af1;
  state.message = m->toe;
  const System system = m->satellite.system;
  state.sigma = system == System::galileo ? 0.5 : system == System::beidou ? 1.5 : 1.0;
  return state;
}

template <class Message>
const Message* nearest(const std::vector<Message>& messages, GpsTime t, Duration longest) {
  auto at = std::lower_bound(messages.begin(), messages.end(), t,
                             [](const Message& m, GpsTime moment) { return m.toe < moment; });
  if (at == messages.end() || (at != messages.begin() && t - (at - 1)->toe < at->toe - t)) {
    if (at == messages.begin()) return nullptr;
    --at;
  }
  return std::chrono::abs(t - at->toe) <= longest ? &*at : nullptr;
}

// Inserts in the order of toe and drops the earliest message if there are more than `most`.
template <class Message>
void insert(std::vector<Message>& list, const Message& m, std::size_t most) {
  list.insert(std::upper_bound(list.begin(), list.end(), m,
                               [](const Message& a, const Message& b) { return a.toe < b.toe; }),
              m);
  if (list.size() > most) list.erase(list.begin());
}

}  // namespace

BroadcastEphemeris::BroadcastEphemeris(const std::vector<NavigationFile>& files,
                                       std::size_t max_each)
    : max_each_(max_each) {
  for (const NavigationFile& file : files) add(file);
}

void BroadcastEphemeris::add(const BroadcastMessages& messages) {
  for (const KeplerMessage& m : messages.kepler) add(m);
  for (const GlonassMessage& m : messages.glonass) add(m);
  for (const IonosphereMessage& m : messages.ionosphere) ionosphere_.add(m);
}

void BroadcastEphemeris::add(const KeplerMessage& m) {
  // Galileo's clock for E1 and E5b (I/NAV) is dropped if the one for E1 and E5a is available: the
  // orbits of both are the same.
  const auto is_e5b = [](const KeplerMessage& k) {
    return k.satellite.system == System::galileo && (static_cast<int>(k.data_sources) & 0x200) != 0;
  };
  auto& list = kepler_[m.satellite.slot()];
  const auto same = std::find_if(list.begin(), list.end(), [&](const KeplerMessage& other) {
    return other.toe == m.toe && other.iode == m.iode;
  });
  if (same == list.end()) {
    insert(list, m, max_each_);
  } else if (!is_e5b(m) || is_e5b(*same)) {
    *same = m;
  }
}

void BroadcastEphemeris::add(const GlonassMessage& m) {
  auto& list = glonass_[m.satellite.number];
  const auto same = std::find_if(list.begin(), list.end(),
                                 [&](const GlonassMessage& other) { return other.toe == m.toe; });
  if (same == list.end()) {
    insert(list, m, max_each_);
  } else {
    *same = m;
  }
}

const KeplerMessage* BroadcastEphemeris::kepler(Satellite satellite, GpsTime t,
                                                std::optional<int> issue) const {
  const auto& messages = kepler_[satellite.slot()];
  const Duration longest = longest_age(satellite.system);
  return issue ? with_issue(messages, *issue, t, longest) : nearest(messages, t, longest);
}

const GlonassMessage* BroadcastEphemeris::glonass(Satellite satellite, GpsTime t,
                                                  std::optional<int> issue) const {
  const auto& messages = glonass_[satellite.number];
  const Duration longest = longest_age(System::glonass);
  return issue ? with_issue(messages, *issue, t, longest) : nearest(messages, t, longest);
}

bool BroadcastEphemeris::has_issue(Satellite satellite, int issue, GpsTime t) const {
  return satellite.system == System::glonass ? glonass(satellite, t, issue) != nullptr
                                             : kepler(satellite, t, issue) != nullptr;
}

std::optional<double> BroadcastEphemeris::clock(Satellite satellite, GpsTime t) const {
  if (satellite.system == System::glonass) {
    const GlonassMessage* m = glonass(satellite, t);
    if (!m) return {};
    return m->minus_tau + m->gamma * to_seconds(t - m->toe);
  }
  const KeplerMessage* m = kepler(satellite, t);
  if (!m) return {};
  return polynomial(*m, t);
}

std::optional<SatelliteState> BroadcastEphemeris::at(Satellite satellite, GpsTime t) const {
  return satellite.system == System::glonass ? state_by(glonass(satellite, t), t)
                                             : state_by(kepler(satellite, t), t);
}

std::optional<SatelliteState> BroadcastEphemeris::at_issue(Satellite satellite, int issue,
                                                           GpsTime t) const {
  return satellite.system == System::glonass ? state_by(glonass(satellite, t, issue), t)
                                             : state_by(kepler(satellite, t, issue), t);
}

double BroadcastEphemeris::code_bias(Satellite satellite, char band, char, GpsTime t) const {
  if (satellite.system == System::glonass) return 0.0;
  const KeplerMessage* m = kepler(satellite, t);
  if (!m) return 0.0;
  if (satellite.system == System::beidou) {
    // The clock is that of the third carrier (B3).
    return speed_of_light * (band == '2' ? m->group_delay[0] : band == '7' ? m->group_delay[1] : 0);
  }
  const bool e5b =
      satellite.system == System::galileo && (static_cast<int>(m->data_sources) & 0x200) != 0;
  const double delay = m->group_delay[e5b ? 1 : 0];
  if (band == '1') return speed_of_light * delay;
  const double ratio =
      carrier_frequency(satellite.system, '1') / carrier_frequency(satellite.system, band);
  return speed_of_light * delay * ratio * ratio;
}

std::string BroadcastEphemeris::missing(Satellite satellite, GpsTime t) const {
  const bool known = satellite.system == System::glonass ? glonass(satellite, t) != nullptr
                                                         : kepler(satellite, t) != nullptr;
  return (known ? "unhealthy: " : "no broadcast message for ") + to_string(satellite) + " at " +
         format_gps_time(t);
}

std::optional<int> BroadcastEphemeris::glonass_channel(int number) const {
  const auto& messages = glonass_[static_cast<std::size_t>(number)];
  if (messages.empty()) return {};
  const int channel = messages.back().channel;
  return channel > 6 ? channel - 14 : channel;  // older files write negative channels plus 14
}

}  // namespace maploop::ppp
