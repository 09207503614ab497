#include "tools/simulate/gnss/constellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using std::numbers::pi;

struct OrbitPlan {
  ppp::System system;
  int planes, in_plane;
  double radius, inclination, node_rate;  // m, rad, rad/s
  double eccentricity;                    // maximum
  double clock_walk;                      // s/sqrt(s): rubidium, hydrogen maser
  double phase_centre;                    // m
};

constexpr std::array<OrbitPlan, 2> plans{
    {{ppp::System::gps, 6, 5, 26'559'800.0, radians(55.0), -8.0e-9, 0.012, 3e-12, 1.6},
     {ppp::System::galileo, 3, 8, 29'600'300.0, radians(56.0), -5.6e-9, 0.0005, 1e-12, 0.8}}};

TransmitAntenna draw_antenna(double phase_centre, Random& random) {
  TransmitAntenna antenna;
  antenna.phase_centre = phase_centre + random.uniform(-0.2, 0.2);
  const double size = random.uniform(0.002, 0.006);
  for (std::size_t i = 0; i < antenna.variation.size(); ++i) {
    const double share = static_cast<double>(i) / 14.0;
    antenna.variation[i] = size * std::cos(1.5 * pi * share);
  }
  return antenna;
}

TrueSatellite draw_satellite(const OrbitPlan& plan, int number, int plane, double turned,
                             Random& random) {
  TrueSatellite s;
  s.satellite = {plan.system, static_cast<std::uint8_t>(number)};
  OrbitElements& o = s.orbit;
  o.semi_major_axis = plan.radius + random.uniform(-15e3, 15e3);
  o.eccentricity = plan.eccentricity * random.uniform(0.05, 1.0);
  o.inclination = plan.inclination + radians(random.uniform(-0.8, 0.8));
  o.node = turned + 2.0 * pi * plane / plan.planes + radians(random.uniform(-2.0, 2.0));
  o.perigee = random.uniform(-pi, pi);
  const double argument = 2.0 * pi * ((number - 1) % plan.in_plane) / plan.in_plane +
                          2.0 * pi * plane / (plan.planes * plan.in_plane);
  o.mean_anomaly = argument - o.perigee + radians(random.uniform(-8.0, 8.0));
  o.node_rate = plan.node_rate * random.uniform(0.97, 1.03);
  o.inclination_rate = random.uniform(-5e-10, 5e-10);
  o.crc = random.uniform(150.0, 300.0);
  o.crs = random.uniform(-100.0, 100.0);
  o.cuc = random.uniform(-5e-6, 5e-6);
  o.cus = random.uniform(5e-6, 1e-5);
  o.cic = random.uniform(-2e-7, 2e-7);
  o.cis = random.uniform(-2e-7, 2e-7);
  s.clock_offset = random.uniform(-4e-4, 4e-4);
  s.clock_drift = random.uniform(-5e-12, 5e-12);
  s.group_delay = random.uniform(-1.2e-8, 1.2e-8);
  for (TransmitAntenna& antenna : s.antennas) antenna = draw_antenna(plan.phase_centre, random);
  return s;
}

}  // namespace

double OrbitElements::mean_motion() const {
  constexpr double earth = 3.986004418e14;  // m^3/s^2
  return std::sqrt(earth / std::pow(semi_major_axis, 3));
}

Eigen::Vector3d OrbitElements::position(double t) const {
  const double mean = mean_anomaly + mean_motion() * t;
  double eccentric = mean;
  for (int i = 0; i < 10; ++i) eccentric = mean + eccentricity * std::sin(eccentric);
  const double y = std::sqrt(1.0 - eccentricity * eccentricity) * std::sin(eccentric);
  const double latitude = std::atan2(y, std::cos(eccentric) - eccentricity) + perigee;
  const double c2 = std::cos(2.0 * latitude), s2 = std::sin(2.0 * latitude);
  const double u = latitude + cuc * c2 + cus * s2;
  const double r =
      semi_major_axis * (1.0 - eccentricity * std::cos(eccentric)) + crc * c2 + crs * s2;
  const double i = inclination + inclination_rate * t + cic * c2 + cis * s2;
  const double n = node + (node_rate - ppp::earth_rotation_rate) * t;
  const Eigen::Vector3d ascending(std::cos(n), std::sin(n), 0.0);
  const Eigen::Vector3d ahead(-std::cos(i) * std::sin(n), std::cos(i) * std::cos(n), std::sin(i));
  return r * (std::cos(u) * ascending + std::sin(u) * ahead);
}

Eigen::Vector3d OrbitElements::velocity(double t) const {
  constexpr double h = 0.5;  // s
  return (8.0 * (position(t + h) - position(t - h)) -
          (position(t + 2.0 * h) - position(t - 2.0 * h))) /
         (12.0 * h);
}

Constellation::Constellation(double seconds, std::uint64_t seed) {
  for (const OrbitPlan& plan : plans) {
    Random random(seed, 20 + static_cast<std::uint64_t>(plan.system));
    const double turned = random.uniform(0.0, 2.0 * pi);
    for (int plane = 0; plane < plan.planes; ++plane)
      for (int i = 0; i < plan.in_plane; ++i) {
        const int number = plane * plan.in_plane + i + 1;
        satellites_.push_back(draw_satellite(plan, number, plane, turned, random));
        std::vector<double> walk{0.0};
        while (static_cast<double>(walk.size()) <= seconds + 2.0 * margin + 1.0)
          walk.push_back(walk.back() + plan.clock_walk * random.normal());
        walks_.push_back(std::move(walk));
      }
  }
}

double Constellation::clock(std::size_t satellite, double t) const {
  const TrueSatellite& s = satellites_[satellite];
  const std::vector<double>& walk = walks_[satellite];
  const double place = std::clamp(t + margin, 0.0, static_cast<double>(walk.size() - 1) - 1e-6);
  const auto i = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(i);
  return s.clock_offset + s.clock_drift * t + walk[i] + share * (walk[i + 1] - walk[i]);
}

double clock_relativity(const OrbitElements& orbit, double t) {
  const Eigen::Vector3d p = orbit.position(t), v = orbit.velocity(t);
  const Eigen::Vector3d turning(-p.y(), p.x(), 0.0);  // the frame's rotation
  return -2.0 * p.dot(v + ppp::earth_rotation_rate * turning) /
         (ppp::speed_of_light * ppp::speed_of_light);
}

std::array<char, 2> bands(ppp::System system) {
  return {'1', system == ppp::System::galileo ? '5' : '2'};
}

}  // namespace maploop::simulate
