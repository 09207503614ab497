#include "tools/simulate/town/streets.h"

#include <algorithm>
#include <cmath>

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

void measure(Street& street) {
  street.along.assign(1, 0.0);
  for (std::size_t i = 1; i < street.centreline.size(); ++i)
    street.along.push_back(street.along.back() +
                           (street.centreline[i] - street.centreline[i - 1]).norm());
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
    measure(street);
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

}  // namespace maploop::simulate
