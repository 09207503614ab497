#include "tools/simulate/town/streets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::size_t town_rows = 6, town_columns = 6;
constexpr double point_spacing = 2.0;  // m, between the points of a centreline

std::size_t junction(std::size_t row, std::size_t column) {
  return row * town_columns + column;
}

// Makes a curve that leaves both junctions nearly in the grid's direction and bends in between.
Street bent_street(const Streets& town, std::size_t from, std::size_t to, Random& random) {
  const Eigen::Vector2d a = town.junctions[from], b = town.junctions[to];
  const Eigen::Vector2d way = b - a;
  const Eigen::Vector2d left = Eigen::Vector2d(-way.y(), way.x()).normalized();
  const double bend = random.uniform(-9.0, 9.0), sway = random.uniform(-7.0, 7.0);
  const Eigen::Vector2d c = a + way / 3.0 + (bend + sway) * left;
  const Eigen::Vector2d d = b - way / 3.0 + (bend - sway) * left;
  Street street;
  street.from = from;
  street.to = to;
  const auto steps = static_cast<int>(way.norm() / point_spacing);
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, s = 1.0 - t;
    street.centreline.push_back(s * s * s * a + 3.0 * s * s * t * c + 3.0 * s * t * t * d +
                                t * t * t * b);
  }
  return street;
}

constexpr double cell_size = 6.0;  // m

}  // namespace

std::vector<Eigen::Vector2d> Streets::centreline(DirectedStreet d) const {
  std::vector<Eigen::Vector2d> line = streets[d.street].centreline;
  if (!d.forward) std::reverse(line.begin(), line.end());
  return line;
}

std::vector<std::vector<DirectedStreet>> Streets::exits() const {
  std::vector<std::vector<DirectedStreet>> result(junctions.size());
  for (std::size_t i = 0; i < streets.size(); ++i) {
    if (streets[i].forward) result[streets[i].from].push_back({i, true});
    if (streets[i].backward) result[streets[i].to].push_back({i, false});
  }
  return result;
}

std::vector<double> distances_along(const Line& line) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    along.push_back(along.back() + (line[i] - line[i - 1]).norm());
  return along;
}

Eigen::Vector2d direction_at(const Line& line, std::size_t i) {
  const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, line.size() - 1);
  return (line[b] - line[a]).normalized();
}

void NearCells::add(const Eigen::Vector2d& p) {
  const auto [x, y] = cell_of(p);
  if (!middles_.emplace(x, y).second) return;
  for (long long i = -reach_; i <= reach_; ++i)
    for (long long k = -reach_; k <= reach_; ++k) near_.emplace(x + i, y + k);
}

Streets make_town(std::uint64_t seed) {
  Random random(seed, 2);
  Streets town;
  for (std::size_t row = 0; row < town_rows; ++row)
    for (std::size_t column = 0; column < town_columns; ++column)
      town.junctions.emplace_back(
          105.0 * (static_cast<double>(column) - 2.5) + random.uniform(-14.0, 14.0),
          90.0 * (static_cast<double>(row) - 2.5) + random.uniform(-11.0, 11.0));
  const auto connect = [&](std::size_t from, std::size_t to, bool wide, bool border) {
    if (!border && !wide && random.chance(0.1)) return;  // leaves a junction with three arms
    Street street = bent_street(town, from, to, random);
    if (wide) street.half_width = 4.5;
    street.speed_limit = wide ? 13.9 : 11.1;
    street.along = distances_along(street.centreline);
    town.streets.push_back(std::move(street));
  };
  for (std::size_t row = 0; row < town_rows; ++row)
    for (std::size_t column = 0; column + 1 < town_columns; ++column)
      connect(junction(row, column), junction(row, column + 1), row % 3 == 1,
              row == 0 || row + 1 == town_rows);
  for (std::size_t column = 0; column < town_columns; ++column)
    for (std::size_t row = 0; row + 1 < town_rows; ++row)
      connect(junction(row, column), junction(row + 1, column), column % 3 == 1,
              column == 0 || column + 1 == town_columns);
  return town;
}

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
