#include "tools/calibrate/extrinsics/depth_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "msgs/frames.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Vector3f;

constexpr float nearest = 3.0f, furthest = 50.0f;         // m
constexpr float column_width = 0.35f, row_height = 0.4f;  // deg
constexpr int grid_columns = static_cast<int>(360.0f / column_width) + 1;
constexpr float steepest = 45.0f;  // deg
constexpr int grid_rows = static_cast<int>(2.0f * steepest / row_height) + 1;
constexpr float least_jump = 0.6f, least_share = 0.05f;  // m, of the range
constexpr float thickness = 0.3f;                        // m, of the near object in a cell
constexpr int reach = 3;  // cells within which something must be seen beside the object

// The points of the near object in a cell.
struct Cell {
  float range = std::numeric_limits<float>::infinity();
  int left = -1, right = -1;  // outermost points
};

struct RangedPoint {
  Vector3f position;
  float range, azimuth;  // m, deg
  std::size_t cell;
};

std::vector<RangedPoint> ranged_points(const lidar::ScanView& scan, const lidar::Twist& motion,
                                       double elevation) {
  const lidar::PointTimes time_of(scan, scan.stamp);
  const auto cosine = static_cast<float>(std::cos(elevation));
  const auto sine = static_cast<float>(std::sin(elevation));
  std::vector<RangedPoint> points;
  points.reserve(scan.count);
  for (std::size_t i = 0; i < scan.count; ++i) {
    const float range = scan[i].norm();
    if (!(range > nearest && range < furthest)) continue;  // not a number either
    const Vector3f p = lidar::with_elevation(scan[i], cosine, sine);
    const auto azimuth = static_cast<float>(degrees(std::atan2(p.y(), p.x())));
    const auto above =
        static_cast<float>(degrees(std::asin(std::clamp(p.z() / range, -1.0f, 1.0f))));
    if (std::abs(above) >= steepest) continue;
    const auto column = static_cast<std::size_t>((azimuth + 180.0f) / column_width);
    const auto row = static_cast<std::size_t>((above + steepest) / row_height);
    const Vector3f moved = (motion.over(time_of(i)) * p.cast<double>()).cast<float>();
    points.push_back({moved, range, azimuth, row * grid_columns + column});
  }
  return points;
}

std::vector<Cell> cells_of(const std::vector<RangedPoint>& points) {
  std::vector<Cell> cells(static_cast<std::size_t>(grid_rows) * grid_columns);
  for (const RangedPoint& p : points) cells[p.cell].range = std::min(cells[p.cell].range, p.range);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Cell& cell = cells[points[i].cell];
    if (points[i].range > cell.range + thickness) continue;
    const auto azimuth = [&](int k) { return points[static_cast<std::size_t>(k)].azimuth; };
    const int k = static_cast<int>(i);
    if (cell.left < 0 || azimuth(k) > azimuth(cell.left)) cell.left = k;
    if (cell.right < 0 || azimuth(k) < azimuth(cell.right)) cell.right = k;
  }
  return cells;
}

}  // namespace

std::vector<Vector3f> depth_edges(const lidar::ScanView& scan, const lidar::Twist& motion,
                                  double elevation) {
  const std::vector<RangedPoint> points = ranged_points(scan, motion, elevation);
  const std::vector<Cell> cells = cells_of(points);
  const auto cell_at = [&](int row, int column) -> const Cell& {
    const int around = (column + grid_columns) % grid_columns;
    return cells[static_cast<std::size_t>(row) * grid_columns + static_cast<std::size_t>(around)];
  };
  std::vector<Vector3f> edges;
  for (int row = 0; row < grid_rows; ++row) {
    for (int column = 0; column < grid_columns; ++column) {
      const Cell& cell = cell_at(row, column);
      if (cell.left < 0) continue;
      for (const auto& [side, outermost] : {std::pair(1, cell.left), {-1, cell.right}}) {
        int step = 1;
        while (step < reach && cell_at(row, column + step * side).left < 0) ++step;
        const Cell& beside = cell_at(row, column + step * side);
        if (beside.left >= 0 &&
            beside.range - cell.range > std::max(least_jump, least_share * cell.range))
          edges.push_back(points[static_cast<std::size_t>(outermost)].position);
      }
    }
  }
  return edges;
}

}  // namespace maploop::extrinsics
