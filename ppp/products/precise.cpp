#include "ppp/products/precise.h"

#include <algorithm>
#include <cmath>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

constexpr std::size_t nodes = 11;  // of the interpolating polynomial

// Clocks are interpolated linearly across gaps of up to this length.
constexpr Duration longest_clock_gap = std::chrono::seconds(910);

// Returns the walk of a clock, m/sqrt(s). Second differences of a random walk over steps of T have
// twice the variance of one step. The median is not affected by jumps and gaps.
double walk_of(const std::vector<ClockFile::Point>& clock) {
  constexpr Duration close = std::chrono::seconds(60);
  std::vector<double> differences;
  for (std::size_t i = 2; i < clock.size(); ++i) {
    const Duration step = clock[i].time - clock[i - 1].time;
    if (step <= close || step > longest_clock_gap ||
        step != clock[i - 1].time - clock[i - 2].time) {
      continue;
    }
    const double bend = clock[i].offset - 2.0 * clock[i - 1].offset + clock[i - 2].offset;
    differences.push_back(std::abs(bend) / std::sqrt(2.0 * to_seconds(step)));
  }
  if (differences.empty()) return 0.0;
  constexpr double sigma_of_median = 1.4826;  // ratio for normal errors
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return speed_of_light * sigma_of_median * *middle;
}

// Attitudes are interpolated across gaps of up to this length.
constexpr Duration longest_attitude_gap = std::chrono::seconds(910);

// Sorts points by time. Of two with the same time the first is kept.
void put_in_order(auto& list) {
  const auto before = [](const auto& a, const auto& b) { return a.time < b.time; };
  if (!std::is_sorted(list.begin(), list.end(), before)) {
    std::stable_sort(list.begin(), list.end(), before);
  }
  list.erase(std::unique(list.begin(), list.end(),
                         [](const auto& a, const auto& b) { return a.time == b.time; }),
             list.end());
}

// A wide lane is stated for the day around its time.
constexpr Duration half_a_day = std::chrono::hours(12);

// Returns the biases of two phases, m, whose ionosphere-free combination is zero, because the
// clocks contain it, and whose wide lane is the given one (Melbourne-Wuebbena without codes).
std::array<double, 2> biases_of_wide_lane(double cycles, double f1, double f2) {
  const double weight1 = f1 * f1 / (f1 * f1 - f2 * f2), weight2 = 1.0 - weight1;
  const double second = cycles * speed_of_light / (f1 * weight2 / weight1 + f2);
  return {-second * weight2 / weight1, second};
}

}  // namespace

PreciseEphemeris::PreciseEphemeris(const std::vector<OrbitFile>& orbits,
                                   const std::vector<ClockFile>& clocks,
                                   const std::vector<BiasFile>& biases) {
  const bool clocks_of_orbits = clocks.empty();
  for (const OrbitFile& file : orbits) {
    orbit_interval_ = std::max(orbit_interval_, file.interval);
    for (const auto& [satellite, points] : file.points) {
      auto& orbit = orbits_[satellite.slot()];
      auto& clock = clocks_[satellite.slot()];
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].position.norm() > 0.0) {
          orbit.push_back({file.epochs[i], points[i].position});
        }
        if (clocks_of_orbits && points[i].has_clock) {
          clock.push_back({file.epochs[i], points[i].clock});
        }
      }
    }
  }
  for (const ClockFile& file : clocks) {
    for (const auto& [satellite, points] : file.points) {
      auto& clock = clocks_[satellite.slot()];
      clock.insert(clock.end(), points.begin(), points.end());
    }
    for (const ClockFile::WideLane& w : file.wide_lanes) {
      wide_lanes_[w.satellite.slot()].push_back(w);
      has_phase_biases_ = true;
    }
  }
  for (auto& list : orbits_) put_in_order(list);
  for (auto& list : clocks_) put_in_order(list);
  std::transform(clocks_.begin(), clocks_.end(), clock_walk_.begin(), walk_of);
  for (const BiasFile& file : biases) {
    for (const SignalBias& bias : file.biases) {
      biases_[bias.satellite.slot()].push_back(bias);
      has_phase_biases_ |= bias.signal[0] == 'L';
    }
  }
}

