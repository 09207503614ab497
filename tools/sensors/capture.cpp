#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sensors/replay/files.h"
#include "sensors/velodyne/capture_source.h"
#include "tools/command/json_output.h"
#include "tools/sensors/sensors.h"

namespace maploop::tools {
namespace {

struct Turns {
  std::size_t count = 0;
  std::size_t points = 0;
  double seconds = 0.0;  // sum
};

void write_scan(const std::filesystem::path& folder, const LidarScan& scan, std::size_t number) {
  const auto file = folder / sensors::numbered_file(number, ".bin");
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(scan.points.data()),
            static_cast<std::streamsize>(scan.points.size() * sizeof(LidarPoint)));
  if (!out.flush()) throw std::runtime_error("cannot write '" + file.string() + "'");
}

void row(const char* key, const std::string& value) {
  fmt::print("  {:12} {}\n", key, value);
}

void print(const sensors::VelodyneCapture& capture, const Turns& turns) {
  const auto& decoder = capture.decoder();
  const auto& counts = decoder.counts();
  fmt::print("{}\n", to_string(capture.model()));
  row("packets", fmt::format("{} of data, {} of position, {} others", counts.data, counts.positions,
                             capture.others()));
  row("time",
      fmt::format("{} to {}, {:.3f} s", format_time(capture.first()), format_time(capture.last()),
                  to_seconds(capture.last() - capture.first())));
  row("lost", fmt::format("{}, late {}", counts.lost, counts.late));
  row("points", fmt::format("{}", decoder.points()));
  const std::string mean =
      turns.count == 0 ? ""
                       : fmt::format(", {} points and {:.3f} ms each", turns.points / turns.count,
                                     1e3 * turns.seconds / static_cast<double>(turns.count));
  row("turns",
      fmt::format("{} from rear to rear{}; broken {}", turns.count, mean, decoder.turns().broken));
  row("clock", decoder.clock().has_device_time()
                   ? fmt::format("the scanner's own, shifted to the capturing host's; jumps {}",
                                 decoder.clock().jumps())
                   : "the scanner's packets carry no time: stamped by their arrival");
  if (const auto offset = decoder.clock().gps_offset()) {
    row("GPS", fmt::format("UTC of its receiver is {:.6f} s ahead of the host's clock",
                           to_seconds(*offset)));
  }
  for (std::size_t i = 0; i < counts.refused.size(); ++i) {
    if (counts.refused[i] == 0) continue;
    row("refused",
        fmt::format("{}: {}", counts.refused[i], to_string(static_cast<sensors::PacketFault>(i))));
  }
  for (const auto& finding : capture.report().refusals) row("refused", finding.reason);
}

nlohmann::json to_json(const sensors::VelodyneCapture& capture, const Turns& turns) {
  const auto& decoder = capture.decoder();
  nlohmann::json json{{"model", to_string(capture.model())},
                      {"data_packets", decoder.counts().data},
                      {"position_packets", decoder.counts().positions},
                      {"lost", decoder.counts().lost},
                      {"late", decoder.counts().late},
                      {"points", decoder.points()},
                      {"turns", turns.count},
                      {"broken_turns", decoder.turns().broken},
                      {"seconds", to_seconds(capture.last() - capture.first())},
                      {"device_time", decoder.clock().has_device_time()}};
  if (const auto offset = decoder.clock().gps_offset()) json["gps_offset_s"] = to_seconds(*offset);
  return json;
}

}  // namespace

int show_capture(const CaptureOptions& options) {
  sensors::VelodyneCapture capture(options.file,
                                   {sensors::velodyne_model(options.model), options.calibration});
  if (!options.scans.empty()) std::filesystem::create_directories(options.scans);
  Turns turns;
  for (LidarScan scan; capture.next(scan);) {
    if (!options.scans.empty()) write_scan(options.scans, scan, turns.count);
    ++turns.count;
    turns.points += scan.points.size();
    turns.seconds += to_seconds(scan.end - scan.start);
  }
  print(capture, turns);
  if (!options.json.empty()) write_json_file(options.json, to_json(capture, turns));
  return 0;
}

}  // namespace maploop::tools
