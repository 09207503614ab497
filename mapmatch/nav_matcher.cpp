#include "mapmatch/nav_matcher.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mapmatch/lanes.h"
#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double reach = 15.0;  // m before and after a place, over which `bend` is measured

Eigen::Vector2d along_azimuth(double azimuth) {
  return {std::sin(azimuth), std::cos(azimuth)};
}

}  // namespace

bool has_position(const NavState& state) {
  return state.status != NavStatus::uninitialized && state.status != NavStatus::without_course;
}

VehicleFix fix_of(const NavState& state) {
  VehicleFix fix;
  fix.stamp = state.stamp;
  fix.position = LocalFrame(state.origin).to_geodetic(state.position_enu);
  fix.covariance = state.covariance.topLeftCorner<2, 2>();
  fix.speed = state.forward_speed;
  const Eigen::Vector2d forward = along_azimuth(state.attitude.azimuth);
  fix.speed_sigma = std::sqrt(forward.dot(state.covariance.block<2, 2>(3, 3) * forward));
  fix.azimuth = state.attitude.azimuth;
  fix.azimuth_sigma = std::sqrt(state.covariance(6, 6));
  return fix;
}

MapMatch& NavMatcher::add(const NavState& state) {
  match_ = MapMatch{};
  match_.stamp = state.stamp;
  match_.origin = state.origin;
  match_.vehicle_enu = state.position_enu.head<2>();
  match_.covariance = state.covariance.topLeftCorner<2, 2>();
  match_.vehicle_azimuth = state.attitude.azimuth;
  match_.speed = state.forward_speed;
  if (!has_position(state)) {
    match_.refusal = FixRefusal::no_position;
    return match_;
  }
  VehicleFix fix = fix_of(state);
  course_.describe(fix);
  const MatchResult& result = matcher_.add(fix);
  match_.phase = result.phase;
  match_.refusal = result.refusal;
  if (result.refusal != FixRefusal::none) return match_;
  static_cast<LinkMatch&>(match_) = result;
  if (result.on_road) {
    describe_place(state, result.point);
    match_.lane = lane_on(network(), match_.link, result.point, network().to_local(fix.position),
                          fix.covariance, matcher_.parameters().lane_sigma);
  }
  return match_;
}

void NavMatcher::describe_place(const NavState& state, const LinkPoint& point) {
  const RoadNetwork& roads = network();
  const LocalFrame enu(state.origin);
  const auto to_enu = [&](const Eigen::Vector2d& local) -> Eigen::Vector2d {
    Geodetic place = roads.to_geodetic(local);
    place.height = state.origin.height + state.position_enu.z();
    return enu.to_enu(place).head<2>();
  };
  match_.way_id = roads.road_at(point.vertex).way_id;
  std::tie(match_.node_a, match_.node_b) = roads.nodes(match_.link, point.vertex);
  match_.half_width = half_width(roads.road_at(point.vertex));
  match_.matched_enu = to_enu(point.position);
  // Two points are transformed instead of one direction, since the norths of the frames differ.
  const Eigen::Vector2d ahead = to_enu(point.position + reach * point.direction);
  const Eigen::Vector2d direction = (ahead - match_.matched_enu).normalized();
  match_.link_azimuth = std::atan2(direction.x(), direction.y());
  const Eigen::Vector2d right(direction.y(), -direction.x());
  match_.cross_track = right.dot(match_.vehicle_enu - match_.matched_enu);
  const double length = roads.link(match_.link.link).length;
  match_.to_junction = length - match_.along;
  const auto azimuth_at = [&](double s) {
    return roads.at(match_.link, std::clamp(s, 0.0, length)).azimuth();
  };
  match_.bend = wrap_angle(azimuth_at(match_.along + reach) - azimuth_at(match_.along - reach));
}

}  // namespace maploop::mapmatch
