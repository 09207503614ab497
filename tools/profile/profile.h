// What DEADLINES and HEALTH of one run say of where its time went.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"

namespace maploop::profile {

// Percentiles of one latency, as recorded and with the waits that stalls hid.
struct Latency {
  LatencySummary recorded;
  Duration corrected_p99{}, corrected_p999{};
  std::uint64_t omitted = 0;  // waits added for the corrected ones
};

struct WorstMiss {
  std::string of;  // the thread or path
  Duration deadline{};
  MissedDeadline miss;
};

// All figures are of the whole run up to `stamp`.
struct Profile {
  Time stamp{};
  std::vector<Latency> threads, paths;
  std::vector<LatencySummary> wake_up, execution, period_jitter;
  std::vector<WorstMiss>
      worst;      // of all threads and paths, the latest beyond its deadline first; at most ten
  Health health;  // processor time

  // Nothing wakes up at a given moment there, and deadlines have no meaning.
  bool virtual_time() const { return wake_up.empty() && worst.empty(); }
};

inline constexpr const char* no_deadlines =
    "The run was on virtual time: deadlines have no meaning there, and none is judged.";

// Throws std::invalid_argument where a histogram is damaged.
Profile profile_of(const Deadlines& deadlines, const Health& health);

// Takes messages of a run one after the other; the last ones count, since their figures are of all
// that went before.
class ProfileCollector {
 public:
  // Of any channel; others than DEADLINES and HEALTH change nothing.
  void add(std::string_view channel, std::span<const std::uint8_t> data);

  // Throws std::runtime_error naming `source` when it had no DEADLINES or HEALTH that this version
  // understands.
  Profile profile(const std::string& source) const;

 private:
  bool heard_deadlines_ = false, heard_health_ = false;
  std::uint64_t not_understood_ = 0;
  Deadlines deadlines_;
  Health health_;
};

// A table for a terminal, and the same as JSON and as one HTML page that needs nothing else.
std::string to_text(const Profile& profile);
std::string to_json(const Profile& profile);
std::string to_html(const Profile& profile, const std::string& source);

}  // namespace maploop::profile
