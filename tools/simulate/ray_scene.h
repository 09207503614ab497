// Casting rays into the scene: the only place that knows Embree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tools/simulate/mesh.h"

namespace maploop::simulate {

struct Ray {
  Eigen::Vector3f origin, direction;  // enu; a unit direction
  float time = 0.0F;                  // 0 to 1, within the moving bodies' interval
};

struct Hit {
  bool any = false;
  float range = 0.0F;                                 // m
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  // unit, towards the ray's origin
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();       // m on the surface
  const Surface* surface = nullptr;
};

constexpr std::size_t packet = 8;  // rays that are cast together
using Rays = std::array<Ray, packet>;
using Hits = std::array<Hit, packet>;

// A body that moves, from one pose to another while time goes from 0 to 1.
struct MovingBody {
  Eigen::Isometry3d begin, end;  // T_enu_body
};

// What stands still, and the shapes of what moves. Immutable; any number of threads may share it.
class World {
 public:
  // Throws std::runtime_error where Embree fails.
  World(Mesh standing, std::vector<Mesh> bodies);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

 private:
  friend class RayScene;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

// The world in an interval of time. For one thread; the world must outlive it.
class RayScene {
 public:
  explicit RayScene(const World& world);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // One for each body of the world.
  void move(const std::vector<MovingBody>& bodies);

  // The nearest hits within `reach` metres. Neighbours should go the same way, for speed.
  void cast(const Rays& rays, float reach, Hits& hits) const;
  // Whether something is in the way of the rays with a true `wanted`.
  void occluded(const Rays& rays, const std::array<bool, packet>& wanted,
                std::array<bool, packet>& result) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::simulate
