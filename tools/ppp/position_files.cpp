#include "tools/ppp/position_files.h"

#include <fmt/format.h>
#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "sensors/gnss/nmea.h"

namespace maploop::gnss {

using namespace maploop::ppp;
using sensors::nmea_angle_fields;
using sensors::nmea_sentence;

namespace {

double signed_root(double covariance) {
  return std::copysign(std::sqrt(std::abs(covariance)), covariance);
}

struct LocalSolution {
  Geodetic place;
  Eigen::Matrix3d covariance;  // east north up
  Eigen::Vector3d velocity;
};

LocalSolution local(const PppSolution& s) {
  const Geodetic place = geodetic_from_ecef(s.position);
  const Eigen::Matrix3d R = rotation_enu_ecef(place);
  return {place, R * s.covariance * R.transpose(), R * s.velocity};
}

// RTKLIB's quality: 1 for integer ambiguities, 6 for PPP without, 7 for dead reckoning.
int quality(const PppSolution& s) {
  if (s.bridged) return 7;
  return s.status == PppStatus::fixed ? 1 : 6;
}

// RTKLIB's ratio, which its columns limit.
double ratio(const PppSolution& s) {
  return s.status == PppStatus::fixed ? std::min(s.integers.ratio, 999.9) : 0.0;
}

std::string pos_stamp(GpsTime t) {
  std::string stamp = format_gps_time(t);
  stamp[4] = stamp[7] = '/';
  return stamp;
}

// "063001.00" and "220921", UTC.
std::pair<std::string, std::string> nmea_stamp(GpsTime t) {
  using namespace std::chrono;
  const std::string utc = format_time(Time(round<milliseconds>(to_utc(t).time_since_epoch())));
  return {utc.substr(11, 2) + utc.substr(14, 2) + utc.substr(17, 6),
          utc.substr(8, 2) + utc.substr(5, 2) + utc.substr(2, 2)};
}

template <class F>
void each_solved(const Solutions& solutions, F&& f) {
  for (const PppSolution& s : solutions) {
    if (s.has_position()) f(s, local(s));
  }
}

}  // namespace

std::string to_pos(const Solutions& solutions, bool ecef, const std::string& observations) {
  std::string text = "% program   : maploop ppp\n% inp file  : " + observations + "\n%\n";
  text += "% (" + std::string(ecef ? "x/y/z-ecef=WGS84" : "lat/lon/height=WGS84/ellipsoidal") +
          ",Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp,7:dr,ns=# of satellites)\n";
  text +=
      ecef ? "%  GPST                      x-ecef(m)      y-ecef(m)      z-ecef(m)   Q  ns   "
             "sdx(m)   "
             "sdy(m)   sdz(m)  sdxy(m)  sdyz(m)  sdzx(m) age(s)  ratio\n"
           : "%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   "
             "sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n";
  each_solved(solutions, [&](const PppSolution& s, const LocalSolution& l) {
    const std::string stamp = pos_stamp(s.time);
    if (ecef) {
      const auto& P = s.covariance;
      text += fmt::format(
          "{} {:14.4f} {:14.4f} {:14.4f} {:3} {:3} {:8.4f} {:8.4f} {:8.4f} {:8.4f} {:8.4f} {:8.4f} "
          "{:6.2f} {:6.1f}\n",
          stamp, s.position.x(), s.position.y(), s.position.z(), quality(s), s.satellites_used,
          std::sqrt(P(0, 0)), std::sqrt(P(1, 1)), std::sqrt(P(2, 2)), signed_root(P(0, 1)),
          signed_root(P(1, 2)), signed_root(P(2, 0)), 0.0, ratio(s));
    } else {
      const auto& P = l.covariance;
      text += fmt::format(
          "{} {:14.9f} {:14.9f} {:10.4f} {:3} {:3} {:8.4f} {:8.4f} {:8.4f} {:8.4f} {:8.4f} {:8.4f} "
          "{:6.2f} {:6.1f}\n",
          stamp, degrees(l.place.latitude), degrees(l.place.longitude), l.place.height, quality(s),
          s.satellites_used, std::sqrt(P(1, 1)), std::sqrt(P(0, 0)), std::sqrt(P(2, 2)),
          signed_root(P(1, 0)), signed_root(P(0, 2)), signed_root(P(2, 1)), 0.0, ratio(s));
    }
  });
  return text;
}

std::string to_nmea(const Solutions& solutions) {
  std::string text;
  each_solved(solutions, [&](const PppSolution& s, const LocalSolution& l) {
    const auto [clock, date] = nmea_stamp(s.time);
    const std::string place = nmea_angle_fields(l.place.latitude, 2, "NS") + ',' +
                              nmea_angle_fields(l.place.longitude, 3, "EW");
    // Estimated, integer, float.
    const int mode = s.bridged ? 6 : s.status == PppStatus::fixed ? 4 : 5;
    text += nmea_sentence(fmt::format("GNGGA,{},{},{},{:02},,{:.4f},M,,M,,", clock, place, mode,
                                      std::min(99, s.satellites_used), l.place.height));
    const double knots = l.velocity.head<2>().norm() / 0.514444;
    double course = degrees(std::atan2(l.velocity.x(), l.velocity.y()));
    if (course < 0.0) course += 360.0;
    text += nmea_sentence(fmt::format("GNRMC,{},A,{},{:.3f},{:.2f},{},,,{}", clock, place, knots,
                                      course, date, s.bridged ? 'E' : 'F'));
    const auto& P = l.covariance;
    const double half = 0.5 * (P(0, 0) + P(1, 1));
    const double spread = std::hypot(0.5 * (P(0, 0) - P(1, 1)), P(0, 1));
    double axis = degrees(0.5 * std::atan2(2.0 * P(0, 1), P(1, 1) - P(0, 0)));
    if (axis < 0.0) axis += 180.0;
    text += nmea_sentence(fmt::format("GNGST,{},,{:.4f},{:.4f},{:.2f},{:.4f},{:.4f},{:.4f}", clock,
                                      std::sqrt(half + spread),
                                      std::sqrt(std::max(0.0, half - spread)), axis,
                                      std::sqrt(P(1, 1)), std::sqrt(P(0, 0)), std::sqrt(P(2, 2))));
  });
  return text;
}

// A line has two points at least (RFC 7946, section 3.1.4).
std::string to_geojson(const Solutions& solutions) {
  std::string points, stamps;
  int count = 0;
  each_solved(solutions, [&](const PppSolution& s, const LocalSolution& l) {
    ++count;
    points += fmt::format("{}[{:.9f},{:.9f},{:.4f}]", points.empty() ? "" : ",",
                          degrees(l.place.longitude), degrees(l.place.latitude), l.place.height);
    const std::string utc = format_time(to_utc(s.time));
    stamps += fmt::format("{}\"{}T{}Z\"", stamps.empty() ? "" : ",", utc.substr(0, 10),
                          utc.substr(11, 12));
  });
  return R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"maploop ppp","coordTimes":[)" +
         stamps + R"(]},"geometry":)" +
         (count == 1 ? R"({"type":"Point","coordinates":)" + points
                     : R"({"type":"LineString","coordinates":[)" + points + ']') +
         "}}]}\n";
}

std::string to_kml(const Solutions& solutions) {
  std::string points;
  int count = 0;
  each_solved(solutions, [&](const PppSolution&, const LocalSolution& l) {
    ++count;
    points += fmt::format("{:.9f},{:.9f},{:.4f}\n", degrees(l.place.longitude),
                          degrees(l.place.latitude), l.place.height);
  });
  const std::string shape = count == 1 ? "Point" : "LineString";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml "
         "xmlns=\"http://www.opengis.net/kml/2.2\"><Document><name>maploop ppp</name><Placemark><" +
         shape + "><altitudeMode>clampToGround</altitudeMode><coordinates>\n" + points +
         "</coordinates></" + shape + "></Placemark></Document></kml>\n";
}

std::string to_residual_csv(const Solutions& solutions) {
  std::string text =
      "gps_time,satellite,azimuth_deg,elevation_deg,cn0_dbhz,code_used,phase_used,integer,"
      "code_residual_m,phase_residual_m,ionosphere_m,slip,refused\n";
  for (const PppSolution& s : solutions) {
    const std::string stamp = format_gps_time(s.time);
    for (const SatelliteReport& r : s.satellites) {
      text += fmt::format("{},{},{:.2f},{:.2f},{:.1f},{:d},{:d},{:d},{:.4f},{:.5f},{:.4f},{},{}\n",
                          stamp, to_string(r.satellite), degrees(r.azimuth), degrees(r.elevation),
                          r.cn0, r.code_used, r.phase_used, r.integer, r.code_residual,
                          r.phase_residual, r.ionosphere, to_string(r.slip), to_string(r.refused));
    }
  }
  return text;
}

}  // namespace maploop::gnss