std::size_t PreciseEphemeris::use_attitudes(const std::vector<AttitudeFile>& files) {
  const double least_cosine = std::cos(0.1);  // of the angle between the antenna's axis and nadir
  std::size_t wrong = 0;
  for (const AttitudeFile& file : files) {
    for (const auto& [satellite, points] : file.points) {
      for (const AttitudeFile::Point& point : points) {
        const auto place = position(satellite, point.time, nullptr);
        if (!place) continue;
        const Eigen::Vector3d axis = point.R_ecef_body * Eigen::Vector3d::UnitZ();
        if (axis.dot(-place->normalized()) >= least_cosine) {
          attitudes_[satellite.slot()].push_back(point);
        } else {
          ++wrong;
        }
      }
    }
  }
  for (auto& list : attitudes_) put_in_order(list);
  return wrong;
}

std::optional<Eigen::Quaterniond> PreciseEphemeris::attitude(Satellite satellite, GpsTime t) const {
  const auto& points = attitudes_[satellite.slot()];
  const auto next = std::ranges::lower_bound(points, t, {}, &AttitudeFile::Point::time);
  if (next == points.end()) return {};
  if (next->time == t) return next->R_ecef_body;
  if (next == points.begin()) return {};
  const auto last = std::prev(next);
  if (next->time - last->time > longest_attitude_gap) return {};
  const double share = to_seconds(t - last->time) / to_seconds(next->time - last->time);
  return last->R_ecef_body.slerp(share, next->R_ecef_body);
}

std::optional<Eigen::Vector3d> PreciseEphemeris::position(Satellite satellite, GpsTime t,
                                                          Eigen::Vector3d* velocity) const {
  const auto& points = orbits_[satellite.slot()];
  if (points.size() < nodes || t < points.front().time || t > points.back().time) return {};
  const auto after = std::upper_bound(points.begin(), points.end(), t,
                                      [](GpsTime m, const OrbitPoint& p) { return m < p.time; });
  const auto middle = static_cast<std::size_t>(after - points.begin());
  const std::size_t first =
      std::min(middle > nodes / 2 + 1 ? middle - nodes / 2 - 1 : 0, points.size() - nodes);
  // A gap inside would make the polynomial wrong without any sign of it.
  if (points[first + nodes - 1].time - points[first].time >
      orbit_interval_ * static_cast<int>(nodes - 1)) {
    return {};
  }
  // This is Lagrange's polynomial and its derivative, in units of the interval.
  const double unit = to_seconds(orbit_interval_);
  std::array<double, nodes> x{}, offset{};
  for (std::size_t i = 0; i < nodes; ++i) {
    offset[i] = to_seconds(t - points[first + i].time);
    x[i] = offset[i] / unit;
  }
  Eigen::Vector3d p = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < nodes; ++i) {
    double weight = 1.0, slope = 0.0;  // product, and derivative of the product
    for (std::size_t k = 0; k < nodes; ++k) {
      if (k == i) continue;
      const double inverse = 1.0 / (x[k] - x[i]);
      slope = slope * x[k] * inverse + weight * inverse;
      weight *= x[k] * inverse;
    }
    // Each point is rotated into the earth-fixed frame of moment t.
    const Eigen::Vector3d& q = points[first + i].position;
    const double angle = earth_rotation_rate * offset[i];
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d turned(c * q.x() + s * q.y(), -s * q.x() + c * q.y(), q.z());
    // A point at rest appears to move backwards as the frame rotates.
    const Eigen::Vector3d turning(earth_rotation_rate * turned.y(),
                                  -earth_rotation_rate * turned.x(), 0.0);
    p += weight * turned;
    v += slope / unit * turned + weight * turning;
  }
  if (velocity) *velocity = v;
  return p;
}

std::optional<double> PreciseEphemeris::clock(Satellite satellite, GpsTime t) const {
  const auto& points = clocks_[satellite.slot()];
  auto after = std::lower_bound(points.begin(), points.end(), t,
                                [](const ClockFile::Point& p, GpsTime m) { return p.time < m; });
  if (after == points.end()) return {};
  if (after->time == t) return after->offset;
  if (after == points.begin()) {
    // Signals that arrive at midnight were sent before the file's first clock.
    if (points.size() < 2 || after->time - t > std::chrono::seconds(1)) return {};
    ++after;
  }
  const auto before = after - 1;
  if (after->time - before->time > longest_clock_gap) return {};
  const double share = to_seconds(t - before->time) / to_seconds(after->time - before->time);
  return before->offset + share * (after->offset - before->offset);
}

