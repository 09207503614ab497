#include "tools/simulate/scene/town_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double pavement_width = 2.0;  // m

std::uint32_t number(Random& random) {
  return static_cast<std::uint32_t>(random.bits() >> 40U);
}

struct Range {
  double least, most;  // m
};
struct BuildingStyle {
  bool buildings;
  std::uint32_t least_storeys, kinds;  // number of storeys: least_storeys + 0 to kinds - 1
  Range setback;                       // m, from the pavement
  double gap_chance;
  Range wide_gap, narrow_gap;
  double tree_spacing;  // relative to the town's
};

constexpr BuildingStyle style_of(Environment environment) {
  switch (environment) {
    case Environment::open:
      return {false, 1, 1, {0.0, 0.0}, 0.0, {0.0, 0.0}, {0.0, 0.0}, 5.0};
    case Environment::suburban:
      return {true, 1, 2, {3.0, 9.0}, 1.0, {6.0, 18.0}, {0.0, 0.0}, 1.0};
    case Environment::urban:
      return {true, 6, 5, {0.1, 1.5}, 0.1, {4.0, 8.0}, {0.1, 0.4}, 2.0};
    case Environment::town:
      break;
  }
  return {true, 2, 4, {0.3, 6.0}, 0.35, {4.0, 14.0}, {0.1, 1.0}, 1.0};
}

// The rectangle that an object covers on the ground.
struct Footprint {
  Vector2d middle;
  Vector2d along, across;  // half sides as vectors

  bool overlaps(const Footprint& other) const {
    const auto apart = [&](const Vector2d& axis) {
      const Vector2d n = axis.normalized();
      const auto reach = [&](const Footprint& f) {
        return std::fabs(f.along.dot(n)) + std::fabs(f.across.dot(n));
      };
      return std::fabs((other.middle - middle).dot(n)) > reach(*this) + reach(other);
    };
    return !apart(along) && !apart(across) && !apart(other.along) && !apart(other.across);
  }
};

class TownBuilder {
 public:
  TownBuilder(const Streets& streets, const StreetIndex& index, const Terrain& terrain,
              std::uint64_t seed, const BuildingStyle& style)
      : streets_(streets), index_(index), terrain_(terrain), style_(style), random_(seed, 9) {}

  Mesh build() {
    add_ground();
    add_horizon();
    for (const Street& street : streets_.streets)
      for (const double side : {-1.0, 1.0}) {
        if (style_.buildings) add_buildings(street, side);
        add_garden_edges(street, side);
        add_trees(street, side);
        add_poles(street, side);
        add_parked_cars(street, side);
      }
    return std::move(mesh_);
  }

 private:
  struct Spot {
    Vector2d place;
    double yaw = 0.0;  // rad, direction of the street

    // Returns what a thing covers there, m: half its length along the street and half its depth.
    Footprint footprint(double half_length, double half_depth) const {
      const Vector2d t(std::cos(yaw), std::sin(yaw));
      return {place, half_length * t, half_depth * Vector2d(-t.y(), t.x())};
    }
  };

  // Returns the place beside the street; `along` is m from its start, `from_kerb` m from its kerb.
  Spot spot(const Street& street, double side, double along, double from_kerb) const {
    const auto next = std::upper_bound(street.along.begin() + 1, street.along.end() - 1, along);
    const auto i = static_cast<std::size_t>(next - street.along.begin());
    const Vector2d a = street.centreline[i - 1], b = street.centreline[i];
    const Vector2d t = (b - a).normalized(), left(-t.y(), t.x());
    return {a + (along - street.along[i - 1]) * t + side * (street.half_width + from_kerb) * left,
            std::atan2(t.y(), t.x())};
  }

  Vector3f on_ground(const Vector2d& place) const {
    return {static_cast<float>(place.x()), static_cast<float>(place.y()),
            static_cast<float>(terrain_.height(place))};
  }

  void put(const Mesh& part, const Vector2d& place, double yaw) {
    mesh_.append(part, static_cast<float>(yaw), on_ground(place));
  }

