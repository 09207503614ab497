#include "tools/replay/run_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "mapmatch/map_area.h"
#include "msgs/frames.h"
#include "sensors/replay/reference_trajectory.h"

namespace maploop::tools {
namespace {

constexpr double segment_m = 100.0;

MapUse map_use(const NavState& end, const RunPass& pass, const vehicle::RoadMap& map) {
  const mapmatch::GeographicBox area = vehicle::area_of(map);
  const bool on_road = std::any_of(pass.matches.begin(), pass.matches.end(),
                                   [](const auto& match) { return match.second.on_road; });
  const Geodetic last = LocalFrame(end.origin).to_geodetic(end.position_enu);
  return {mapmatch::to_text(area), !on_road && !mapmatch::covers(area, last, far_from_map)};
}

match::MatchScore links_score(const RunPass& pass, const vehicle::DrivenLinksFile& driven,
                              const vehicle::RoadMap& map, Time from) {
  std::vector<match::TimedMatch> matches;
  for (const auto& [stamp, match] : pass.matches) {
    if (stamp < from) continue;
    matches.push_back(match);
    if (map.tiles) matches.back().matched.link.reset();  // it counts the links of a window
  }
  auto labels = match::read_labels(driven.file);
  match::SegmentLinks(*roads_about(pass, map)).look_up(labels);
  return match::score_matches(matches, driven.stamps, labels);
}

// Returns the mean error over 100 m, after one rotation of the body for each stretch without a gap
// of the reference: which axes the body has is only what its description says.
double odom_percent(const evaluation::StampedTrajectory& odom,
                    const sensors::ReferenceTrajectory& reference, Time from) {
  constexpr auto gap = std::chrono::milliseconds(500);
  double sum = 0.0;
  int segments = 0;
  evaluation::Trajectory estimate, truth;
  const auto score_stretch = [&] {
    if (estimate.size() > 1) {
      const auto error =
          evaluation::score(estimate, truth, segment_m, evaluation::CommonRotation::remove).segment;
      if (error.segments > 0) sum += error.percent * error.segments;
      segments += error.segments;
    }
    estimate.clear();
    truth.clear();
  };
  Time last{};
  for (std::size_t i = 0; i < odom.stamps.size(); ++i) {
    const Time stamp = odom.stamps[i];
    const auto pose = reference.pose(stamp);
    if (stamp < from || !pose || reference.accuracy(stamp) > fusion_score::worst_reference)
      continue;
    if (stamp - last > gap) score_stretch();
    last = stamp;
    estimate.push_back(odom.poses[i]);
    truth.push_back(*pose);
  }
  score_stretch();
  return segments > 0 ? sum / segments : NAN;
}

}  // namespace

std::vector<fusion_score::OutageEnd> outage_ends(const fusion_score::NavTrack& track,
                                                 const vehicle::Recording& recording,
                                                 const std::vector<ReferencePose>& reference) {
  if (recording.fixes == nullptr) return {};
  std::vector<GnssFix> fixes;
  const auto source = recording.fixes();
  for (GnssFix fix; source->next(fix);) fixes.push_back(fix);
  return fusion_score::outage_ends(track, fixes, reference, recording.outages,
                                   recording.first_stamp);
}

void TrajectoryCollector::add(const FusedState& state, const Eigen::Vector3d& position,
                              const Attitude& attitude) {
  poses_[state.stamp] = Eigen::Translation3d(position) *
                        Eigen::Isometry3d(rotation_enu_body(attitude)) *
                        state.mount.T_body_described();
}

evaluation::StampedTrajectory TrajectoryCollector::poses(
    const Eigen::Isometry3d& T_body_point) const {
  evaluation::StampedTrajectory trajectory;
  for (const auto& [stamp, body] : poses_) {
    trajectory.stamps.push_back(stamp);
    trajectory.poses.push_back(body * T_body_point);
  }
  return trajectory;
}

std::optional<Accuracy> TrajectoryCollector::score(const Reference& camera,
                                                   const Eigen::Isometry3d& T_body_cam) const {
  evaluation::Trajectory estimate, truth;
  for (const auto& [stamp, body] : poses_) {
    if (const auto pose = camera(stamp)) {
      estimate.push_back(body * T_body_cam);
      truth.push_back(*pose);
    }
  }
  if (estimate.size() < 2) return std::nullopt;
  using evaluation::CommonRotation;
  return Accuracy{evaluation::score(estimate, truth, segment_m, CommonRotation::keep),
                  evaluation::score(estimate, truth, segment_m, CommonRotation::remove)};
}

RoadMoment road_moment(const MapMatch& match) {
  RoadMoment moment{match::timed_match(match), match.phase, match.on_road, {}};
  if (match.on_road) {
    const Eigen::Vector3d place(match.matched_enu.x(), match.matched_enu.y(), 0.0);
    moment.place = LocalFrame(match.origin).to_geodetic(place);
  }
  return moment;
}

vehicle::Observer RunPass::observer() {
  vehicle::Observer o = end_observer();
  o.odometry = [this](const RelativeMotion& motion) { odometry.add(motion); };
  o.lidar = [this](const LidarMotion& motion) { lidar.add(motion); };
  o.image_state = [this](const FusedState& state) {
    fused.add(state, state.position_enu, state.attitude);
    odom.add(state, state.odom.position, state.odom.attitude);
  };
  o.ppp = [this](const PppState& state) { ppp_states[state.stamp] = state; };
  o.nav_state = [this, last = o.nav_state](const FusedState& state) {
    if (track.add(state)) odom_track.add(state, state.odom.position, state.odom.attitude);
    if (state.protection) protection.push_back(*state.protection);
    last(state);
  };
  o.map_match = [this](const MapMatch& match) {
    if (match.refusal != FixRefusal::no_position) matches[match.stamp] = road_moment(match);
  };
  o.calibration = [this](const vehicle::CalibrationReport& report) {
    calibrations.push_back(report);
  };
  o.map_feedback = [this](const MapFeedback& back) {
    ++feedbacks[static_cast<std::size_t>(back.reason)];
  };
  return o;
}

vehicle::Observer RunPass::end_observer() {
  vehicle::Observer o;
  o.nav_state = [this](const NavState& state) {
    if (state.status != NavStatus::uninitialized) end = state;
  };
  return o;
}

ReplayResult result_of(const RunPass& pass, const vehicle::VehicleReport& report) {
  ReplayResult result;
  result.end = pass.end;
  result.without_position = pass.track.silent_until(report.last);
  result.vehicle = report;
  result.channels = pass.hashes.summary();
  result.feedbacks = pass.feedbacks;
  if (!pass.ppp_states.empty()) result.ppp.emplace(pass.ppp_states);
  return result;
}

std::shared_ptr<const mapmatch::RoadNetwork> roads_about(const RunPass& pass,
                                                         const vehicle::RoadMap& map) {
  constexpr double margin = 1000.0;  // m
  std::vector<Geodetic> places;
  for (const NavState& state : pass.track.states())
    places.push_back(LocalFrame(state.origin).to_geodetic(state.position_enu));
  return vehicle::network_about(map, places, margin);
}

void score(ReplayResult& result, const RunPass& pass, const vehicle::Recording& recording,
           const std::vector<ReferencePose>& reference, const vehicle::RoadMap* map,
           const sensors::ReferenceTrajectory* camera_truth, Duration after) {
  const Time from = after > Duration::zero() ? recording.first_stamp + after : Time::min();
  result.begin = recording.first_stamp;
  result.images = recording.images;
  const vehicle::Sensors sensors = recording.sensors(Time::max());
  result.has_gnss = sensors.gnss != nullptr || sensors.epochs != nullptr;
  if (result.ppp && sensors.ppp) result.ppp->never_converges = sensors.ppp->never_converges();
  if (map != nullptr && result.end) result.map = map_use(*result.end, pass, *map);
  if (map != nullptr && recording.driven_links)
    result.links = links_score(pass, *recording.driven_links, *map, from);
  result.peer_reference = recording.calibration.peer_reference;
  result.outage_ends = outage_ends(pass.track, recording, reference);
  const Eigen::Isometry3d& T_body_cam = recording.calibration.stereo.T_body_cam;
  const auto score_cameras = [&](const TrajectoryCollector::Reference& pose) {
    const auto accuracy = [&](const TrajectoryCollector& trajectory) {
      return trajectory.score([&](Time t) { return t < from ? std::nullopt : pose(t); },
                              T_body_cam);
    };
    result.vo = accuracy(pass.odometry);
    result.lidar = accuracy(pass.lidar);
    result.fused = accuracy(pass.fused);
    result.odom = accuracy(pass.odom);
  };
  if (camera_truth != nullptr) score_cameras([&](Time t) { return camera_truth->pose(t); });
  if (reference.size() < 2) return;
  const sensors::ReferenceTrajectory truth(reference, LocalFrame(reference.front().position));
  if (camera_truth == nullptr) {
    score_cameras([&](Time t) {
      auto pose = truth.pose(t);
      if (pose) *pose = *pose * T_body_cam;
      return pose;
    });
  }
  Time named = Time::max();
  for (const vehicle::Naming& naming : result.vehicle.named) named = std::min(named, naming.at);
  result.navigation = fusion_score::score(pass.track, reference, recording.outages,
                                          recording.first_stamp, named, from);
  result.protection = fusion_score::score(pass.protection, pass.track, reference, from);
  if (result.navigation)
    result.navigation->odom_percent = odom_percent(pass.odom_track.poses(), truth, from);
}

}  // namespace maploop::tools