std::optional<SatelliteState> PreciseEphemeris::at(Satellite satellite, GpsTime t) const {
  const auto offset = clock(satellite, t);
  if (!offset) return {};
  SatelliteState state;
  const auto p = position(satellite, t, &state.velocity);
  if (!p) return {};
  state.position = *p;
  // The relativistic correction uses the velocity relative to the inertial frame.
  const Eigen::Vector3d inertial =
      state.velocity +
      Eigen::Vector3d(-earth_rotation_rate * p->y(), earth_rotation_rate * p->x(), 0.0);
  state.clock = *offset - 2.0 * p->dot(inertial) / (speed_of_light * speed_of_light);
  const auto later = clock(satellite, t + std::chrono::seconds(1));
  state.clock_drift = later ? *later - *offset : 0.0;
  return state;
}

double PreciseEphemeris::error_walk(Satellite satellite) const {
  return clock_walk_[satellite.slot()];
}

double PreciseEphemeris::code_bias(Satellite satellite, char band, char attribute,
                                   GpsTime t) const {
  const char name[3] = {'C', band, attribute};
  const std::string_view wanted(name, 3);
  for (const SignalBias& bias : biases_[satellite.slot()]) {
    if (t < bias.from || t >= bias.until) continue;
    if (bias.second.empty() && bias.signal == wanted) return bias.metres;
    // GPS's clocks refer to P(Y): another code of the carrier differs from it by their differential
    // bias.
    const bool same_band =
        bias.second.size() == 3 && bias.signal[1] == band && bias.second[1] == band;
    if (same_band && bias.second == wanted && bias.signal[2] == 'W') return -bias.metres;
    if (same_band && bias.signal == wanted && bias.second[2] == 'W') return bias.metres;
  }
  return 0.0;
}

// Files that keep the clocks' own codes at zero contain only what other codes of the same carrier
// differ by.
std::optional<double> PreciseEphemeris::ionosphere_bias(Satellite satellite, GpsTime t) const {
  const auto of_code = [](const SignalBias& bias) {
    return bias.signal[0] == 'C' && bias.second.empty();
  };
  const auto& biases = biases_[satellite.slot()];
  const bool known = std::any_of(biases.begin(), biases.end(), of_code) &&
                     std::none_of(biases.begin(), biases.end(), [&](const SignalBias& bias) {
                       return of_code(bias) && bias.metres == 0.0;
                     });
  if (known) return 0.0;
  if (messages_ == nullptr || !messages_->at(satellite, t)) return {};
  const auto [band1, band2] = bands_of(satellite.system);
  const double f1 = carrier_frequency(satellite.system, band1);
  const double f2 = carrier_frequency(satellite.system, band2);
  if (f1 == 0.0 || f2 == 0.0) return {};
  const double difference = messages_->code_bias(satellite, band1, ' ', t) -
                            messages_->code_bias(satellite, band2, ' ', t);
  const double l1 = carrier_frequency(System::gps, '1');
  return difference / (l1 * l1 * (1.0 / (f1 * f1) - 1.0 / (f2 * f2)));
}

std::optional<double> PreciseEphemeris::phase_bias(Satellite satellite, char band, char attribute,
                                                   GpsTime t) const {
  const char name[3] = {'L', band, attribute};
  for (const SignalBias& bias : biases_[satellite.slot()]) {
    if (bias.signal == std::string_view(name, 3) && t >= bias.from && t < bias.until)
      return bias.metres;
  }
  const auto bands = bands_of(satellite.system);
  const std::size_t carrier = band == bands[0] ? 0 : 1;
  if (band != bands[carrier]) return {};
  for (const ClockFile::WideLane& w : wide_lanes_[satellite.slot()]) {
    if (t - w.time > half_a_day || w.time - t > half_a_day) continue;
    return biases_of_wide_lane(w.cycles, carrier_frequency(satellite.system, bands[0]),
                               carrier_frequency(satellite.system, bands[1]))[carrier];
  }
  return {};
}

std::string PreciseEphemeris::missing(Satellite satellite, GpsTime t) const {
  if (!position(satellite, t, nullptr)) {
    return "no precise orbit for " + to_string(satellite) + " at " + format_gps_time(t);
  }
  const auto& points = clocks_[satellite.slot()];
  const auto after =
      std::lower_bound(points.begin(), points.end(), t,
                       [](const ClockFile::Point& p, GpsTime m) { return p.time < m; });
  std::string text = "no clocks for " + to_string(satellite);
  if (points.empty()) return text;
  if (after == points.end()) return text + " after " + format_gps_time(points.back().time);
  if (after == points.begin()) return text + " before " + format_gps_time(points.front().time);
  return text + " between " + format_gps_time((after - 1)->time) + " and " +
         format_gps_time(after->time);
}

}  // namespace maploop::ppp
