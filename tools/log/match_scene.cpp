#include "tools/log/match_scene.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace maploop::lcm_log {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using foxglove::SceneColor, foxglove::SceneLine;

constexpr SceneColor road_color{0.106, 0.686, 0.478}, state_color{0.890, 0.286, 0.282};
constexpr double drawn_length = 15.0;  // m ahead and behind, over which map_match_t states the bend
constexpr double height_of_text = 4.0;      // m above the body
constexpr std::size_t most_candidates = 3;  // that are written as text

Vector3d on_ground(const Vector2d& p) {
  return {p.x(), p.y(), 0.0};
}

SceneLine ellipse(const Eigen::Matrix2d& covariance) {
  constexpr int corners = 36;
  constexpr double sigmas = 3.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const Vector2d lengths = sigmas * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  SceneLine line{.points = {}, .color = state_color, .closed = true};
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    line.points.push_back(on_ground(
        axes.eigenvectors() * lengths.cwiseProduct(Vector2d(std::cos(angle), std::sin(angle)))));
  }
  return line;
}

// Returns a line that runs `right` metres to the right of the road's middle. The road is an arc
// through the matched point, so that the chord to a point `s` metres along has turned by half of
// what the road has.
SceneLine along_road(const maploop_lcm::map_match_t& m, double right) {
  constexpr int pieces = 20;
  const double curvature = m.bend / (2.0 * drawn_length);
  const Vector2d matched(m.matched_enu[0] - m.vehicle_enu[0], m.matched_enu[1] - m.vehicle_enu[1]);
  SceneLine line{.points = {}, .color = road_color};
  for (int i = 0; i <= pieces; ++i) {
    const double s = drawn_length * (2.0 * i / pieces - 1.0);
    const double chord = m.link_azimuth + curvature * s / 2.0;
    const double azimuth = m.link_azimuth + curvature * s;
    line.points.push_back(on_ground(matched + s * Vector2d(std::sin(chord), std::cos(chord)) +
                                    right * Vector2d(std::cos(azimuth), -std::sin(azimuth))));
  }
  return line;
}

std::string candidates_text(const maploop_lcm::map_match_t& m) {
  std::string text;
  for (std::size_t i = 0; i < std::min(m.candidates.size(), most_candidates); ++i) {
    text += fmt::format("{}{}: {:.2f}", i > 0 ? "\n" : "", m.candidates[i].road,
                        m.candidates[i].probability);
  }
  return text;
}

}  // namespace

foxglove::SceneUpdate match_scene(const maploop_lcm::map_match_t& match) {
  Eigen::Matrix2d covariance;
  covariance << match.covariance[0][0], match.covariance[0][1], match.covariance[1][0],
      match.covariance[1][1];
  foxglove::SceneUpdate scene{.stamp = from_nanoseconds(match.header.stamp_ns),
                              .frame = "body_enu",
                              .id = "match",
                              .lines = {ellipse(covariance)},
                              .text = {{0.0, 0.0, height_of_text}, candidates_text(match)}};
  if (match.on_road) {
    for (const double right : {0.0, -match.half_width, match.half_width})
      scene.lines.push_back(along_road(match, right));
  }
  return scene;
}

}  // namespace maploop::lcm_log
