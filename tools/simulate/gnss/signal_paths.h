// The ways that a satellite's signal takes to the antenna: straight, around an edge, through
// leaves, and by a facade.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulate/ray_scene.h"

namespace maploop::simulate {

struct SignalPath {
  double amplitude = 1.0;     // of the field; the free one has 1
  double delay = 0.0;         // m longer than the straight way
  double rate = 0.0;          // m/s, how the delay changes
  double phase = 0.0;         // rad, turned by the reflection
  std::uint64_t surface = 0;  // 0: not reflected; else the same for one facade
};

// What is around the antenna at one moment.
class SignalPaths {
 public:
  // `scene` must outlive it, and its bodies stand as they do then. m and m/s in enu.
  SignalPaths(const RayScene& scene, const Eigen::Vector3d& antenna,
              const Eigen::Vector3d& velocity);

  // Of a signal from a direction (a unit vector), the strongest first; none: nothing arrives. A
  // reflection's amplitude has in it what the antenna takes of a wave that turns the other way.
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
    double loss = 0.0;   // dB, by leaves and poles
    double range = 0.0;  // m, to what is in the way
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
