// Runs a recording through the vehicle's own graph, on virtual time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/graph/vehicle.h"

namespace maploop::tools {

struct RecordingRun {
  vehicle::Recording recording;
  std::vector<ReferencePose> reference;
  vehicle::VehicleReport report;
};

// How a recording is run.
struct RecordingRunOptions {
  double end = 0.0;  // s into the drive; 0: the whole
  std::vector<vehicle::MessageSink*> sinks{};
  // Asked every few milliseconds, where it is set; false ends the run.
  std::function<bool()> go_on{};
};

// Runs any recording, which was opened with `config`.
RecordingRun run_recording(vehicle::Recording recording, const vehicle::VehicleConfig& config,
                           const RecordingRunOptions& options, vehicle::Observer observer,
                           std::shared_ptr<const vehicle::RoadMap> map = nullptr);

}  // namespace maploop::tools
