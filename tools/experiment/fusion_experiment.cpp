#include "tools/experiment/fusion_experiment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sensors/replay/odometry_sequence.h"

namespace maploop::experiments {
namespace {

namespace fs = std::filesystem;

// One outage after another, as long as the first minute (or what a short drive has) has taught the
// filter its sensors.
std::string regular_outages(double duration, double length) {
  constexpr double settled = 60.0, least = 45.0;
  if (duration < settled + length + 1.0) {
    const double start = duration - length - 1.0;
    return start < least ? "" : std::to_string(start) + ":" + std::to_string(length);
  }
  std::string text;
  for (double start = settled; start + length < duration; start += length + settled) {
    text += (text.empty() ? "" : ",") + std::to_string(start) + ":" + std::to_string(length);
  }
  return text;
}

void add_dead_reckoning(const Sequence& s, int seeds, std::vector<FusionCase>& cases) {
  std::vector<std::string> configurations{"RISS"};
  if (s.tracks_end > 0.0) configurations = {"VO-RI", "RISS", "RISS-VO"};
  for (const std::string& configuration : configurations) {
    FusionCase c;
    c.sequence = s.name;
    c.configuration = configuration;
    c.end = s.tracks_end;
    cases.push_back(c);
    if (configuration == "VO-RI") {
      for (const char* aiding : {"none", "chained"}) {
        c.azimuth_aiding = aiding;
        cases.push_back(c);
      }
      c.azimuth_aiding = "as named";
    }
    c.zero_velocity = false;
    cases.push_back(c);
    c.zero_velocity = true;
    c.mems = true;
    for (c.seed = 1; c.seed <= seeds; ++c.seed) cases.push_back(c);
  }
}

void add_outages(const Sequence& s, int seeds, std::vector<FusionCase>& cases) {
  for (const double length : {30.0, 60.0, 120.0}) {
    for (const bool mems : {false, true}) {
      for (const char* configuration : {"GNSS+RISS", "GNSS+RISS-VO", "GNSS+VO-RI"}) {
        const bool with_tracks = std::string(configuration) != "GNSS+RISS";
        FusionCase c;
        c.sequence = s.name;
        c.configuration = configuration;
        c.mems = mems;
        c.speed_scale = 0.01;
        c.end = with_tracks ? s.tracks_end : 0.0;
        c.outages = regular_outages(with_tracks ? s.tracks_end : s.duration, length);
        if (c.outages.empty()) continue;
        for (c.seed = 1; c.seed <= seeds; ++c.seed) cases.push_back(c);
      }
    }
  }
}

}  // namespace

FusionResult run(const fs::path& folder, const FusionCase& setup,
                 const vehicle::VehicleConfig& given) {
  vehicle::VehicleConfig config = config_of(given, setup);
  if (setup.azimuth_aiding == "none") config.fusion.use_odometry_azimuth = false;
  if (setup.azimuth_aiding == "chained") config.fusion.chain_odometry_azimuth = true;
  config.fusion.use_zero_velocity = setup.zero_velocity;
  SequenceRun run = run_sequence(folder, setup, config);
  return {setup, run.score, std::move(run.track)};
}

std::vector<FusionCase> fusion_cases(const fs::path& folder, int seeds) {
  std::vector<FusionCase> cases;
  for (const Sequence& s : sequences) {
    if (!sensors::OdometrySequence::is_named(folder / s.name)) continue;
    add_dead_reckoning(s, seeds, cases);
    add_outages(s, seeds, cases);
  }
  if (cases.empty()) {
    throw std::runtime_error("no sequence in '" + folder.string() +
                             "': it needs oxts/00.csv and the like");
  }
  return cases;
}

}  // namespace maploop::experiments
