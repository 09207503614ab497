// Evaluates the DEADLINES and HEALTH of one run: where its time was spent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"
#include "tools/web/page.h"
#include "tools/web/table.h"

namespace maploop::profile {

// One latency as recorded, and its percentiles corrected by the waits that stalls hid.
struct Latency : LatencySummary {
  Duration corrected_p99{}, corrected_p999{};
  std::uint64_t hidden = 0;  // number of waits added for the corrected percentiles
};

struct WorstMiss {
  std::string of;  // name of the thread or path
  Duration deadline{};
  MissedDeadline miss;
};

// Returns the item of that name; nullptr if there is none.
template <class Item>
const Item* find(const std::vector<Item>& all, std::string_view name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Item& item) { return item.name == name; });
  return found == all.end() ? nullptr : &*found;
}

// All figures cover the whole run up to `stamp`.
struct Profile {
  Time stamp{};
  std::vector<Latency> threads, paths;
  std::vector<LatencySummary> wake_up, execution, period_jitter;
  std::vector<WorstMiss> worst;  // of all threads and paths, most overdue first; at most ten
  Health health;                 // contains the processor time

  // Whether the run was on virtual time, where the fusion does not wake up at given times and
  // deadlines have no meaning.
  bool virtual_time() const { return period_jitter.empty() && worst.empty(); }
};

inline constexpr const char* no_deadlines =
    "The run was on virtual time: deadlines have no meaning there, and none is judged.";

// The name, the count, and the percentiles in ms.
extern const web::Columns<LatencySummary> percentiles;

// The deadline with its misses, unless none is judged, and the corrected percentiles, if any.
web::Columns<Latency> judgement(bool virtual_time);

// Returns the parts of a late result: "waiting 1.200, stereo 55.031", in ms.
std::string parts_text(const MissedDeadline& miss);

// Processor time of one thread, of everything outside the threads, or of the whole process.
struct ProcessorTime {
  std::string name;
  double seconds = 0.0, percent = 0.0;  // percent of one processor
};
std::vector<ProcessorTime> processor_time(const Health& health);

// Throws std::invalid_argument if a histogram is damaged.
Profile profile_of(const Deadlines& deadlines, const Health& health);

// Takes messages of a run one after the other. The last ones are used, because their figures cover
// the whole run up to then.
class ProfileCollector {
 public:
  // Takes a message of any channel; only DEADLINES and HEALTH are used.
  void add(std::string_view channel, std::span<const std::uint8_t> data);

  // Throws std::runtime_error naming `source` if it had no DEADLINES or HEALTH that this version
  // can decode.
  Profile profile(const std::string& source) const;

 private:
  bool heard_deadlines_ = false, heard_health_ = false;
  std::uint64_t not_understood_ = 0;
  Deadlines deadlines_;
  Health health_;
};

// Reads a log of LCM. Throws std::runtime_error that names it if it cannot be read, too.
Profile profile_of_log(const std::filesystem::path& log);

// Return a table for a terminal, and the same as JSON and as one self-contained HTML page.
std::string to_text(const Profile& profile);
std::string to_json(const Profile& profile);
// `ticks` of read_trace_ticks() are shown one by one; null: there is no trace.
std::string to_html(const Profile& profile, const std::string& source, const nlohmann::json& ticks);

// Add parts of this page to another one: the table of threads and paths with the worst misses; the
// distributions; and the processor time.
void add_latencies(web::Page& page, const Profile& profile);
void add_distributions(web::Page& page, const Profile& profile);
void add_processor_time(web::Page& page, const Profile& profile);

}  // namespace maploop::profile
