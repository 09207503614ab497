// A black box holds the newest events of a run, and survives whatever ends it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "runtime/vehicle/output/log_format.h"

namespace maploop::vehicle {

// The events of a recorder in a ring of this many bytes (black_box_file.h): what is written is
// found again after the process was killed, and, up to a second before, after a power cut. When a
// HEALTH event says that a thread has failed, or another process asks (ask_to_freeze()), it is
// written for `after` more and then no longer, so that it still shows what came before.
//
// A replay starts at a SNAPSHOT event, before which the newest CALIBRATION is written again.
LogFormatOf black_box_format(std::uint64_t bytes,
                             std::chrono::nanoseconds after = std::chrono::seconds(10));

// Asks the run that writes the box to freeze it. Throws std::runtime_error that names the file if
// it is no black box, or cannot be written.
void ask_to_freeze(const std::filesystem::path& box);

}  // namespace maploop::vehicle
