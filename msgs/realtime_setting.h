// What was asked of the machine for real time, and what it gave.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace maploop {

enum class Verdict : std::uint8_t {
  granted,   // as asked, or nothing stands in the way
  refused,   // asked of the kernel, which gave less
  limiting,  // a property of this machine that makes it less punctual; nothing was asked
  unknown,   // this machine does not say
};

constexpr std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::granted:
      return "granted";
    case Verdict::refused:
      return "refused";
    case Verdict::limiting:
      return "limiting";
    case Verdict::unknown:
      return "unknown";
  }
  return "unknown";
}

// One item. `granted` is always read back after asking, never assumed.
struct RealtimeSetting {
  std::string name;     // "fusion: scheduling", "locked memory"
  std::string asked;    // "fifo 60"
  std::string granted;  // "other"
  Verdict verdict = Verdict::unknown;
  std::string reason;  // why not; empty where granted
  std::string remedy;  // what to do, one line; empty where granted
};

}  // namespace maploop
