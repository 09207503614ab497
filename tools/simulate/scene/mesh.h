// Triangles of the world and their materials.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace maploop::simulate {

enum class Material : std::uint8_t {
  plaster,  // facade with windows; uv in metres, v from the ground
  brick,    // like plaster, with bricks
  roof,
  hedge,
  fence,
  bark,
  leaf,
  metal,  // poles
  sign,
  paint,  // of a car
  glass,
  tyre,
  forest,  // closes the view behind the town
  ground,  // streets, pavements, gardens: textured by place instead of uv
};

struct Surface {
  Material material = Material::plaster;
  float tone = 0.5F;  // albedo, or its mean
  std::uint32_t seed = 0;
};

struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  // m
  std::vector<Eigen::Vector2f> uv;        // m on the surface, for each vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> surface_of;  // for each triangle
  std::vector<Surface> surfaces;

  std::uint32_t add(const Surface& surface);  // returns its number
  // The corners are in order; u runs from a to b, v from a to d.
  void add_quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                const Eigen::Vector3f& d, std::uint32_t surface);
  void add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                    std::uint32_t surface);
  // Adds all of `part`, turned by yaw (rad) and moved by `place` (m).
  void append(const Mesh& part, float yaw, const Eigen::Vector3f& place);
};

// Shapes around the origin, on z = 0; x is along the long side or towards the front. Sizes are in
// m.
Mesh make_building(const Eigen::Vector2f& size, float height, bool gable, const Surface& wall,
                   const Surface& roof);
Mesh make_box(const Eigen::Vector3f& size, const Surface& surface);
Mesh make_pole(float radius, float height, const Surface& surface);
// A trunk, and leaves as triangles scattered in a crown. The seed draws them.
Mesh make_tree(float height, std::uint32_t seed);
Mesh make_car(float tone, std::uint32_t seed);

}  // namespace maploop::simulate
