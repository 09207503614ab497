// The filter's configurations on the sequences of KITTI's odometry benchmark: dead reckoning from a
// known start, and GNSS outages.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/vehicle/vehicle_config.h"
#include "tools/fusion_score.h"

namespace maploop::experiments {

// One run of one sequence.
struct FusionCase {
  std::string sequence;  // "06"
  std::string configuration;
  bool mems = false;                        // noise of such a unit is added
  std::string azimuth_aiding = "as named";  // or "none", "chained"
  bool zero_velocity = true;
  double speed_scale = 0.0;  // of the wheels
  std::string outages;       // as --gnss-outage; empty: dead reckoning from the reference's start
  double end = 0.0;          // s into the drive; 0: the whole
  std::int64_t seed = 1;
};

struct FusionResult {
  FusionCase setup;
  fusion_score::Score score;
  fusion_score::NavTrack track;
};

// Through the vehicle's own graph on virtual time. Throws std::runtime_error naming a file that
// cannot be read.
FusionResult run(const std::filesystem::path& folder, const FusionCase& setup,
                 const vehicle::VehicleConfig& config);

// Every case that there is data for in `folder` (kitti_odometry), `seeds` realizations of what is
// random.
std::vector<FusionCase> fusion_cases(const std::filesystem::path& folder, int seeds);

std::string to_text(const std::vector<FusionResult>& results);
// One self-contained page.
std::string to_html(const std::filesystem::path& folder, const std::vector<FusionResult>& results);

}  // namespace maploop::experiments