  void add_ground() {
    constexpr double cell = 4.0, margin = 160.0;
    const Vector2d low = index_.least().array() - margin, high = index_.most().array() + margin;
    const auto columns = static_cast<std::uint32_t>((high.x() - low.x()) / cell) + 1;
    const auto rows = static_cast<std::uint32_t>((high.y() - low.y()) / cell) + 1;
    const std::uint32_t surface = mesh_.add({Material::ground, 0.21F, 0});
    NearCells near(50.0, 5);  // no ground is built farther than 250 m from a street
    for (const Street& street : streets_.streets)
      for (const Vector2d& p : street.centreline) near.add(p);
    std::map<std::uint32_t, std::uint32_t> vertices;  // vertex of each grid point
    const auto vertex = [&](std::uint32_t x, std::uint32_t y) {
      const auto [at, anew] = vertices.try_emplace(y * (columns + 1) + x, mesh_.vertices.size());
      if (anew) {
        mesh_.vertices.push_back(on_ground(low + cell * Vector2d(x, y)));
        mesh_.uv.emplace_back(0.0F, 0.0F);
      }
      return at->second;
    };
    for (std::uint32_t y = 0; y < rows; ++y)
      for (std::uint32_t x = 0; x < columns; ++x) {
        if (!near.contains(low + cell * Vector2d(x + 0.5, y + 0.5))) continue;
        const std::uint32_t a = vertex(x, y), b = vertex(x, y + 1);
        const std::uint32_t c = vertex(x + 1, y), d = vertex(x + 1, y + 1);
        mesh_.triangles.push_back({a, c, d});
        mesh_.triangles.push_back({a, d, b});
        mesh_.surface_of.insert(mesh_.surface_of.end(), 2, surface);
      }
  }

