// Opens a bag or an MCAP file as a recorded drive.
#pragma once

#include <filesystem>

#include "runtime/vehicle/drivers/recording.h"

namespace maploop::vehicle {

// Throws std::runtime_error naming what is wrong with the choice of topics.
FusedSensors fused_sensors_of_bag(const std::filesystem::path& path,
                                  const sensors::BagSummary& contents,
                                  const sensors::BagParameters& parameters);

// Which topic is which sensor is said by sensors/bag/topic_choice.h. Reads the contents if they are
// nullptr. Throws std::runtime_error naming what is wrong.
Recording open_bag(const std::filesystem::path& path, const VehicleConfig& config,
                   const KnownContents& contents);

}  // namespace maploop::vehicle
