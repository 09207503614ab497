#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

// This is a view onto two axes of the body: x to the right of the page, and y or z to its top.
struct View {
  const char* title;
  int up;            // 1: the body's y, seen from above; 2: its z, seen from the right side
  double top = 0.0;  // px, of the body's origin on the page
};

constexpr double scale = 100.0, margin = 60.0;  // px a metre, px

class Drawing {
 public:
  explicit Drawing(const vehicle::VehicleConfig& config) : d_(config.vehicle) {
    add("body, IMU", Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero());
    const auto sensor = [&](const char* name, const std::string& table, const auto& T,
                            const SensorPosition& p) {
      if (has_pose(config, table)) add(name, T, {p.forward_sigma, p.left_sigma, p.up_sigma});
    };
    const auto& [car, camera, lidar, imu, antenna] = d_;
    sensor("camera", "vehicle.camera", camera_pose(camera.position, camera.rotation),
           camera.position);
    sensor("LiDAR", "vehicle.lidar", sensor_pose(lidar.position, lidar.rotation), lidar.position);
    sensor("antenna", "vehicle.antenna", sensor_pose(antenna.position, {}), antenna.position);
    axle_ = {-car.rear_axle_distance, 0.0, car.rear_axle_height};
    measure();
  }

  std::string text() {
    View above{"from above", 1, margin + scale * most_.y()};
    View side{"from the right side", 2, 0.0};
    const double height = scale * (most_ - least_).y() + 2.0 * margin;
    side.top = height + margin + scale * most_.z();
    const double width = scale * (most_ - least_).x() + 2.0 * margin + 60.0;
    const double all = side.top - scale * least_.z() + margin;
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<title>The vehicle from above and from its right side</title>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, all);
    for (const View& view : {above, side}) draw(view, view.up == 1 ? 0.0 : height);
    return out_ + "</svg>\n";
  }

 private:
  struct Part {
    std::string name;
    Eigen::Isometry3d T;
    Eigen::Vector3d sigma;
  };

  void add(const std::string& name, const Eigen::Isometry3d& T, const Eigen::Vector3d& sigma) {
    parts_.push_back({name, T, sigma});
  }

  void measure() {
    const CarDescription& car = d_.car;
    const Eigen::Vector3d axle(std::max(car.wheel_radius, car.rear_axle_distance_sigma),
                               0.5 * car.track + 0.1, car.wheel_radius);
    least_ = axle_ - axle;
    most_ = axle_ + axle;
    for (const Part& part : parts_) {
      const Eigen::Vector3d size = part.sigma.cwiseMax(0.35);
      least_ = least_.cwiseMin(part.T.translation() - size);
      most_ = most_.cwiseMax(part.T.translation() + size);
    }
  }

  std::array<double, 2> at(const View& view, const Eigen::Vector3d& p) const {
    return {margin + scale * (p.x() - least_.x()), view.top - scale * p[view.up]};
  }

  void draw(const View& view, double top) {
    out_ += fmt::format("<text x=\"10\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n", top + 20.0,
                        view.title);
    draw_axle(view);
    double below = 15.0;  // px, of a name; those of neighbours are on different lines
    for (const Part& part : parts_) {
      const auto [x, y] = at(view, part.T.translation());
      const Eigen::Vector3d& s = part.sigma;
      if (s.x() > 0.0)
        out_ += fmt::format(
            "<ellipse cx=\"{:.1f}\" cy=\"{:.1f}\" rx=\"{:.1f}\" ry=\"{:.1f}\" fill=\"#8888ff\" "
            "fill-opacity=\"0.2\" stroke=\"#8888ff\"/>\n",
            x, y, scale * s.x(), scale * s[view.up]);
      constexpr std::array colours{"#d62728", "#2ca02c", "#1f77b4"};
      for (const int axis : {0, 1, 2})
        line(view, part.T.translation(),
             part.T * Eigen::Vector3d(0.3 * Eigen::Vector3d::Unit(axis)),
             colours[static_cast<std::size_t>(axis)], 2.0);
      out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", x, y);
      out_ +=
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 6.0, y + below, part.name);
      below = 43.0 - below;
    }
  }

  void draw_axle(const View& view) {
    const CarDescription& car = d_.car;
    const Eigen::Vector3d left(0.0, 0.5 * car.track, 0.0), ahead(car.wheel_radius, 0.0, 0.0);
    const auto [x, y] = at(view, axle_);
    if (view.up == 2) {
      out_ += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"gray\"/>\n", x,
          y, scale * car.wheel_radius);
    } else {
      line(view, axle_ - left, axle_ + left, "gray", 1.0);
      for (const double wheel : {-1.0, 1.0})
        line(view, axle_ + wheel * left - ahead, axle_ + wheel * left + ahead, "gray", 10.0);
    }
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"gray\">rear axle</text>\n", x + 6.0,
                        y - 6.0);
    const double sigma = car.rear_axle_distance_sigma;
    line(view, axle_ - Eigen::Vector3d(sigma, 0, 0), axle_ + Eigen::Vector3d(sigma, 0, 0),
         "#8888ff", 1.0);
  }

  void line(const View& view, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            const char* colour, double width) {
    const auto [x1, y1] = at(view, from);
    const auto [x2, y2] = at(view, to);
    out_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-width=\"{}\"/>\n",
        x1, y1, x2, y2, colour, width);
  }

  const VehicleDescription& d_;
  std::vector<Part> parts_;
  Eigen::Vector3d axle_, least_, most_;
  std::string out_;
};

}  // namespace

std::string drawing(const vehicle::VehicleConfig& config) {
  return Drawing(config).text();
}

}  // namespace maploop::vehicle_tool
