#include "tools/doctor/memory_report.h"

#include <fmt/format.h>

#include <numeric>

namespace maploop::tools {
namespace {

double to_mb(std::size_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

}  // namespace

double MemoryReport::megabytes() const {
  return std::accumulate(parts.begin(), parts.end(), 0.0,
                         [](double sum, const auto& part) { return sum + to_mb(part.bytes()); });
}

MemoryReport memory_report(const vehicle::VehicleConfig& config) {
  const CameraDescription& camera = config.vehicle.camera;
  const bool known = camera.width > 0 && camera.height > 0;
  const auto pixels =
      known ? static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)
            : std::size_t{1242} * 375;
  MemoryReport report;
  report.sizes = {.pixels = pixels, .points = 131'072};
  report.parts = vehicle::memory_budget(report.sizes, config.scheduling);
  report.mapped_mb = config.memory.heap_mb;
  return report;
}

std::string to_text(const MemoryReport& report) {
  constexpr double shown = 0.5;  // MB
  std::string text = fmt::format(
      "memory that a vehicle with every sensor holds at most, without its road map and products\n"
      "(images of {} pixels, scans of {} points), in MB:\n",
      report.sizes.pixels, report.sizes.points);
  double others = 0.0;
  for (const vehicle::MemoryPart& part : report.parts) {
    if (to_mb(part.bytes()) < shown) {
      others += to_mb(part.bytes());
      continue;
    }
    const std::string slots =
        part.count > 1 ? fmt::format("{} x {:.3f}", part.count, to_mb(part.each)) : "";
    text += fmt::format("  {:<32}{:>14}{:>8.1f}\n", part.name, slots, to_mb(part.bytes()));
  }
  text += fmt::format("  {:<46}{:>8.1f}\n  {:<46}{:>8.1f}\n", "others", others, "all",
                      report.megabytes());
  return text +
         fmt::format("of it {} MB are mapped at the start ([memory] heap_mb)\n", report.mapped_mb);
}

nlohmann::json to_json(const MemoryReport& report) {
  nlohmann::json parts = nlohmann::json::array();
  for (const vehicle::MemoryPart& part : report.parts)
    parts.push_back({{"name", part.name}, {"count", part.count}, {"bytes", part.bytes()}});
  return {{"pixels", report.sizes.pixels},
          {"points", report.sizes.points},
          {"parts", std::move(parts)},
          {"megabytes", report.megabytes()}};
}

}  // namespace maploop::tools
