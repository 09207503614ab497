// What was asked of the machine for real time, and what it gave.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::runtime {

enum class Verdict : std::uint8_t {
  granted,   // as asked, or nothing stands in the way
  refused,   // asked of the kernel, which gave less
  limiting,  // a property of this machine that makes it less punctual; nothing was asked
  unknown,   // this machine does not say
};

std::string_view to_string(Verdict verdict);

// One item. `granted` is always read back after asking, never assumed.
struct RealtimeSetting {
  std::string name;     // "fusion: scheduling", "locked memory"
  std::string asked;    // "fifo 60"
  std::string granted;  // "other"
  Verdict verdict = Verdict::unknown;
  std::string reason;  // why not; empty where granted
  std::string remedy;  // what to do, one line; empty where granted
};

struct RealtimeReport {
  std::vector<RealtimeSetting> settings;

  bool all_granted() const;
  // The first of that name, or nullptr.
  const RealtimeSetting* find(std::string_view name) const;
};

// A line for each item, with a line each for the reason and the remedy where there is one.
std::string to_text(const RealtimeReport& report);

}  // namespace maploop::runtime
