#include "tools/odometry/lidar_page.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sensors/image/png.h"
#include "tools/odometry/summary.h"
#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::odometry {
namespace {

constexpr double most_px = 1600.0;  // px, longer side of the picture

// The transform to the picture's pixels: x of the first frame's body points right, y up.
struct View {
  Eigen::Vector2d low, high;  // m
  double scale;               // px / m

  View(const PointCloud& cloud, const std::vector<LidarStep>& steps)
      : low(1e9, 1e9), high(-1e9, -1e9) {
    const auto take = [this](const Eigen::Vector2d& p) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    };
    for (const lidar::SurfacePoint& point : cloud.points())
      take(point.position.head<2>().cast<double>());
    for (const LidarStep& step : steps) take(step.pose.translation().head<2>());
    scale = std::min(5.0, most_px / std::max(1.0, (high - low).maxCoeff()));
  }
  // The path runs from left to right, because most drives are longer than wide.
  cv::Size size() const {
    return {std::max(1, static_cast<int>(scale * (high.x() - low.x())) + 1),
            std::max(1, static_cast<int>(scale * (high.y() - low.y())) + 1)};
  }
  cv::Point at(const Eigen::Vector2d& p) const {
    return {static_cast<int>(scale * (p.x() - low.x())),
            static_cast<int>(scale * (high.y() - p.y()))};
  }
};

// Draws the ground in grey; upright surfaces range from blue (low) to red (4 m and more above the
// ground).
cv::Mat from_above(const PointCloud& cloud, const std::vector<LidarStep>& steps) {
  const View view(cloud, steps);
  cv::Mat hue(view.size(), CV_8UC3, cv::Scalar(0, 0, 255));
  constexpr float upright = 0.7f;   // vertical part of the normal; a smaller one is a wall
  constexpr float highest = 4.0f;   // m
  constexpr float of_body = -0.9f;  // m, height of the ground relative to the vehicle's origin
  for (const lidar::SurfacePoint& point : cloud.points()) {
    auto& pixel = hue.at<cv::Vec3b>(view.at(point.position.head<2>().cast<double>()));
    const float above =
        std::clamp((point.position.z() - of_body) / highest, 0.0f, 1.0f);  // above the first ground
    if (std::abs(point.normal.z()) < upright) {
      pixel = {static_cast<std::uint8_t>(120.0f * (1.0f - above)), 255, 200};
    } else if (pixel[1] == 0) {
      pixel = {0, 0, 200};
    }
  }
  cv::Mat picture;
  cv::cvtColor(hue, picture, cv::COLOR_HSV2BGR);
  for (std::size_t i = 1; i < steps.size(); ++i)
    cv::line(picture, view.at(steps[i - 1].pose.translation().head<2>()),
             view.at(steps[i].pose.translation().head<2>()), {0, 0, 0}, 2, cv::LINE_AA);
  return picture;
}

}  // namespace

std::string lidar_page(const std::string& heading, const std::vector<LidarStep>& steps,
                       const PointCloud& cloud) {
  const cv::Mat picture = from_above(cloud, steps);
  cv::Mat rgb;
  cv::cvtColor(picture, rgb, cv::COLOR_BGR2RGB);
  const std::vector<std::uint8_t> png =
      sensors::encode_png({rgb.data, 3 * rgb.total()}, rgb.cols, rgb.rows);
  std::string body = "<pre>" + web::escaped(summary(steps)) + "</pre>\n";
  body += "<h2>What the scans saw, from above</h2><p>" + std::to_string(cloud.size()) +
          " surfaces; grey: lying; blue to red: standing, from the ground to 4 m above that under "
          "the first frame; black: the way, from left to right as the vehicle stood at first.</p>" +
          web::image(png, "png", picture.cols) + "\n";
  web::Line height{"body", {}, {}};
  double way = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0) way += (steps[i].pose.translation() - steps[i - 1].pose.translation()).norm();
    height.x.push_back(way);
    height.y.push_back(steps[i].pose.translation().z());
  }
  const web::Plot heights{"Height over the first frame", "way, m", "m", {height}};
  return web::Page(heading).add(body).add(heights).text();
}

}  // namespace maploop::odometry
