#include "tools/replay/run_pass.h"

#include <algorithm>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "tools/replay/nav_files.h"
#include "tools/replay/verdict.h"

namespace maploop::tools {

void warn_of_another_run(const std::string& sentence) {
  std::cerr << "\nmaploop: " << sentence << '\n';
}

vehicle::Observer RunPass::observer() {
  vehicle::Observer o = end_observer();
  o.odometry = [this](const RelativeMotion& motion) { collector.add(motion); };
  o.lidar = [this](const LidarMotion& motion) { lidar_collector.add(motion); };
  o.ppp = [this](const PppState& state) {
    if (!ppp) ppp.emplace();
    ppp->add(state);
    ppp_states[state.stamp] = state;
  };
  o.nav_state = [this, last = o.nav_state](const NavState& state) {
    track.add(state);
    last(state);
  };
  o.map_match = [this](const MapMatch& match) {
    if (match.refusal == FixRefusal::no_position) return;
    matches[match.stamp] = match::timed_match(match);
    road_moments[match.stamp] = report::road_moment(match);
  };
  o.image_state = [this](const NavState& state) { collector.add(state); };
  return o;
}

bool write_all(const std::vector<std::function<void()>>& writers) {
  bool all = true;
  for (const auto& write : writers) {
    try {
      write();
    } catch (const std::exception& e) {
      std::cerr << "maploop: " << e.what() << '\n';
      all = false;
    }
  }
  return all;
}

vehicle::Observer RunPass::end_observer() {
  vehicle::Observer o;
  o.nav_state = [this](const NavState& state) {
    if (state.status != NavStatus::uninitialized) end = state;
  };
  return o;
}

void write_states(const StateFiles& files, const RunPass& pass) {
  const evaluation::StampedTrajectory fused = pass.collector.fused();
  for (const std::filesystem::path& file : {files.poses, files.tum}) {
    if (!file.empty() && fused.poses.empty())
      throw std::runtime_error(
          "'" + file.string() +
          "' is not written: no image has a fused pose; --csv and --nmea write "
          "the fused state without images");
  }
  if (!files.poses.empty()) evaluation::write_kitti_poses(files.poses, fused.poses);
  if (!files.tum.empty()) evaluation::write_tum(files.tum, fused);
  if (!files.csv.empty()) write_nav_csv(files.csv, pass.track);
  if (!files.nmea.empty()) write_nmea(files.nmea, pass.track);
}

void write_run_report(const std::filesystem::path& file, const ReplayResult& result,
                      const RunPass& pass, std::vector<ReferencePose> reference,
                      const vehicle::VehicleConfig& config, const vehicle::RoadMap* map) {
  std::vector<report::DeadReckoning> ways{{"stereo odometry", pass.collector.odometry()}};
  const auto lidar = pass.lidar_collector.odometry();
  if (!lidar.poses.empty()) ways.push_back({"LiDAR odometry", lidar});
  const fusion::FusionParameters& p = config.fusion;
  const Eigen::Vector3d antenna(p.gnss_lever_forward, p.gnss_lever_left, p.gnss_lever_up);
  report::write_report(file, {result, pass.track, std::move(reference), std::move(ways),
                              pass.road_moments, pass.ppp_states, antenna, vehicle::to_toml(config),
                              MAPLOOP_VERSION, map != nullptr ? &map->network : nullptr});
}

std::string closing_text(const ReplayResult& result, bool tables) {
  return tables ? verdict_text(result) + format_table(result) : verdict_text(result);
}

bool any_thread_failed(const ReplayResult& result) {
  const auto& threads = result.vehicle.health.threads;
  return std::any_of(threads.begin(), threads.end(),
                     [](const ThreadHealth& t) { return !t.failure.empty(); });
}

}  // namespace maploop::tools
