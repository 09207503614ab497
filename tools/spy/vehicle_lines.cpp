#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/graph/graph.h"
#include "tools/spy/text.h"

namespace maploop::spy {
namespace {

std::string rings(const Health& health) {
  std::uint64_t lost = 0;
  const RingHealth* fullest = nullptr;
  const auto fill = [](const RingHealth& ring) {
    return static_cast<double>(ring.held) /
           static_cast<double>(std::max<std::uint64_t>(ring.capacity, 1));
  };
  for (const RingHealth& ring : health.rings) {
    lost += ring.lost;
    if (fullest == nullptr || fill(ring) > fill(*fullest)) fullest = &ring;
  }
  if (fullest == nullptr) return "rings: none";
  return fmt::format("rings: {}, lost {}, fullest {} {} of {}", health.rings.size(), lost,
                     printable(fullest->name), fullest->held, fullest->capacity);
}

std::string deadlines_line(const Deadlines& deadlines) {
  std::string line = "deadlines:";
  const auto add = [&](const std::vector<LatencySummary>& summaries) {
    for (const LatencySummary& s : summaries) {
      line += fmt::format("{} {} missed {} of {}", line.back() == ':' ? "" : ",", printable(s.name),
                          s.misses, s.count);
      if (s.misses > 0) {
        line += fmt::format(" (worst {:.1f} of {:.0f} ms: {})", to_milliseconds(s.max),
                            to_milliseconds(s.deadline), printable(s.guilty));
      }
    }
  };
  add(deadlines.threads);
  add(deadlines.paths);
  return line;
}

std::string ppp_line(const PppState& state) {
  std::string line = fmt::format("ppp: {}, {} of {} satellites", to_string(state.status),
                                 state.satellites_used, state.satellites.size());
  if (state.status == PppStatus::none) return line + ": " + printable(state.message);
  line += fmt::format(", within {:.2f} m along, {:.2f} across, {:.2f} up but for a risk of {:g}",
                      state.protection.along, state.protection.across, state.protection.up,
                      state.integrity_risk);
  return line;
}

std::string protection_line(const NavProtection& p) {
  return fmt::format(
      "position: within {:.2f} m, {:.2f} along, {:.2f} across but for a risk of {:g}{}",
      p.horizontal, p.along, p.across, p.risk,
      p.doubted ? "; an aid is doubted, so these levels do not hold" : "");
}

}  // namespace

std::vector<std::string> vehicle_lines(const Traffic& traffic) {
  std::vector<std::string> lines;
  const std::vector<vehicle::Run> runs = traffic.runs();
  for (const vehicle::Run& run : runs) lines.push_back("run: " + to_text(run));
  if (runs.size() > 1) {
    lines.push_back(std::to_string(runs.size()) +
                    " runs publish here: each line below may be of any of them; give each a bus of "
                    "its own (--lcm-url)");
  }
  // A message of another publisher may have the correct form but invalid values: it makes no line.
  const auto of_last = [&](auto message, std::string_view channel, const auto& add) {
    if (!schema::checked_decode(schema::own_schema(), traffic.last(channel), message)) return;
    try {
      add(from_lcm(message));
    } catch (const std::invalid_argument&) {
    }
  };
  of_last(maploop_lcm::health_t{}, vehicle::channels::health.name, [&](const Health& health) {
    lines.push_back(rings(health));
    if (!health.degraded.empty()) {
      lines.push_back("degraded: " + std::to_string(health.degraded.size()) + ": " +
                      printable(health.degraded.front()));
    }
  });
  of_last(maploop_lcm::deadlines_t{}, vehicle::channels::deadlines.name,
          [&](const Deadlines& deadlines) { lines.push_back(deadlines_line(deadlines)); });
  of_last(maploop_lcm::nav_protection_t{}, vehicle::channels::nav_protection.name,
          [&](const NavProtection& levels) { lines.push_back(protection_line(levels)); });
  of_last(maploop_lcm::ppp_state_t{}, vehicle::channels::ppp_state.name,
          [&](const PppState& state) { lines.push_back(ppp_line(state)); });
  return lines;
}

}  // namespace maploop::spy
