// This file joins the transforms between the coordinate frames of a robot.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace maploop::sensors {

// Holds rigid transforms between named frames. A leading slash of a name is ignored.
class FrameTree {
 public:
  // The first transform between two frames counts.
  void add(std::string_view parent, std::string_view child,
           const Eigen::Isometry3d& T_parent_child);

  bool contains(std::string_view frame) const;

  // Returns T_a_b along the shortest chain of transforms, or nothing if the frames are not joined.
  std::optional<Eigen::Isometry3d> find(std::string_view a, std::string_view b) const;

 private:
  using Neighbours = std::map<std::string, Eigen::Isometry3d, std::less<>>;  // T_this_neighbour
  std::map<std::string, Neighbours, std::less<>> frames_;
};

}  // namespace maploop::sensors
