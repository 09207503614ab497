// This file lists what was requested of the machine for real time, and formats the list as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "msgs/realtime_setting.h"

namespace maploop::runtime {

struct RealtimeReport {
  std::vector<RealtimeSetting> settings;

  bool all_granted() const;
  // Returns the first item of that name, or nullptr.
  const RealtimeSetting* find(std::string_view name) const;
};

// Returns a line for each item, followed by one for the reason and one for the remedy if it has
// them.
std::string to_text(const RealtimeReport& report);

// Returns one line, followed by one with the remedy for each item that is not granted.
std::string to_short_text(const RealtimeReport& report);

// Returns "fusion: scheduling is other, not fifo 60: REASON; REMEDY" for an item that is not
// granted.
std::string to_sentence(const RealtimeSetting& setting);

}  // namespace maploop::runtime
