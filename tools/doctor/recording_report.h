// This file writes what `maploop doctor` found in a recording.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/doctor/recording_health.h"
#include "tools/doctor/time_offsets.h"

namespace maploop::tools {

struct RecordingReport {
  std::string name;  // as the user names the recording
  Time first, last;  // stamps of its samples
  std::vector<SensorHealth> sensors = {};
  std::vector<TimeOffset> offsets = {};
  std::vector<std::string> sentences = {};
};

std::string to_text(const RecordingReport& report);
nlohmann::json to_json(const RecordingReport& report);

// Returns a page: the tables and sentences, and for each sensor over time the share of the samples
// that its rate promises, and the longest delay of their delivery.
std::string to_html(const RecordingReport& report);

}  // namespace maploop::tools
