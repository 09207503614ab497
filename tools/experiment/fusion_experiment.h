// The filter's configurations on the sequences of KITTI's odometry benchmark: dead reckoning from a
// known start, and GNSS outages.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/sequence_run.h"

namespace maploop::experiments {

// One run of one sequence.
struct FusionCase : SequenceCase {
  std::string azimuth_aiding = "as named";  // or "none", "chained"
  bool zero_velocity = true;
};

struct FusionResult {
  FusionCase setup;
  fusion_score::Score score;
  fusion_score::NavTrack track;
};

// Throws as run_sequence().
FusionResult run(const std::filesystem::path& folder, const FusionCase& setup,
                 const vehicle::VehicleConfig& config);

// Every case that there is data for in `folder` (kitti_odometry), `seeds` realizations of what is
// random.
std::vector<FusionCase> fusion_cases(const std::filesystem::path& folder, int seeds);

std::string to_text(const std::vector<FusionResult>& results);
// One self-contained page.
std::string to_html(const std::filesystem::path& folder, const std::vector<FusionResult>& results);

}  // namespace maploop::experiments
