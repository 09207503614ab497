// A recording with the configuration that it was opened with and has completed.
#pragma once

#include <filesystem>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"

namespace maploop::python {

struct OpenedRecording {
  vehicle::VehicleConfig config;
  std::filesystem::path path;
  vehicle::Recording recording;
};

}  // namespace maploop::python
