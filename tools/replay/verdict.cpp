#include "tools/replay/replay_result.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "estimators/fusion/outcome.h"
#include "msgs/frames.h"
#include "sensors/imu/aligned_imu.h"
#include "tools/command/median.h"

namespace maploop::tools {
namespace {

constexpr std::size_t line_width = 79;
constexpr double worth_a_word = 0.02;  // of a stage's inputs

std::uint64_t delivered(const ReplayResult& r, std::string_view sensor) {
  for (const vehicle::SensorReport& s : r.vehicle.sensors) {
    if (s.name == sensor) return s.source.delivered;
  }
  return 0;
}

// What the fusion refused most, as long as it had no position.
const RefusalCount* most_refused(const ReplayResult& r) {
  const RefusalCount* most = nullptr;
  for (const RefusalCount& c : r.vehicle.health.refusals) {
    if (c.stage == "fusion" && (most == nullptr || c.count > most->count)) most = &c;
  }
  return most;
}

std::string where(const ReplayResult& r) {
  const char* begin = r.interrupted ? "Interrupted after" : "After";
  if (!r.end) return fmt::format("{} {:.1f} s: no position.", begin, r.vehicle.data_seconds);
  const Geodetic place = LocalFrame(r.end->origin).to_geodetic(r.end->position_enu);
  const double sigma = std::sqrt(std::max(0.0, r.end->covariance.topLeftCorner<2, 2>().trace()));
  constexpr double soon = 1.0;  // s
  const double ago = to_seconds(r.vehicle.last - r.end->stamp);
  const std::string none_since =
      ago > soon ? fmt::format(": no position since {:.1f} s, then", r.vehicle.data_seconds - ago)
                 : std::string();
  return fmt::format("{} {:.1f} s{} at {:.6f} {} {:.6f} {}, +-{:.{}f} m (1 sigma).", begin,
                     r.vehicle.data_seconds, none_since, std::abs(degrees(place.latitude)),
                     place.latitude < 0.0 ? 'S' : 'N', std::abs(degrees(place.longitude)),
                     place.longitude < 0.0 ? 'W' : 'E', sigma, sigma < 1000.0 ? 1 : 0);
}

// The fixes that an outage took away are the only independent truth of a drive whose reference is
// the receiver's own fusion.
std::string against_peers(const ReplayResult& r) {
  if (r.outage_ends.empty()) {
    const fusion_score::Errors& e = r.navigation->whole;
    return fmt::format("{:.2f} m RMS, {:.1f} m at most, from the receiver's own fusion, a peer.",
                       e.rmse, e.max);
  }
  std::vector<double> errors;
  for (const fusion_score::OutageEnd& end : r.outage_ends) errors.push_back(end.error);
  const double worst = *std::max_element(errors.begin(), errors.end());
  return fmt::format("After {} made outages {:.1f} m from the fixes (median), {:.1f} m at worst.",
                     errors.size(), median(errors), worst);
}

std::string score_of(const ReplayResult& r) {
  if (r.outage_ends.empty() && r.navigation && r.navigation->whole.covered == 0.0)
    return "Not scored: no state is within the time that is scored and has a reference.";
  if (!r.outage_ends.empty() || (r.peer_reference && r.navigation)) return against_peers(r);
  if (r.navigation) {
    const fusion_score::Errors& e = r.navigation->whole;
    const int digits = e.max < 1000.0 ? 2 : 0;
    const std::string share =
        e.covered < 0.98 ? fmt::format("{:.0f} % of ", 100.0 * e.covered) : std::string();
    return fmt::format(
        "Horizontal error {:.{}f} m RMS, {:.{}f} m at most, against {}the reference.", e.rmse,
        digits, e.max, digits, share);
  }
  if (r.ppp && r.ppp->never_converges && r.ppp->converged_after < 0.0)
    return "PPP does not converge to 0.1 m on one frequency with broadcast orbits.";
  if (r.ppp && r.ppp->converged_after >= 0.0) {
    return fmt::format("PPP converged after {:.0f} s; there is no reference to score against.",
                       r.ppp->converged_after);
  }
  if (r.ppp) return "PPP has not converged yet; there is no reference to score against.";
  if (r.live) return "Not scored: a live run has no reference.";
  return r.end ? "Not scored: the recording has no reference to score against."
               : "Not scored: there is no position.";
}

std::string how_good(const ReplayResult& r) {
  constexpr double worth_saying = 1.0;  // s
  std::string score = score_of(r);
  if (r.without_position < worth_saying) return score;
  return fmt::format("{} No position for {:.0f} s after the first.", score, r.without_position);
}

// Most important first.
std::vector<std::string> unused(const ReplayResult& r) {
  std::vector<std::string> items;
  for (const ThreadHealth& t : r.vehicle.health.threads) {
    if (!t.failure.empty()) items.push_back("the " + t.name + " thread, which failed");
  }
  std::vector<RefusalCount> refusals = r.vehicle.health.refusals;
  const auto most_first = [](const RefusalCount& a, const RefusalCount& b) {
    return a.count > b.count;
  };
  std::stable_sort(refusals.begin(), refusals.end(), most_first);
  const std::string_view after_start = to_string(fusion::Reason::already_started);
  for (const RefusalCount& c : refusals) {
    if (c.stage == "fusion" && c.reason == after_start) {
      const std::string who =
          r.configuration.starts_with("GNSS+") ? "" : "; GNSS+" + r.configuration + " uses it";
      items.push_back(fmt::format("GNSS after the start ({} fixes{})", c.count, who));
    }
  }
  for (const vehicle::SensorReport& s : r.vehicle.sensors) {
    if (s.source.refused == 0) continue;
    const std::string_view reason = s.source.main_reason();
    items.push_back(reason == sensors::AlignedImu::not_yet_known
                        ? fmt::format("{} of {} ({})", s.source.refused, s.name, reason)
                        : fmt::format("{} of {} left out by the reader", s.source.refused, s.name));
  }
  const auto few = static_cast<std::uint64_t>(worth_a_word * static_cast<double>(r.images));
  for (const RefusalCount& c : refusals) {
    if (c.reason == after_start || c.count <= few) continue;
    items.push_back(fmt::format("{} by {} ({})", c.count, c.stage, c.reason));
  }
  return items;
}

std::string what_not(const ReplayResult& r) {
  const std::vector<std::string> items = unused(r);
  if (items.empty()) return r.configuration + " used all that it was given.";
  std::string line = r.configuration + " did not use ";
  std::size_t said = 0;
  for (; said < items.size(); ++said) {
    const std::string item = (said > 0 ? "; " : "") + items[said];
    const std::size_t rest = said + 1 < items.size() ? std::string("; 99 more").size() : 0;
    if (line.size() + item.size() + rest > line_width) break;
    line += item;
  }
  if (said == 0) return (line + items.front()).substr(0, line_width);
  if (said < items.size()) line += fmt::format("; {} more", items.size() - said);
  return line;
}

std::string why_no_position(const ReplayResult& r) {
  const std::string head = "there is no position: ";
  if (!r.has_gnss) {
    return head +
           "the recording has no GNSS to start from (KITTI: the folder oxts or gnss); 'maploop "
           "odometry DRIVE' gives its odometry alone";
  }
  if (delivered(r, "gnss") == 0) {
    return head +
           "no GNSS came to start from; look for an outage or a fault that was asked for, or start "
           "with --start-from-reference where the recording has a reference";
  }
  const RefusalCount* most = most_refused(r);
  return head + "the filter never started from the GNSS that came" +
         (most != nullptr ? " (most often: " + most->reason + ")" : "") +
         "; --verbose shows what each stage did not use";
}

}  // namespace

std::string verdict_text(const ReplayResult& result) {
  std::string text;
  for (const std::string& line : verdict(result)) text += line + '\n';
  return text;
}

std::array<std::string, 3> verdict(const ReplayResult& result) {
  return {where(result), how_good(result), what_not(result)};
}

std::optional<std::string> why_empty(const ReplayResult& r) {
  if (r.interrupted) return std::nullopt;
  if (r.live) {
    for (const vehicle::SensorReport& s : r.vehicle.sensors) {
      if (s.source.delivered > 0) return std::nullopt;
    }
    return "no sensor gave a single sample; 'maploop sensors CONFIG.toml' shows what comes from "
           "each endpoint";
  }
  if (!r.end) {
    const bool lidar_alone = r.images > 0 && delivered(r, "velodyne") > 0 && !r.has_gnss &&
                             delivered(r, "camera") == 0 && delivered(r, "imu") == 0;
    if (lidar_alone) return std::nullopt;
    return why_no_position(r);
  }
  if (r.map && r.map->elsewhere) {
    return "no position was on a road of the map, which covers " + r.map->area +
           "; give --map a map of the place of the drive, or leave it out";
  }
  return std::nullopt;
}

}  // namespace maploop::tools
