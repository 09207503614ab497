#include "tools/simulate/scene/mesh.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Adds the sides of a prism over corners in counter-clockwise order.
void add_sides(Mesh& mesh, const std::vector<Vector2f>& corners, float bottom, float top,
               std::uint32_t surface) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2f &a = corners[i], &b = corners[(i + 1) % corners.size()];
    mesh.add_quad({a.x(), a.y(), bottom}, {b.x(), b.y(), bottom}, {b.x(), b.y(), top},
                  {a.x(), a.y(), top}, surface);
  }
}

std::vector<Vector2f> rectangle(const Vector2f& size) {
  const float x = 0.5F * size.x(), y = 0.5F * size.y();
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

}  // namespace

std::uint32_t Mesh::add(const Surface& surface) {
  surfaces.push_back(surface);
  return static_cast<std::uint32_t>(surfaces.size() - 1);
}

void Mesh::add_quad(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& d,
                    std::uint32_t surface) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const float u = (b - a).norm(), v = (d - a).norm();
  vertices.insert(vertices.end(), {a, b, c, d});
  uv.insert(uv.end(), {Vector2f(0, 0), Vector2f(u, 0), Vector2f(u, v), Vector2f(0, v)});
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
  surface_of.insert(surface_of.end(), 2, surface);
}

void Mesh::add_triangle(const Vector3f& a, const Vector3f& b, const Vector3f& c,
                        std::uint32_t surface) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const Vector3f u = (b - a).normalized();
  const float x = u.dot(c - a);
  vertices.insert(vertices.end(), {a, b, c});
  uv.insert(uv.end(),
            {Vector2f(0, 0), Vector2f((b - a).norm(), 0), Vector2f(x, (c - a - x * u).norm())});
  triangles.push_back({first, first + 1, first + 2});
  surface_of.push_back(surface);
}

void Mesh::append(const Mesh& part, float yaw, const Vector3f& place) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const auto first_surface = static_cast<std::uint32_t>(surfaces.size());
  const float c = std::cos(yaw), s = std::sin(yaw);
  for (const Vector3f& v : part.vertices)
    vertices.push_back(place + Vector3f(c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()));
  uv.insert(uv.end(), part.uv.begin(), part.uv.end());
  for (const auto& t : part.triangles)
    triangles.push_back({first + t[0], first + t[1], first + t[2]});
  for (const std::uint32_t surface : part.surface_of) surface_of.push_back(first_surface + surface);
  surfaces.insert(surfaces.end(), part.surfaces.begin(), part.surfaces.end());
}

Mesh make_building(const Vector2f& size, float height, bool gable, const Surface& wall,
                   const Surface& roof) {
  constexpr float cellar = -3.0F;  // below the lowest ground around it
  Mesh mesh;
  const std::uint32_t walls = mesh.add(wall), roofs = mesh.add(roof);
  const auto corners = rectangle(size);
  add_sides(mesh, corners, cellar, height, walls);
  const float x = 0.5F * size.x(), y = 0.5F * size.y();
  const Vector3f a(-x, -y, height), b(x, -y, height), c(x, y, height), d(-x, y, height);
  if (!gable) {
    mesh.add_quad(a, b, c, d, roofs);
    return mesh;
  }
  const Vector3f e(-x, 0, height + 0.8F * y), f(x, 0, height + 0.8F * y);
  mesh.add_quad(a, b, f, e, roofs);
  mesh.add_quad(c, d, e, f, roofs);
  mesh.add_triangle(d, a, e, walls);
  mesh.add_triangle(b, c, f, walls);
  return mesh;
}

Mesh make_box(const Vector3f& size, const Surface& surface) {
  Mesh mesh;
  const std::uint32_t s = mesh.add(surface);
  const auto c = rectangle(size.head<2>());
  add_sides(mesh, c, -0.5F, size.z(), s);
  const auto top = [&](int i) { return Vector3f(c[i].x(), c[i].y(), size.z()); };
  mesh.add_quad(top(0), top(1), top(2), top(3), s);
  return mesh;
}

