#include "tools/ppp/other_solution.h"

#include "ppp/models/geodesy.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::gnss {

using namespace maploop::ppp;

void OtherSolution::add(const PppSolution& solution) {
  if (solution.status != PppStatus::none) positions[solution.time] = solution.position;
}

std::optional<Eigen::Vector3d> OtherSolution::at(GpsTime t) const {
  constexpr Duration same = std::chrono::milliseconds(10);
  const auto found = positions.lower_bound(t - same);
  if (found == positions.end() || found->first > t + same) return {};
  return found->second;
}

OtherSolution read_solution(const std::filesystem::path& file) {
  const evaluation::StampedTrajectory trajectory = evaluation::read_rtklib_positions(file);
  const LocalFrame frame(*trajectory.origin);
  OtherSolution solution{file.filename().string()};
  for (std::size_t i = 0; i < trajectory.stamps.size(); ++i) {
    // Its calendar is that of GPS time, which has no leap seconds, as the reader's.
    const GpsTime time(trajectory.stamps[i] - Time(gps_epoch_day));
    solution.positions[time] =
        ecef_from_geodetic(frame.to_geodetic(trajectory.poses[i].translation()));
  }
  return solution;
}

}  // namespace maploop::gnss
