#include "tools/nav_files.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "tools/evaluation/text_file.h"

namespace maploop::tools {
namespace {

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
std::string format(const char* pattern, ...) {
  std::array<char, 512> line{};
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(line.data(), line.size(), pattern, arguments);
  va_end(arguments);
  return line.data();
}

constexpr double knots = 3600.0 / 1852.0;  // of m/s

std::string age(Time stamp, Time now) {
  return stamp == Time{} ? "" : format("%.3f", to_seconds(now - stamp));
}

double positive_degrees(double angle) {
  const double d = degrees(angle);
  return d < 0.0 ? d + 360.0 : d;
}

// ddmm.mmmmmmm,N: rounded as a whole, so that no 60 minutes come out.
std::string nmea_angle(double radians_value, int degree_digits, char positive, char negative) {
  constexpr std::int64_t per_minute = 10'000'000;
  const auto units =
      static_cast<std::int64_t>(std::llround(std::abs(degrees(radians_value)) * 60.0 * per_minute));
  const std::int64_t whole = units / (60 * per_minute);
  const std::int64_t rest = units % (60 * per_minute);
  return format("%0*lld%02lld.%07lld,%c", degree_digits, static_cast<long long>(whole),
                static_cast<long long>(rest / per_minute),
                static_cast<long long>(rest % per_minute),
                radians_value < 0.0 ? negative : positive);
}

struct Clock {
  int year, month, day, hour, minute;
  double second;
};

Clock clock_of(Time t) {
  // To hundredths first, so that no 60 seconds come out.
  const Time shown = std::chrono::round<std::chrono::duration<std::int64_t, std::centi>>(t);
  const auto day = std::chrono::floor<std::chrono::days>(shown);
  const std::chrono::year_month_day date(day);
  const double seconds = to_seconds(shown - day);
  const int whole = static_cast<int>(seconds);
  return {static_cast<int>(date.year()),
          static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())),
          whole / 3600,
          whole / 60 % 60,
          seconds - 60.0 * (whole / 60)};
}

std::string sentences(const NavState& state) {
  const Geodetic g = LocalFrame(state.origin).to_geodetic(state.position_enu);
  const Clock c = clock_of(state.stamp);
  const std::string time = format("%02d%02d%05.2f", c.hour, c.minute, c.second);
  const std::string place =
      nmea_angle(g.latitude, 2, 'N', 'S') + ',' + nmea_angle(g.longitude, 3, 'E', 'W');
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

  std::string text;
  // Heights are above the ellipsoid: no geoid, so the separation is empty.
  text += nmea_sentence("GNGGA," + time + ',' + place + (by_fix ? ",1" : ",6") +
                        format(",,,%.3f,M,,M,,", g.height));
  text += nmea_sentence(
      "GNRMC," + time + ",A," + place + format(",%.3f,%.2f,", v.norm() * knots, course) +
      format("%02d%02d%02d,,,", c.day, c.month, c.year % 100) + (by_fix ? "A" : "E"));
  text += nmea_sentence("GNGST," + time +
                        format(",,%.3f,%.3f,%.1f,%.3f,%.3f,%.3f", std::sqrt(mean + half),
                               std::sqrt(std::max(mean - half, 0.0)), positive_degrees(orientation),
                               std::sqrt(C(1, 1)), std::sqrt(C(0, 0)), std::sqrt(C(2, 2))));
  text += nmea_sentence(format("GNHDT,%.3f,T", positive_degrees(state.attitude.azimuth)));
  return text;
}

const char* status_name(NavStatus status) {
  return status == NavStatus::aided ? "aided" : "coasting";
}

}  // namespace

std::string nmea_sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return '$' + body + format("*%02X\r\n", sum);
}

std::string nmea_sentences(const GnssFix& fix) {
  const Geodetic& g = fix.position;
  const Clock c = clock_of(fix.stamp);
  const std::string time = format("%02d%02d%05.2f", c.hour, c.minute, c.second);
  const std::string place =
      nmea_angle(g.latitude, 2, 'N', 'S') + ',' + nmea_angle(g.longitude, 3, 'E', 'W');
  const Eigen::Vector3d sigma = fix.position_covariance.diagonal().cwiseSqrt();
  const Eigen::Vector2d v = fix.velocity_enu.head<2>();
  return nmea_sentence("GNGST," + time +
                       format(",,,,,%.3f,%.3f,%.3f", sigma.y(), sigma.x(), sigma.z())) +
         nmea_sentence("GNGGA," + time + ',' + place +
                       format(",1,12,1.0,%.3f,M,0.0,M,,", g.height)) +
         nmea_sentence(
             "GNRMC," + time + ",A," + place +
             format(",%.3f,%.2f,", v.norm() * knots, positive_degrees(std::atan2(v.x(), v.y()))) +
             format("%02d%02d%02d,,,A", c.day, c.month, c.year % 100));
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
    text += format("%lld.%09lld,%s,", static_cast<long long>(ns / 1'000'000'000),
                   static_cast<long long>(ns % 1'000'000'000), status_name(s.status));
    text += format("%.9f,%.9f,%.3f,%.3f,%.3f,%.3f,", degrees(g.latitude), degrees(g.longitude),
                   g.height, s.position_enu.x(), s.position_enu.y(), s.position_enu.z());
    text += format("%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,", s.velocity_enu.x(), s.velocity_enu.y(),
                   s.velocity_enu.z(), positive_degrees(s.attitude.azimuth),
                   degrees(s.attitude.pitch), degrees(s.attitude.roll));
    text += format("%.3f,%.2f,%.3f,%.3f,%.3f,%.3f,%.4f,", s.forward_speed,
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
