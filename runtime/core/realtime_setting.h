// This file lists what was requested of the machine for real time, and formats the list as text.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "msgs/realtime_setting.h"

namespace maploop::runtime {

// One request. Its functions return the outcome: what was granted, and if that is less than
// requested, why and what to do.
struct RealtimeRequest {
  std::string name, asked;

  RealtimeSetting outcome(Verdict verdict, std::string granted, std::string reason = {},
                          std::string remedy = {}) const {
    return {name, asked, std::move(granted), verdict, std::move(reason), std::move(remedy)};
  }
  RealtimeSetting granted(std::string what) const {
    return outcome(Verdict::granted, std::move(what));
  }
  RealtimeSetting refused(std::string got, std::string reason, std::string remedy) const {
    return outcome(Verdict::refused, std::move(got), std::move(reason), std::move(remedy));
  }
  RealtimeSetting limiting(std::string got, std::string reason, std::string remedy) const {
    return outcome(Verdict::limiting, std::move(got), std::move(reason), std::move(remedy));
  }
  RealtimeSetting unknown(std::string reason, std::string remedy) const {
    return outcome(Verdict::unknown, "unknown", std::move(reason), std::move(remedy));
  }
};

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
