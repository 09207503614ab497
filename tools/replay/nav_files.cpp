#include "tools/replay/nav_files.h"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <string>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "sensors/gnss/nmea.h"
#include "tools/evaluate/text_file.h"

namespace maploop::tools {
namespace {

using sensors::nmea_sentence;

constexpr double knots = 3600.0 / 1852.0;  // of m/s

std::string age(Time stamp, Time now) {
  return stamp == Time{} ? "" : fmt::format("{:.3f}", to_seconds(now - stamp));
}

double positive_degrees(double angle) {
  const double d = degrees(angle);
  return d < 0.0 ? d + 360.0 : d;
}

std::string place_fields(const Geodetic& g) {
  return sensors::nmea_angle_fields(g.latitude, 2, "NS") + ',' +
         sensors::nmea_angle_fields(g.longitude, 3, "EW");
}

// "063001.00" and "220921".
struct Moment {
  std::string time, date;

  // Rounded to hundredths first, so that no 60 seconds come out.
  explicit Moment(Time t) {
    using Hundredths = std::chrono::duration<std::int64_t, std::centi>;
    const std::string utc = format_time(std::chrono::round<Hundredths>(t));
    time = utc.substr(11, 2) + utc.substr(14, 2) + utc.substr(17, 5);
    date = utc.substr(8, 2) + utc.substr(5, 2) + utc.substr(2, 2);
  }
};

std::string sentences(const NavState& state) {
  const Geodetic g = LocalFrame(state.origin).to_geodetic(state.position_enu);
  const auto [time, date] = Moment(state.stamp);
  const std::string place = place_fields(g);
  const bool by_fix =
      state.gnss_stamp != Time{} && state.stamp - state.gnss_stamp < std::chrono::seconds(2);
  const Eigen::Vector2d v = state.velocity_enu.head<2>();
  const double course = v.norm() > 0.1 ? positive_degrees(std::atan2(v.x(), v.y()))
                                       : positive_degrees(state.attitude.azimuth);
  // The ellipse of the horizontal error; its orientation is from north.
  const auto& C = state.covariance;
  const double mean = 0.5 * (C(0, 0) + C(1, 1));
  const double half = std::hypot(0.5 * (C(0, 0) - C(1, 1)), C(0, 1));
  const double orientation = 0.5 * std::atan2(2.0 * C(0, 1), C(1, 1) - C(0, 0));

  // Heights are above the ellipsoid: no geoid, so the separation is empty.
  return nmea_sentence(
             fmt::format("GNGGA,{},{},{},,,{:.3f},M,,M,,", time, place, by_fix ? 1 : 6, g.height)) +
         nmea_sentence(fmt::format("GNRMC,{},A,{},{:.3f},{:.2f},{},,,{}", time, place,
                                   v.norm() * knots, course, date, by_fix ? 'A' : 'E')) +
         nmea_sentence(fmt::format("GNGST,{},,{:.3f},{:.3f},{:.1f},{:.3f},{:.3f},{:.3f}", time,
                                   std::sqrt(mean + half), std::sqrt(std::max(mean - half, 0.0)),
                                   positive_degrees(orientation), std::sqrt(C(1, 1)),
                                   std::sqrt(C(0, 0)), std::sqrt(C(2, 2)))) +
         (state.status == NavStatus::without_course
              ? std::string()
              : nmea_sentence(
                    fmt::format("GNHDT,{:.3f},T", positive_degrees(state.attitude.azimuth))));
}

}  // namespace

std::string nmea_sentences(const GnssFix& fix) {
  const Geodetic& g = fix.position;
  const auto [time, date] = Moment(fix.stamp);
  const std::string place = place_fields(g);
  const Eigen::Vector3d sigma = fix.position_covariance.diagonal().cwiseSqrt();
  const Eigen::Vector2d v = fix.velocity_enu.head<2>();
  return nmea_sentence(fmt::format("GNGST,{},,,,,{:.3f},{:.3f},{:.3f}", time, sigma.y(), sigma.x(),
                                   sigma.z())) +
         nmea_sentence(
             fmt::format("GNGGA,{},{},1,12,1.0,{:.3f},M,0.0,M,,", time, place, g.height)) +
         nmea_sentence(fmt::format("GNRMC,{},A,{},{:.3f},{:.2f},{},,,A", time, place,
                                   v.norm() * knots, positive_degrees(std::atan2(v.x(), v.y())),
                                   date));
}

void write_nav_csv(const std::filesystem::path& file, const fusion_score::NavTrack& track) {
  std::string text =
      "stamp,status,latitude,longitude,height,east,north,up,velocity_east,velocity_north,"
      "velocity_up,azimuth,pitch,roll,forward_speed,gyro_bias,sigma_east,sigma_north,sigma_up,"
      "sigma_speed,sigma_azimuth,odometry_age,gnss_age,wheel_age,zero_velocity_age\n";
  for (const NavState& s : track.states()) {
    const Geodetic g = LocalFrame(s.origin).to_geodetic(s.position_enu);
    const auto& C = s.covariance;
    const Eigen::Vector2d v = s.velocity_enu.head<2>();
    const Eigen::Vector2d along = v.norm() > 0.1 ? Eigen::Vector2d(v.normalized())
                                                 : Eigen::Vector2d(std::sin(s.attitude.azimuth),
                                                                   std::cos(s.attitude.azimuth));
    const double speed_variance = along.dot(C.block<2, 2>(3, 3) * along);
    const std::int64_t ns = to_nanoseconds(s.stamp);
    text +=
        fmt::format("{}.{:09},{},", ns / 1'000'000'000, ns % 1'000'000'000, to_string(s.status));
    text += fmt::format("{:.9f},{:.9f},{:.3f},{:.3f},{:.3f},{:.3f},", degrees(g.latitude),
                        degrees(g.longitude), g.height, s.position_enu.x(), s.position_enu.y(),
                        s.position_enu.z());
    text +=
        fmt::format("{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{:.4f},", s.velocity_enu.x(),
                    s.velocity_enu.y(), s.velocity_enu.z(), positive_degrees(s.attitude.azimuth),
                    degrees(s.attitude.pitch), degrees(s.attitude.roll));
    text += fmt::format("{:.3f},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},", s.forward_speed,
                        degrees(s.gyro_bias) * 3600.0, std::sqrt(C(0, 0)), std::sqrt(C(1, 1)),
                        std::sqrt(C(2, 2)), std::sqrt(std::max(speed_variance, 0.0)),
                        degrees(std::sqrt(C(6, 6))));
    text += age(s.odometry_stamp, s.stamp) + ',' + age(s.gnss_stamp, s.stamp) + ',' +
            age(s.wheel_stamp, s.stamp) + ',' + age(s.zero_velocity_stamp, s.stamp) + '\n';
  }
  evaluation::write_text(file, text);
}

void write_nmea(const std::filesystem::path& file, const fusion_score::NavTrack& track) {
  std::string text;
  Time next = Time::min();
  for (const NavState& s : track.states()) {
    if (s.stamp < next) continue;
    text += sentences(s);
    next = std::chrono::floor<std::chrono::seconds>(s.stamp) + std::chrono::seconds(1);
  }
  evaluation::write_text(file, text);
}

}  // namespace maploop::tools
