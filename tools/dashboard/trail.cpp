#include "tools/dashboard/trail.h"

#include <fmt/format.h>
#include <chrono>

namespace maploop::dashboard {
namespace {

constexpr Duration apart = std::chrono::milliseconds(200);
constexpr std::size_t most = 6000;

}  // namespace

void Trail::append(std::deque<Point>& points, const Point& point) {
  while (!points.empty() && points.back().stamp > point.stamp) points.pop_back();
  if (!points.empty() && point.stamp - points.back().stamp < apart) return;
  points.push_back(point);
  if (points.size() > most) points.pop_front();
}

void Trail::add(const NavState& state) {
  if (state.status == NavStatus::uninitialized) return;
  const auto same = [](const Geodetic& a, const Geodetic& b) {
    return a.latitude == b.latitude && a.longitude == b.longitude && a.height == b.height;
  };
  if (!started_ || !same(origin_, state.origin)) {
    origin_ = state.origin;
    frame_ = LocalFrame(origin_);
    fused_.clear();
    truth_.clear();
    started_ = true;
  }
  append(fused_, {state.stamp, state.position_enu.x(), state.position_enu.y()});
}

void Trail::add(const ReferencePose& truth) {
  if (!started_) return;
  const Eigen::Vector3d p = frame_.to_enu(truth.position);
  append(truth_, {truth.stamp, p.x(), p.y()});
}

std::string Trail::json() const {
  std::string json = fmt::format("{{\"origin\":[{:.17g},{:.17g},{:.17g}]", origin_.latitude,
                                 origin_.longitude, origin_.height);
  const auto list = [&](const char* name, const std::deque<Point>& points) {
    json += std::string(",\"") + name + "\":[";
    const char* separator = "";
    for (const Point& p : points) {
      json += fmt::format("{}[{:.3f},{:.2f},{:.2f}]", separator,
                          static_cast<double>(to_nanoseconds(p.stamp)) * 1e-9, p.east, p.north);
      separator = ",";
    }
    json += ']';
  };
  list("fused", fused_);
  list("truth", truth_);
  return json + '}';
}

}  // namespace maploop::dashboard
