#include "runtime/vehicle/playback/snapshot.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/parameter_archive.h"
#include "msgs/whole_file.h"
#include "runtime/vehicle/config/config_tables.h"

namespace maploop::vehicle {
namespace {

// What decides which samples the recording gives. (Where it runs and how fast decides nothing.)
constexpr std::array<std::string_view, 5> deciding_tables{"replay", "gnss", "wheel", "imu",
                                                          "vehicle.imu"};

template <class Archive>
void archive_same_config(Archive& ar, const VehicleConfig& config) {
  each_part(config, [&](const auto& table, const auto& values) {
    const auto& deciding = deciding_tables;
    if (std::find(deciding.begin(), deciding.end(), table.name) != deciding.end()) {
      archive_same_parameters(ar, table, values);
    }
  });
}

template <class Archive, class S>
void describe(Archive& ar, S& snapshot, const VehicleConfig& config) {
  ar.section("vehicle snapshot", 5);
  archive_same_config(ar, config);
  ar(snapshot.at, snapshot.first, snapshot.parts);
}

}  // namespace

Bytes snapshot_bytes(const Snapshot& snapshot, const VehicleConfig& config) {
  return sealed_archive([&](auto& ar) { describe(ar, snapshot, config); });
}

void write_snapshot(const std::filesystem::path& file, const Snapshot& snapshot,
                    const VehicleConfig& config) {
  write_whole_file(file, snapshot_bytes(snapshot, config));
}

Snapshot read_snapshot(const std::filesystem::path& file, const VehicleConfig& config) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("cannot resume from '" + file.string() + "': " + why);
  };
  Snapshot snapshot;
  try {
    read_archive(file, input_limits::snapshot, [&](auto& ar) { describe(ar, snapshot, config); });
  } catch (const ArchiveError& e) {
    refuse(e.what());
  } catch (const FileError& e) {
    refuse(e.reason());
  }
  return snapshot;
}

}  // namespace maploop::vehicle
