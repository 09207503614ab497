#include "msgs/local_frame.h"

#include <GeographicLib/LocalCartesian.hpp>

#include "msgs/frames.h"

namespace maploop {
namespace {

GeographicLib::LocalCartesian cartesian(const Geodetic& origin) {
  return {degrees(origin.latitude), degrees(origin.longitude), origin.height};
}

}  // namespace

Eigen::Vector3d LocalFrame::to_enu(const Geodetic& point) const {
  Eigen::Vector3d p;
  cartesian(origin_).Forward(degrees(point.latitude), degrees(point.longitude), point.height, p.x(),
                             p.y(), p.z());
  return p;
}

Geodetic LocalFrame::to_geodetic(const Eigen::Vector3d& p_enu) const {
  Geodetic g;
  cartesian(origin_).Reverse(p_enu.x(), p_enu.y(), p_enu.z(), g.latitude, g.longitude, g.height);
  g.latitude = radians(g.latitude);
  g.longitude = radians(g.longitude);
  return g;
}

}  // namespace maploop
