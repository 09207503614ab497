// All that the vehicle knows at one moment of data time, to go on from there.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/archive.h"
#include "msgs/sample.h"
#include "runtime/vehicle/config/vehicle_config.h"

namespace maploop::vehicle {

// A cut through the graph at one logical time. Each stage has taken every input with `available` up
// to `at`, and nothing later; its part holds its estimator, its counters, and the results it has
// sent that become available after `at`. Samples of sensors after `at` are read again from the
// recording.
struct Snapshot {
  struct Part {
    std::string stage;
    Bytes content;  // as the stage writes and reads it
    bool operator==(const Part&) const = default;
    template <class Archive>
    void archive(Archive& ar) {
      ar(stage, content);
    }
  };

  Time at{};                // a tick of the fusion
  Time first{};             // when the recording's first sample becomes available
  std::vector<Part> parts;  // of each stage that has a state

  // nullptr: that stage was not saved.
  const Bytes* part(std::string_view stage) const {
    for (const Part& part : parts) {
      if (part.stage == stage) return &part.content;
    }
    return nullptr;
  }
};

// Returns the content of a snapshot's file: some 1.5 MB, and 3 more with a LiDAR's map.
Bytes snapshot_bytes(const Snapshot& snapshot, const VehicleConfig& config);

// The file has its name once it is whole; what was
// there before stays until then. Throws std::runtime_error naming the file.
void write_snapshot(const std::filesystem::path& file, const Snapshot& snapshot,
                    const VehicleConfig& config);

// Throws std::runtime_error naming the file and what is wrong: not readable, no snapshot, damaged,
// of another version, or taken with other settings of the recorded sensors (which setting). The
// estimators' own settings are checked by whoever loads the parts.
Snapshot read_snapshot(const std::filesystem::path& file, const VehicleConfig& config);

// The part of one stage on its way to the snapshot thread; `stamp` and `available` are the cut.
struct StageSnapshot : Sample {
  Bytes content;
};

}  // namespace maploop::vehicle
