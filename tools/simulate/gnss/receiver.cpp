#include "tools/simulate/gnss/receiver.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "ppp/models/attitude.h"
#include "ppp/models/geodesy.h"
#include "ppp/models/tides.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using ppp::speed_of_light;

constexpr double clock_begin = -2.0;                      // s
constexpr double lowest = radians(3.0);                   // elevation
constexpr std::array<double, 2> receiver_bias{4.2, 7.9};  // m, of the codes of each carrier

// Signals in order: L1 C/A, L2C; E1, E5a.
SignalShape shape_of(ppp::System system, std::size_t carrier) {
  const double frequency = ppp::carrier_frequency(system, bands(system)[carrier]);
  if (carrier == 0) {
    return system == ppp::System::gps ? SignalShape{frequency, 293.05, 0.1, 50.0}
                                      : SignalShape{frequency, 146.5, 0.2, 50.5};
  }
  return system == ppp::System::gps ? SignalShape{frequency, 293.05, 0.1, 47.0}
                                    : SignalShape{frequency, 29.3, 0.6, 51.0};
}

double in_table(const double* table, std::size_t count, double place) {
  const double p = std::clamp(place, 0.0, static_cast<double>(count) - 1.001);
  const auto i = static_cast<std::size_t>(p);
  return table[i] + (p - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

double transmit_delay(const TransmitAntenna& antenna, double nadir) {
  return -antenna.phase_centre * std::cos(nadir) +
         in_table(antenna.variation.data(), antenna.variation.size(), degrees(nadir));
}

Eigen::Matrix3d antenna_axes(const Eigen::Matrix3d& R_enu_body, const Eigen::Matrix3d& R_enu_ecef) {
  const Eigen::Matrix3d R_body_ecef = R_enu_body.transpose() * R_enu_ecef;
  Eigen::Matrix3d axes;
  axes << -R_body_ecef.row(1), R_body_ecef.row(0), R_body_ecef.row(2);
  return axes;
}

}  // namespace

double ReceiveAntenna::delay(const Eigen::Vector3d& to_satellite) const {
  const double zenith = std::acos(std::clamp(to_satellite.z(), -1.0, 1.0));
  return -offset.dot(to_satellite) +
         in_table(variation.data(), variation.size(), degrees(zenith) / 5.0);
}

std::array<ReceiveAntenna, 2> calibrated_antenna() {
  std::array<ReceiveAntenna, 2> antenna;
  antenna[0].offset = {0.0006, -0.0011, 0.0627};
  antenna[1].offset = {-0.0004, 0.0009, 0.0589};
  for (std::size_t carrier = 0; carrier < 2; ++carrier) {
    for (std::size_t i = 0; i < 19; ++i) {
      const double zenith = radians(5.0 * static_cast<double>(i));
      const double size = carrier == 0 ? 0.006 : 0.004;
      const double bend = std::sin(1.7 * zenith);
      antenna[carrier].variation[i] = 1e-5 * std::round(-1e5 * size * bend * bend);
    }
  }
  return antenna;
}

Receiver::Receiver(const Constellation& constellation, const VehicleMotion& motion,
                   const Eigen::Vector3d& lever, const LocalFrame& frame, Time start,
                   double seconds, std::uint64_t seed)
    : constellation_(constellation),
      motion_(motion),
      lever_(lever),
      frame_(frame),
      start_(ppp::from_utc(start)),
      earth_({}),
      troposphere_(frame.origin().height, seed),
      ionosphere_(frame.origin(), ppp::seconds_of_week(start_), seed),
      antenna_(calibrated_antenna()) {
  Random random(seed, 25);
  // An individual antenna differs from the calibration of its type.
  for (ReceiveAntenna& carrier : antenna_)
    for (int i = 0; i < 3; ++i) carrier.offset[i] += 0.0015 * random.normal();
  double offset = random.uniform(-1e-4, 1e-4), drift = random.uniform(-4e-8, 4e-8);
  for (double t = clock_begin; t < seconds + 4.0; t += 1.0) {
    clock_.push_back(offset);
    drift += 5e-11 * random.normal();
    offset += drift + 2e-11 * random.normal();
  }
  const auto& satellites = constellation.satellites();
  for (std::size_t i = 0; i < satellites.size(); ++i) {
    const ppp::System system = satellites[i].satellite.system;
    trackers_.push_back({{SignalTracker(shape_of(system, 0), seed, 2 * i),
                          SignalTracker(shape_of(system, 1), seed, 2 * i + 1)},
                         Scatterers(seed, i),
                         {0.12 * random.normal(), 0.12 * random.normal()}});
  }
  for (Eigen::Vector3d& pattern : code_pattern_) {
    pattern = {random.uniform(0.05, 0.15), random.uniform(0.0, 2.0 * std::numbers::pi),
               random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
}

double Receiver::clock(double t) const {
  return in_table(clock_.data(), clock_.size(), t - clock_begin);
}

Eigen::Vector3d Receiver::antenna_ecef(double t) const {
  return ppp::ecef_from_geodetic(frame_.to_geodetic(motion_.pose(t) * lever_));
}

Receiver::Range Receiver::range(std::size_t satellite, double t,
                                const Eigen::Vector3d& tide) const {
  const double offset = clock(t), received = t - offset;
  const Eigen::Vector3d antenna = antenna_ecef(received) + tide;
  const OrbitElements& orbit = constellation_.satellites()[satellite].orbit;
  double way = 0.08;  // s, first guess of the travel time
  Eigen::Vector3d place;
  for (int i = 0; i < 4; ++i) {
    // The earth-fixed frame rotates while the signal travels.
    place = Eigen::AngleAxisd(-ppp::earth_rotation_rate * way, Eigen::Vector3d::UnitZ()) *
            orbit.position(received - way);
    way = (place - antenna).norm() / speed_of_light;
  }
  const double sent = received - way;
  const double clocks =
      offset - constellation_.clock(satellite, sent) - clock_relativity(orbit, sent);
  const double distance = way * speed_of_light, a = place.norm() + antenna.norm();
  constexpr double twice_mass = 2.0 * 3.986004418e14 / (speed_of_light * speed_of_light);
  const double shapiro = twice_mass * std::log((a + distance) / (a - distance));
  return {distance + shapiro + speed_of_light * clocks, place};
}

std::vector<ObservedSatellite> Receiver::observe(double t, double interval, const RayScene& scene) {
  const VehicleState state = motion_.state(t - clock(t));
  const Eigen::Matrix3d& R = state.T_enu_body.linear();
  const Eigen::Vector3d place = state.T_enu_body * lever_;
  const Eigen::Vector3d velocity = state.velocity_enu + R * state.rate_body.cross(lever_);
  const ppp::SunAndMoon bodies = earth_.at(start_ + from_seconds(t));
  const Eigen::Vector3d point = antenna_ecef(t - clock(t));
  const Eigen::Vector3d tide = ppp::solid_earth_tide(point, bodies);
  const Eigen::Matrix3d R_enu_ecef = ppp::rotation_enu_ecef(ppp::geodetic_from_ecef(point));
  const Moment now{t,
                   interval,
                   velocity.norm(),
                   SignalPaths(scene, place, velocity),
                   bodies,
                   point + tide,
                   tide,
                   R_enu_ecef,
                   antenna_axes(R, R_enu_ecef)};
  std::vector<ObservedSatellite> all;
  for (std::size_t i = 0; i < trackers_.size(); ++i) {
    ObservedSatellite s = observe(i, now);
    if (s.signals[0] || s.signals[1]) all.push_back(s);
  }
  return all;
}

ObservedSatellite Receiver::observe(std::size_t satellite, const Moment& now) {
  const TrueSatellite& truth = constellation_.satellites()[satellite];
  Tracker& tracker = trackers_[satellite];
  ObservedSatellite observed{truth.satellite, {}};
  const Range arrived = range(satellite, now.t, now.tide);
  const Eigen::Vector3d way = arrived.satellite - now.antenna, direction = way.normalized();
  const Eigen::Vector3d local = now.R_enu_ecef * direction, on_roof = now.axes * direction;
  const double elevation = std::asin(local.z()), azimuth = std::atan2(local.x(), local.y());
  std::vector<SignalPath> paths;
  if (elevation > lowest) paths = now.around.from(local);
  tracker.scatterers.add_to(paths, now.interval, now.speed);
  tracker.wind_up = ppp::wind_up(ppp::nominal_attitude(arrived.satellite, now.bodies.sun), now.axes,
                                 way, tracker.wind_up);
  const auto tracked_first = tracker.signals[0].track(paths, elevation, now.interval);
  const auto tracked_second = tracker.signals[1].track(paths, elevation, now.interval);
  if (!tracked_first && !tracked_second) return observed;
  constexpr double h = 0.05;  // s
  const double rate = (range(satellite, now.t + h, now.tide).metres -
                       range(satellite, now.t - h, now.tide).metres) /
                      (2.0 * h);
  const double nadir =
      std::acos(std::clamp(arrived.satellite.normalized().dot(direction), -1.0, 1.0));
  const double electrons = ionosphere_.electrons(elevation, azimuth, now.t);
  const double air = troposphere_.delay(elevation, azimuth, now.t);
  for (std::size_t carrier = 0; carrier < 2; ++carrier) {
    const auto& tracked = carrier == 0 ? tracked_first : tracked_second;
    if (!tracked) continue;
    const char band = bands(truth.satellite.system)[carrier];
    const double frequency = ppp::carrier_frequency(truth.satellite.system, band);
    const double wavelength = speed_of_light / frequency;
    const double ratio = ppp::carrier_frequency(truth.satellite.system, '1') / frequency;
    const double common = arrived.metres + air + transmit_delay(truth.antennas[carrier], nadir) +
                          antenna_[carrier].delay(on_roof);
    const double ionosphere = ionospheric_delay(electrons, frequency);
    const Eigen::Vector3d& pattern = code_pattern_[carrier];
    const double sideways = std::atan2(on_roof.x(), on_roof.y());
    const double uneven =
        pattern[0] * (std::sin(2.0 * sideways + pattern[1]) * on_roof.head<2>().norm() +
                      std::sin(4.0 * elevation + pattern[2]));
    ObservedSignal signal;
    signal.code = common + ionosphere + speed_of_light * truth.group_delay * ratio * ratio +
                  receiver_bias[carrier] + tracker.code_bias[carrier] + uneven + tracked->code;
    if (tracked->phase)
      signal.phase = (common - ionosphere + *tracked->phase) / wavelength + tracker.wind_up;
    signal.doppler = -(rate + tracked->rate) / wavelength;
    signal.cn0 = tracked->cn0;
    signal.lost_lock = tracked->lost_lock;
    observed.signals[carrier] = signal;
  }
  return observed;
}

}  // namespace maploop::simulate
