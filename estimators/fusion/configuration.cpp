#include "estimators/fusion/configuration.h"

#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

namespace maploop::fusion {
namespace {

struct Named {
  std::string_view name;
  bool lidar, odometry_speed, odometry_azimuth, wheel_speed;
};
constexpr std::array<Named, 5> plain{{{"VO-RI", false, true, true, false},
                                      {"VO-L-RI", true, true, true, false},
                                      {"RISS", false, false, false, true},
                                      {"RISS-VO", false, false, true, true},
                                      {"RI", false, false, false, false}}};
constexpr std::string_view with_gnss = "GNSS+";
constexpr Named whatever_there_is{"auto", true, true, true, false};
constexpr std::string_view gnss_alone = "GNSS";

std::string plain_form(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (c != ' ') name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  if (name == "GPS" || name.starts_with("GPS+")) name.replace(0, 3, "GNSS");
  return name;
}

// Without a speed sensor the speed is the integral of the forward force, so the noise must be that
// of the road: its grade changes by 1 deg (1 sigma) within ten seconds. With odometry, wider noise
// lets each motion level the body. (Chosen on the Oakville drives 1, 3, 5, 7, 9.) Where fixes are
// all there is, such as before the mount of the unit is known, ten of them are many.
void set_inertial_speed(bool inertial_speed, FusionParameters& p) {
  FusionParameters chosen;
  if (inertial_speed) {
    chosen.acceleration_noise = 0.15;  // m/s/sqrt(s)
    chosen.pitch_noise = 0.005;        // rad/sqrt(s)
    chosen.roll_noise = 0.006;         // rad/sqrt(s)
    chosen.restart_after = 10;
  }
  p.acceleration_noise = chosen.acceleration_noise;
  p.pitch_noise = chosen.pitch_noise;
  p.roll_noise = chosen.roll_noise;
  p.restart_after = chosen.restart_after;
}

}  // namespace

std::vector<std::string> configuration_names() {
  std::vector<std::string> names{std::string(whatever_there_is.name)};
  for (const Named& n : plain) names.emplace_back(n.name);
  for (const Named& n : plain) names.push_back(std::string(with_gnss) + std::string(n.name));
  names.emplace_back(gnss_alone);
  return names;
}

Configuration configuration(std::string_view text) {
  const std::string name = plain_form(text);
  const auto made_of = [](const Named& n, std::string called, bool gnss) -> Configuration {
    return {std::move(called),  true,         n.lidar, gnss, n.odometry_speed,
            n.odometry_azimuth, n.wheel_speed};
  };
  if (name == "AUTO") return made_of(whatever_there_is, std::string(whatever_there_is.name), true);
  if (name == gnss_alone) return {name, false, false, true, false, false, false};
  const bool gnss = name.starts_with(with_gnss);
  const std::string_view rest = std::string_view(name).substr(gnss ? with_gnss.size() : 0);
  for (const Named& n : plain) {
    if (rest == n.name) return made_of(n, name, gnss);
  }
  std::string all;
  for (const std::string& n : configuration_names()) all += (all.empty() ? "" : ", ") + n;
  throw std::invalid_argument("no configuration is called '" + std::string(text) + "'; there are " +
                              all);
}

void apply(const Configuration& configuration, FusionParameters& p) {
  p.use_gnss = configuration.gnss;
  p.use_odometry_speed = configuration.odometry_speed;
  p.use_odometry_azimuth = configuration.odometry_azimuth;
  p.use_wheel_speed = configuration.wheel_speed;
  const bool inertial_speed = !configuration.odometry_speed && !configuration.wheel_speed;
  if (inertial_speed || p.speed_from_turns) set_inertial_speed(inertial_speed, p);
  p.still_by_inertia = p.speed_from_turns = inertial_speed;
  if (inertial_speed) {
    p.speed_scale_sigma = 1e-6;  // there is no sensor that a scale would be of
    p.speed_scale_walk = 0.0;
    return;
  }
  p.speed_scale_sigma = configuration.wheel_speed ? 0.02 : 0.015;  // for tyres; for disparities
  p.speed_scale_walk =
      configuration.wheel_speed ? 1.2e-4 : 1e-3;  // 1/sqrt(s); tyres change as they warm up
}

void apply_grade(std::string_view grade, FusionParameters& p) {
  if (grade == "tactical") return;
  if (grade != "mems") {
    throw std::invalid_argument("no grade of inertial sensors is called '" + std::string(grade) +
                                "'; there are tactical, mems");
  }
  p.gyro_noise = 8.7e-5;                // rad/sqrt(s), 0.3 deg/sqrt(h)
  p.gyro_turn_on_sigma = 1.45e-3;       // rad/s, 300 deg/h
  p.gyro_bias_sigma = 4.8e-5;           // rad/s, 10 deg/h
  p.gyro_bias_time = 300.0;             // s
  p.gyro_scale_sigma = 0.0036;          // 1, root sum square of the recorded unit's and 0.2 %
  p.accelerometer_turn_on_sigma = 0.2;  // m/s^2, 20 mg
}

}  // namespace maploop::fusion
