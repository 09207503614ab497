// Casts rays into the scene. Only this component uses Embree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tools/simulate/scene/mesh.h"

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

constexpr std::size_t packet = 8;  // number of rays that are cast together
using Rays = std::array<Ray, packet>;
using Hits = std::array<Hit, packet>;

// A body that moves from one pose to another while time goes from 0 to 1.
struct MovingBody {
  Eigen::Isometry3d begin, end;  // T_enu_body
};

// The static scene and the shapes of the moving bodies. Immutable; any number of threads may share
// it.
class World {
 public:
  // Throws std::runtime_error if Embree fails.
  World(Mesh standing, std::vector<Mesh> bodies);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

 private:
  friend class RayScene;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

// The world during an interval of time. An object belongs to one thread; the world must outlive it.
class RayScene {
 public:
  explicit RayScene(const World& world);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Sets the motion of each body, in the world's order.
  void move(const std::vector<MovingBody>& bodies);

  // Finds the nearest hits within `reach` metres. It is fastest if the rays of a packet are nearly
  // parallel.
  void cast(const Rays& rays, float reach, Hits& hits) const;
  // Finds out whether anything blocks those rays whose `wanted` is true.
  void occluded(const Rays& rays, const std::array<bool, packet>& wanted,
                std::array<bool, packet>& result) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::simulate