Mesh make_pole(float radius, float height, const Surface& surface) {
  Mesh mesh;
  std::vector<Vector2f> corners;
  for (int i = 0; i < 8; ++i) {
    const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 4.0F;
    corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  add_sides(mesh, corners, -0.5F, height, mesh.add(surface));
  return mesh;
}

Mesh make_tree(float height, std::uint32_t seed) {
  Random random(seed, 7);
  Mesh mesh;
  mesh.append(make_pole(0.025F * height, 0.6F * height, {Material::bark, 0.16F, seed}), 0.0F,
              Vector3f::Zero());
  const float radius = 0.3F * height;
  std::array<std::uint32_t, 16> leaves{};
  for (std::uint32_t& leaf : leaves)
    leaf = mesh.add({Material::leaf, random.uniform_float(0.07, 0.3),
                     static_cast<std::uint32_t>(random.bits() >> 40U)});
  const auto direction = [&] {
    const float z = random.uniform_float(-1.0, 1.0), angle = random.uniform_float(0.0, 6.2832);
    const float r = std::sqrt(1.0F - z * z);
    return Vector3f(r * std::cos(angle), r * std::sin(angle), z);
  };
  for (int i = 0; i < 1300; ++i) {
    const Vector3f out = direction() * radius * std::sqrt(random.uniform_float(0.15, 1.0));
    const Vector3f middle(out.x(), out.y(), 0.65F * height + 1.15F * out.z());
    const Vector3f u = direction(), v = u.cross(direction()).normalized();
    const float size = random.uniform_float(0.025, 0.055) * height;
    mesh.add_triangle(middle + size * u, middle - size * u, middle + size * v,
                      leaves[random.below(16)]);
  }
  return mesh;
}

Mesh make_car(float tone, std::uint32_t seed) {
  // The outline seen from the side: x, z.
  const std::array<Vector2f, 10> outline{{{-2.15F, 0.3F},
                                          {2.1F, 0.3F},
                                          {2.15F, 0.62F},
                                          {1.2F, 0.92F},
                                          {0.45F, 1.42F},
                                          {-1.15F, 1.45F},
                                          {-1.9F, 1.0F},
                                          {-2.15F, 0.95F},
                                          {-2.2F, 0.6F},
                                          {-2.15F, 0.3F}}};
  const float half = 0.86F;
  Mesh mesh;
  const std::uint32_t paint = mesh.add({Material::paint, tone, seed});
  const std::uint32_t glass = mesh.add({Material::glass, 0.08F, seed});
  const std::uint32_t tyre = mesh.add({Material::tyre, 0.04F, seed});
  const auto side = [&](float y, std::size_t i) {
    // The cabin narrows upwards.
    const float in = outline[i].y() > 1.1F ? 0.8F : 1.0F;
    return Vector3f(outline[i].x(), y * in, outline[i].y());
  };
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
    mesh.add_quad(side(-half, i), side(-half, i + 1), side(half, i + 1), side(half, i),
                  i == 3 || i == 5 ? glass : paint);
  // Number plates and lights.
  const std::uint32_t plate = mesh.add({Material::sign, 0.7F, seed});
  const std::uint32_t light = mesh.add({Material::metal, 0.5F, seed});
  const auto patch = [&](float x, float y, float z, float width, float height,
                         std::uint32_t surface) {
    mesh.add_quad({x, y, z}, {x, y + width, z}, {x, y + width, z + height}, {x, y, z + height},
                  surface);
  };
  for (const float x : {-2.23F, 2.18F}) {
    patch(x, -0.26F, 0.45F, 0.52F, 0.12F, plate);
    patch(x, -0.8F, 0.65F, 0.3F, 0.14F, light);
    patch(x, 0.5F, 0.65F, 0.3F, 0.14F, light);
  }
  for (const float y : {-half, half}) {
    const Vector3f waist_front(1.2F, y, 0.92F), waist_back(-1.9F, y, 1.0F);
    for (std::size_t i : {0U, 1U, 2U})
      mesh.add_triangle(side(y, i), side(y, i + 1), Vector3f(0.0F, y, 0.75F), paint);
    mesh.add_triangle(waist_front, waist_back, Vector3f(0.0F, y, 0.75F), paint);
    for (std::size_t i : {6U, 7U, 8U})
      mesh.add_triangle(side(y, i), side(y, i + 1), Vector3f(0.0F, y, 0.75F), paint);
    mesh.add_quad(waist_back, waist_front, side(y, 4), side(y, 5), glass);
    for (const float x : {-1.35F, 1.35F}) {
      Vector3f before(x + 0.32F, 1.02F * y, 0.32F);
      for (int i = 1; i <= 10; ++i) {
        const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 5.0F;
        const Vector3f next(x + 0.32F * std::cos(angle), 1.02F * y,
                            0.32F + 0.32F * std::sin(angle));
        mesh.add_triangle(Vector3f(x, 1.02F * y, 0.32F), before, next, tyre);
        before = next;
      }
    }
  }
  return mesh;
}

}  // namespace maploop::simulate
