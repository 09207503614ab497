#include "tools/experiments/fusion_experiment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/limited_source.h"
#include "runtime/vehicle/recording.h"
#include "runtime/vehicle/vehicle.h"
#include "sensors/replay/odometry_sequence.h"

namespace maploop::experiments {
namespace {

namespace fs = std::filesystem;

// How much of a sequence can be scored, and with what.
struct Sequence {
  const char* name;
  double duration;    // s
  double tracks_end;  // s into it that the recorded tracks are good for; 0: none
};
// Of 01, frames beyond 199 contradict the motion (a wrong stereo match in most of them).
constexpr Sequence sequences[] = {{"00", 470.0, 0.0}, {"01", 114.0, 20.4}, {"02", 483.0, 0.0},
                                  {"03", 82.0, 0.0},  {"04", 28.0, 0.0},   {"06", 114.0, 103.5},
                                  {"08", 422.0, 0.0}, {"10", 124.0, 0.0}};

fs::path table_of(const fs::path& folder, const std::string& sequence) {
  return folder / sequence;
}

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
  vehicle::VehicleConfig config = given;
  set_configuration(config, setup.configuration);
  if (setup.mems) {
    set_imu_grade(config, "mems");
    config.imu_noise = "mems";
  }
  if (setup.azimuth_aiding == "none") config.fusion.use_odometry_azimuth = false;
  if (setup.azimuth_aiding == "chained") config.fusion.chain_odometry_azimuth = true;
  config.fusion.use_zero_velocity = setup.zero_velocity;
  config.wheel.scale_error = setup.speed_scale;
  config.gnss.seed = config.wheel.seed = config.imu_seed = setup.seed;
  config.gnss_outage = setup.outages;

  const vehicle::Recording recording =
      vehicle::open_recording(table_of(folder, setup.sequence), config);
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (setup.end > 0.0) limit(sensors, recording.first_stamp + from_seconds(setup.end));
  FusionResult result;
  result.setup = setup;
  vehicle::Observer observer;
  observer.nav_state = [&](const NavState& state) { result.track.add(state); };
  vehicle::Vehicle vehicle(config, recording.calibration, std::move(sensors),
                           runtime::DataClock::virtual_time(), {}, std::move(observer));
  if (setup.outages.empty()) vehicle.start_from(vehicle::start_from_reference(recording));
  vehicle.start();
  vehicle.wait();
  const auto score = fusion_score::score(result.track, *recording.sensors(Time::max()).reference,
                                         recording.outages, recording.first_stamp);
  if (!score) {
    throw std::runtime_error("sequence " + setup.sequence + " in " + setup.configuration +
                             " gave nothing to score");
  }
  result.score = *score;
  return result;
}

std::vector<FusionCase> fusion_cases(const fs::path& folder, int seeds) {
  std::vector<FusionCase> cases;
  for (const Sequence& s : sequences) {
    if (!sensors::OdometrySequence::is_named(table_of(folder, s.name))) continue;
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
