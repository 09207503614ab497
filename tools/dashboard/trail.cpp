#include "tools/dashboard/trail.h"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

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
  if (!started_ || origin_ != state.origin) {
    origin_ = state.origin;
    frame_ = LocalFrame(origin_);
    fused_.clear();
    truth_.clear();
    started_ = true;
  }
  append(fused_, {state.stamp, state.position_enu});
}

void Trail::add(const ReferencePose& truth) {
  if (!started_) return;
  append(truth_, {truth.stamp, frame_.to_enu(truth.position)});
}

std::string Trail::json() const {
  const auto list = [](const std::deque<Point>& points) {
    auto all = nlohmann::json::array();
    for (const Point& p : points) {
      const double seconds = static_cast<double>(to_nanoseconds(p.stamp)) * 1e-9;
      const Eigen::Vector3d enu = (p.enu * 1e2).array().round() / 1e2;
      all.push_back({std::round(seconds * 1e3) / 1e3, enu.x(), enu.y(), enu.z()});
    }
    return all;
  };
  const nlohmann::json all = {{"origin", {origin_.latitude, origin_.longitude, origin_.height}},
                              {"fused", list(fused_)},
                              {"truth", list(truth_)}};
  return all.dump();
}

}  // namespace maploop::dashboard
