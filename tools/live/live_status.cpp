#include "tools/live/live_status.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace maploop::tools {
namespace {

constexpr std::size_t most_looks = 6;  // one a second: long enough for fixes once a second

}  // namespace

void LiveStatus::take(const Health& health) {
  Look look{health.elapsed, {}};
  for (const SensorHealth& sensor : health.sensors) {
    look.delivered[sensor.name] = sensor.delivered;
  }
  const std::lock_guard lock(mutex_);
  looks_.push_back(std::move(look));
  if (looks_.size() > most_looks) looks_.pop_front();
}

std::string LiveStatus::text() const {
  const std::lock_guard lock(mutex_);
  const Look &oldest = looks_.front(), &newest = looks_.back();
  const double seconds = newest.elapsed - oldest.elapsed;
  std::string line;
  for (const auto& [name, delivered] : newest.delivered) {
    const auto before = oldest.delivered.find(name);
    const std::uint64_t came = delivered - (before == oldest.delivered.end() ? 0 : before->second);
    line += (line.empty() ? "" : ", ") + name;
    line += came > 0 && seconds > 0.0
                ? fmt::format(" {:.1f} Hz", static_cast<double>(came) / seconds)
                : " absent";
  }
  return line;
}

bool nothing_came(const Health& health) {
  return std::all_of(health.sensors.begin(), health.sensors.end(),
                     [](const SensorHealth& sensor) { return sensor.delivered == 0; });
}

}  // namespace maploop::tools
