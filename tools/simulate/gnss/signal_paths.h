// Finds the paths on which a satellite's signal reaches the antenna: straight, around an edge,
// through leaves, and by reflection from a facade.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulate/scene/ray_scene.h"

namespace maploop::simulate {

struct SignalPath {
  double amplitude = 1.0;     // of the field; an unobstructed path has 1
  double delay = 0.0;         // m, longer than the straight path
  double rate = 0.0;          // m/s, change of the delay
  double phase = 0.0;         // rad, added by the reflection
  std::uint64_t surface = 0;  // 0: not reflected; otherwise the same value for the same facade
};

// The surroundings of the antenna at one moment.
class SignalPaths {
 public:
  // `scene` must outlive this object, and its bodies must be at their poses of that moment. m and
  // m/s in enu.
  SignalPaths(const RayScene& scene, const Eigen::Vector3d& antenna,
              const Eigen::Vector3d& velocity);

  // Returns the paths of a signal from a direction (a unit vector), the strongest first; empty if
  // nothing arrives. A reflection's amplitude includes the antenna's attenuation of the reversed
  // polarization.
  std::vector<SignalPath> from(const Eigen::Vector3d& to_satellite) const;

 private:
  struct Facade {
    Eigen::Vector3d normal;  // towards the antenna
    double distance;         // m
    double reflection;       // amplitude
    std::uint64_t name;
  };
  struct Sight {
    bool free = false;
    double loss = 0.0;   // dB, through leaves and poles
    double range = 0.0;  // m, to the obstacle
  };

  void find_facades();
  Sight look(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;
  void add_direct(const Eigen::Vector3d& to_satellite, std::vector<SignalPath>& paths) const;
  void add_reflection(const Facade& facade, const Eigen::Vector3d& to_satellite,
                      std::vector<SignalPath>& paths) const;

  const RayScene& scene_;
  Eigen::Vector3d antenna_, velocity_;
  std::vector<Facade> facades_;
};

}  // namespace maploop::simulate