  // A forest around the town ends the view.
  void add_horizon() {
    const Vector2d low = index_.least().array() - 120.0, high = index_.most().array() + 120.0;
    const std::uint32_t surface = mesh_.add({Material::forest, 0.13F, 1});
    const std::array<Vector2d, 4> corners{low, Vector2d(low.x(), high.y()), high,
                                          Vector2d(high.x(), low.y())};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d a = corners[i], b = corners[(i + 1) % 4];
      constexpr int pieces = 40;
      float before = 16.0F;
      for (int k = 0; k < pieces; ++k) {
        const float top = random_.uniform_float(12.0, 22.0);
        const Vector3f p = on_ground(a + (b - a) * k / pieces);
        const Vector3f q = on_ground(a + (b - a) * (k + 1) / pieces);
        mesh_.add_quad(p, q, q + Vector3f(0, 0, top), p + Vector3f(0, 0, before), surface);
        before = top;
      }
    }
  }

  bool is_free(const Footprint& f, double from_kerb) const {
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j)
        if (index_.to_kerb(f.middle + 0.5 * i * f.along + 0.5 * j * f.across) < from_kerb)
          return false;
    return std::none_of(built_.begin(), built_.end(),
                        [&](const Footprint& other) { return f.overlaps(other); });
  }

  void add_buildings(const Street& street, double side) {
    double along = random_.uniform(6.0, 12.0);
    while (along < street.length() - 6.0) {
      const double width = random_.uniform(9.0, 20.0), depth = random_.uniform(9.0, 14.0);
      const double back =
          pavement_width + random_.uniform(style_.setback.least, style_.setback.most);
      const bool brick = random_.chance(0.35), gable = random_.chance(0.6);
      const float height =
          3.0F * static_cast<float>(style_.least_storeys + random_.below(style_.kinds)) + 0.6F;
      const float tone =
          brick ? random_.uniform_float(0.2, 0.32) : random_.uniform_float(0.3, 0.68);
      const Surface wall{brick ? Material::brick : Material::plaster, tone, number(random_)};
      const Surface roof{Material::roof, random_.uniform_float(0.12, 0.3), number(random_)};
      const Range& gaps = random_.chance(style_.gap_chance) ? style_.wide_gap : style_.narrow_gap;
      const double gap = random_.uniform(gaps.least, gaps.most);
      const Spot at = spot(street, side, along + 0.5 * width, back + 0.5 * depth);
      const Footprint footprint = at.footprint(0.5 * width, 0.5 * depth);
      if (is_free(footprint, pavement_width + 0.2)) {
        built_.push_back(footprint);
        put(make_building({static_cast<float>(width), static_cast<float>(depth)}, height, gable,
                          wall, roof),
            at.place, at.yaw);
        along += width + gap;
      } else {
        along += 3.0;
      }
    }
  }

  // Hedges and fences stand between houses and pavement.
  void add_garden_edges(const Street& street, double side) {
    for (double along = 14.0; along < street.length() - 16.0;) {
      const double length = random_.uniform(3.0, 9.0);
      const bool hedge = random_.chance(0.6), there = random_.chance(0.6);
      const float height =
          hedge ? random_.uniform_float(0.8, 1.8) : random_.uniform_float(0.9, 1.3);
      const float thickness = hedge ? random_.uniform_float(0.5, 0.9) : 0.06F;
      const Surface surface{
          hedge ? Material::hedge : Material::fence,
          hedge ? random_.uniform_float(0.09, 0.16) : random_.uniform_float(0.2, 0.5),
          number(random_)};
      const Spot at = spot(street, side, along + 0.5 * length, pavement_width + 0.6);
      if (there && is_free(at.footprint(0.5 * length, 0.4), pavement_width + 0.05))
        put(make_box({static_cast<float>(length), thickness, height}, surface), at.place, at.yaw);
      along += length + random_.uniform(0.0, 3.0);
    }
  }

  void add_trees(const Street& street, double side) {
    const bool avenue = random_.chance(0.3);
    for (double along = random_.uniform(14.0, 22.0); along < street.length() - 14.0;
         along += style_.tree_spacing *
                  (avenue ? random_.uniform(11.0, 16.0) : random_.uniform(14.0, 45.0))) {
      const float height = random_.uniform_float(4.5, 9.0);
      const std::uint32_t seed = number(random_);
      const Spot at =
          spot(street, side, along, avenue ? 1.5 : pavement_width + random_.uniform(1.0, 5.0));
      const Footprint trunk{at.place, Vector2d(0.5, 0.0), Vector2d(0.0, 0.5)};
      if (is_free(trunk, 0.9)) put(make_tree(height, seed), at.place, 0.0);
    }
  }

  void add_poles(const Street& street, double side) {
    for (double along = 13.0 + random_.uniform(0.0, 8.0); along < street.length() - 10.0;
         along += random_.uniform(18.0, 32.0)) {
      const Spot at = spot(street, side, along, 0.5);
      const bool lamp = random_.chance(0.5), signed_too = random_.chance(0.6);
      const float tone = random_.uniform_float(0.15, 0.4);
      const std::uint32_t seed = number(random_);
      if (index_.to_kerb(at.place) < 0.4) continue;
      put(make_pole(lamp ? 0.08F : 0.04F, lamp ? 6.0F : 2.8F, {Material::metal, tone, seed}),
          at.place, 0.0);
      if (lamp || !signed_too) continue;
      Mesh board;
      const std::uint32_t face = board.add({Material::sign, 0.75F, seed});
      board.add_quad({0, -0.3F, 2.1F}, {0, 0.3F, 2.1F}, {0, 0.3F, 2.8F}, {0, -0.3F, 2.8F}, face);
      put(board, at.place, at.yaw);
    }
  }

  void add_parked_cars(const Street& street, double side) {
    const double density = random_.uniform(0.1, 0.7);
    for (double along = 16.0; along < street.length() - 16.0; along += 5.6) {
      const bool there = random_.chance(density);
      const float tone = random_.uniform_float(0.08, 0.7);
      const std::uint32_t seed = number(random_);
      const double shift = random_.uniform(-0.4, 0.4), skew = random_.uniform(-0.03, 0.03);
      const Spot at = spot(street, side, along + shift, 0.75);  // mostly on the pavement
      if (there && is_free(at.footprint(2.3, 1.0), -0.4))
        put(make_car(tone, seed), at.place, at.yaw + skew + (side > 0 ? std::numbers::pi : 0.0));
    }
  }

  const Streets& streets_;
  const StreetIndex& index_;
  const Terrain& terrain_;
  BuildingStyle style_;
  Random random_;
  Mesh mesh_;
  std::vector<Footprint> built_;
};

}  // namespace

Mesh make_town_scene(const Streets& streets, const StreetIndex& index, const Terrain& terrain,
                     std::uint64_t seed, Environment environment) {
  return TownBuilder(streets, index, terrain, seed, style_of(environment)).build();
}

}  // namespace maploop::simulate
