#include "runtime/vehicle/refusals.h"

#include <string_view>

#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {

std::vector<RefusalCount> refusals(const StereoStage& stereo, const LidarStage* lidar,
                                   const PppStage* ppp, const fusion::FilterStatus& filter,
                                   const MapMatchStage* mapmatch) {
  std::vector<RefusalCount> all;
  const auto add = [&](const Stage& stage, std::string_view reason, std::uint64_t count) {
    if (count > 0) all.push_back({std::string(stage.name), std::string(reason), count});
  };
  for (std::size_t i = 1; i < odometry_status_count; ++i) {
    const auto status = static_cast<OdometryStatus>(i);
    add(stages::stereo, to_string(status), stereo.count(status));
    if (lidar != nullptr) add(stages::lidar, to_string(status), lidar->count(status));
  }
  if (ppp != nullptr) {
    const std::vector<RefusalCount> own = ppp->refusals();
    all.insert(all.end(), own.begin(), own.end());
  }
  for (std::size_t i = 1; i < fusion::reason_count; ++i) {
    const auto reason = static_cast<fusion::Reason>(i);
    add(stages::fusion, to_string(reason), filter.refused_for(reason));
  }
  add(stages::fusion, "held, and too old before the start", filter.unused);
  add(stages::fusion, "recovery: the prediction was doubted", filter.recoveries);
  add(stages::fusion, "begun anew at a fix", filter.reinitializations);
  add(stages::fusion, "restart: the clock jumped", filter.restarts);
  add(stages::fusion, "undone: the map had led astray", filter.restorations);
  for (std::size_t i = 1; i < fix_refusal_count && mapmatch != nullptr; ++i) {
    const auto reason = static_cast<FixRefusal>(i);
    add(stages::mapmatch, to_string(reason), mapmatch->count(reason));
  }
  return all;
}

}  // namespace maploop::vehicle
