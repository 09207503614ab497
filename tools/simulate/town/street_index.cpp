#include "tools/simulate/town/street_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maploop::simulate {
namespace {

constexpr double cell_size = 6.0;  // m

}  // namespace

StreetIndex::StreetIndex(const Streets& streets, double reach) : reach_(reach) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d most = Eigen::Vector2d::Constant(-infinity);
  least_ = Eigen::Vector2d::Constant(infinity);
  double widest = 0.0;
  for (const Street& street : streets.streets) {
    widest = std::max(widest, street.half_width);
    for (const Eigen::Vector2d& p : street.centreline) {
      least_ = least_.cwiseMin(p);
      most = most.cwiseMax(p);
    }
  }
  const double margin = reach + widest;
  least_.array() -= margin;
  most.array() += margin;
  const auto cells = [](double metres) { return static_cast<std::size_t>(metres / cell_size) + 1; };
  columns_ = cells(most.x() - least_.x());
  rows_ = cells(most.y() - least_.y());
  cells_.resize(columns_ * rows_);
  for (const Street& street : streets.streets) {
    const auto& line = street.centreline;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const double length = street.along[i + 1] - street.along[i];
      const Segment segment{&street, line[i], (line[i + 1] - line[i]) / length, street.along[i],
                            length};
      const Eigen::Vector2d low = line[i].cwiseMin(line[i + 1]).array() - margin - least_.array();
      const Eigen::Vector2d high = line[i].cwiseMax(line[i + 1]).array() + margin - least_.array();
      const auto clip = [](double metres, std::size_t count) {
        return std::min(static_cast<std::size_t>(std::max(0.0, metres / cell_size)), count - 1);
      };
      for (std::size_t y = clip(low.y(), rows_); y <= clip(high.y(), rows_); ++y)
        for (std::size_t x = clip(low.x(), columns_); x <= clip(high.x(), columns_); ++x)
          cells_[y * columns_ + x].push_back(segment);
    }
  }
}

Eigen::Vector2d StreetIndex::most() const {
  return least_ +
         cell_size * Eigen::Vector2d(static_cast<double>(columns_), static_cast<double>(rows_));
}

std::span<const StreetIndex::Segment> StreetIndex::cell(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d c = (place - least_) / cell_size;
  if (!(c.minCoeff() >= 0.0)) return {};
  const auto x = static_cast<std::size_t>(c.x()), y = static_cast<std::size_t>(c.y());
  if (x >= columns_ || y >= rows_) return {};
  return cells_[y * columns_ + x];
}

StreetIndex::Nearest StreetIndex::nearest(const Eigen::Vector2d& place) const {
  Nearest found;
  found.first.edge = found.second.edge = reach_;
  const std::span<const Segment> segments = cell(place);
  for (std::size_t i = 0; i < segments.size();) {
    const Street* const street = segments[i].street;
    const Segment* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity(), at = 0.0;
    for (; i < segments.size() && segments[i].street == street; ++i) {
      const Eigen::Vector2d to = place - segments[i].begin;
      const double s = std::clamp(to.dot(segments[i].direction), 0.0, segments[i].length);
      const double squared = (to - s * segments[i].direction).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      nearest = &segments[i];
      at = s;
    }
    const double distance = std::sqrt(least), edge = distance - street->half_width;
    if (edge >= found.second.edge) continue;
    const Eigen::Vector2d to = place - nearest->begin;
    const double side = nearest->direction.x() * to.y() - nearest->direction.y() * to.x();
    const StreetPlace here{street, nearest->along + at, std::copysign(distance, side), edge};
    if (edge < found.first.edge) {
      found.second = found.first;
      found.first = here;
    } else {
      found.second = here;
    }
  }
  return found;
}

double StreetIndex::to_kerb(const Eigen::Vector2d& place) const {
  return nearest(place).first.edge;
}

}  // namespace maploop::simulate
