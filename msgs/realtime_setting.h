// This file reports what was requested of the machine for real time, and what it granted.
#pragma once

#include <cstdint>
#include <string>

#include "msgs/named_enum.h"

namespace maploop {

enum class Verdict : std::uint8_t {
  granted,   // as requested, or without an obstacle
  refused,   // requested of the kernel, which gave less
  limiting,  // a property of this machine that harms punctuality; nothing was requested
  unknown,   // this machine gives no information
};

constexpr auto names_of(Verdict) {
  return names_up_to<Verdict::unknown>({"granted", "refused", "limiting", "unknown"});
}

// Describes one item. `granted` is always read back after the request, never assumed.
struct RealtimeSetting {
  std::string name;     // "fusion: scheduling", "locked memory"
  std::string asked;    // "fifo 60"
  std::string granted;  // "other"
  Verdict verdict = Verdict::unknown;
  std::string reason;  // why not; empty if granted
  std::string remedy;  // what to do, one line; empty if granted

  void archive(auto& ar) { ar(name, asked, granted, verdict, reason, remedy); }
};

}  // namespace maploop
