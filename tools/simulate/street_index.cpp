#include "tools/simulate/street_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maploop::simulate {
namespace {

constexpr double cell_size = 6.0;  // m

}  // namespace

StreetIndex::StreetIndex(const Streets& streets, double reach) : streets_(&streets), reach_(reach) {
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
  for (std::uint32_t s = 0; s < streets.streets.size(); ++s) {
    const auto& line = streets.streets[s].centreline;
    for (std::uint32_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d low = line[i].cwiseMin(line[i + 1]).array() - margin - least_.array();
      const Eigen::Vector2d high = line[i].cwiseMax(line[i + 1]).array() + margin - least_.array();
      const auto clip = [](double metres, std::size_t count) {
        return std::min(static_cast<std::size_t>(std::max(0.0, metres / cell_size)), count - 1);
      };
      for (std::size_t y = clip(low.y(), rows_); y <= clip(high.y(), rows_); ++y)
        for (std::size_t x = clip(low.x(), columns_); x <= clip(high.x(), columns_); ++x)
          cells_[y * columns_ + x].push_back({s, i});
    }
  }
}

Eigen::Vector2d StreetIndex::most() const {
  return least_ +
         cell_size * Eigen::Vector2d(static_cast<double>(columns_), static_cast<double>(rows_));
}

const std::vector<StreetIndex::Segment>* StreetIndex::cell(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d c = (place - least_) / cell_size;
  if (!(c.minCoeff() >= 0.0)) return nullptr;
  const auto x = static_cast<std::size_t>(c.x()), y = static_cast<std::size_t>(c.y());
  return x < columns_ && y < rows_ ? &cells_[y * columns_ + x] : nullptr;
}

StreetIndex::Nearest StreetIndex::nearest(const Eigen::Vector2d& place) const {
  Nearest found;
  found.first.edge = found.second.edge = reach_;
  const auto* segments = cell(place);
  if (!segments) return found;
  for (const Segment& segment : *segments) {
    const Street& street = streets_->streets[segment.street];
    const Eigen::Vector2d& a = street.centreline[segment.point];
    const Eigen::Vector2d way = street.centreline[segment.point + 1] - a, to = place - a;
    const double length = street.along[segment.point + 1] - street.along[segment.point];
    const double s = std::clamp(to.dot(way) / length, 0.0, length);
    const double distance = (to - way * (s / length)).norm();
    const double edge = distance - street.half_width;
    const bool same = found.first.street == &street;
    if (edge >= (same ? found.first.edge : found.second.edge)) continue;
    const double side = way.x() * to.y() - way.y() * to.x();
    const StreetPlace here{&street, street.along[segment.point] + s, std::copysign(distance, side),
                           edge};
    if (same) {
      found.first = here;
    } else if (edge < found.first.edge) {
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
