#include "tools/sensors/velodyne_capture_info.h"

#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sensors/replay/files.h"
#include "tools/command/json_output.h"

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

std::string fixed(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

void print(const sensors::VelodyneCapture& capture, const Turns& turns) {
  const auto& decoder = capture.decoder();
  const auto& counts = decoder.counts();
  const auto& cuts = decoder.turns();
  fmt::print("{}\n", to_string(capture.model()));
  row("packets", std::to_string(counts.data) + " of data, " + std::to_string(counts.positions) +
                     " of position, " + std::to_string(capture.others()) + " others");
  row("time", format_time(capture.first()) + " to " + format_time(capture.last()) + ", " +
                  fixed(to_seconds(capture.last() - capture.first()), 3) + " s");
  row("lost", std::to_string(counts.lost) + ", late " + std::to_string(counts.late));
  row("points", std::to_string(decoder.points()));
  const std::string mean =
      turns.count == 0
          ? ""
          : ", " + std::to_string(turns.points / turns.count) + " points and " +
                fixed(1e3 * turns.seconds / static_cast<double>(turns.count), 3) + " ms each";
  row("turns", std::to_string(turns.count) + " from rear to rear" + mean + "; broken " +
                   std::to_string(cuts.broken));
  if (!decoder.clock().has_device_time()) {
    row("clock", "the scanner's packets carry no time: stamped by their arrival");
  } else {
    row("clock", "the scanner's own, shifted to the capturing host's; jumps " +
                     std::to_string(decoder.clock().jumps()));
  }
  if (const auto offset = decoder.clock().gps_offset()) {
    row("GPS",
        "UTC of its receiver is " + fixed(to_seconds(*offset), 6) + " s ahead of the host's clock");
  }
  for (std::size_t i = 0; i < counts.refused.size(); ++i) {
    if (counts.refused[i] == 0) continue;
    row("refused", std::to_string(counts.refused[i]) + ": " +
                       std::string(to_string(static_cast<sensors::PacketFault>(i))));
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

int show_capture(const CaptureInfoOptions& options) {
  sensors::VelodyneCapture capture(options.file, options.capture);
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
