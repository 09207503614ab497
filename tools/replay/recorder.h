// The recorder of a run (--record).
#pragma once

#include <filesystem>
#include <memory>

#include "runtime/vehicle/output/log_recorder.h"

namespace maploop::tools {

// Records to an MCAP file (tools/log/mcap_log.h) if the name ends in .mcap, else to an LCM log. Of
// an MCAP file a run that is killed loses the last chunk, at most a second, and the index. Throws
// std::runtime_error as LogRecorder's constructor does, and for a bag (.bag).
std::unique_ptr<vehicle::LogRecorder> make_recorder(const std::filesystem::path& file, bool raw,
                                                    vehicle::LogRecorder::WhenBehind when_behind);

}  // namespace maploop::tools
