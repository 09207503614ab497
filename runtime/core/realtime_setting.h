// A list of what was asked of the machine for real time, and its text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "msgs/realtime_setting.h"

namespace maploop::runtime {

struct RealtimeReport {
  std::vector<RealtimeSetting> settings;

  bool all_granted() const;
  // The first of that name, or nullptr.
  const RealtimeSetting* find(std::string_view name) const;
};

// A line for each item, with a line each for the reason and the remedy where there is one.
std::string to_text(const RealtimeReport& report);

// One line where all is granted; otherwise one more for each item that is not, with its remedy.
std::string to_short_text(const RealtimeReport& report);

// "fusion: scheduling is other, not fifo 60: REASON; REMEDY". Of an item that is not granted.
std::string to_sentence(const RealtimeSetting& setting);

}  // namespace maploop::runtime
