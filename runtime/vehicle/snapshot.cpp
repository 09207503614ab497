#include "runtime/vehicle/snapshot.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "runtime/vehicle/config_fields.h"

namespace maploop::vehicle {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{256} << 20;

// What decides which samples the recording gives. (Where it runs and how fast decides nothing.)
constexpr std::array<std::string_view, 4> deciding_tables{"replay", "gnss", "wheel", "imu"};

template <class Archive>
void archive_same_config(Archive& ar, const VehicleConfig& config) {
  std::string_view table;
  visit(
      config, [&](const char* name) { table = name; },
      [&](const char* key, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
          if (std::find(deciding_tables.begin(), deciding_tables.end(), table) ==
              deciding_tables.end()) {
            return;
          }
          const std::string name = "[" + std::string(table) + "] " + key;
          archive_same_number(ar, name, value);
        }
      });
}

template <class Archive, class S>
void describe(Archive& ar, S& snapshot, const VehicleConfig& config) {
  ar.section("vehicle snapshot", 3);
  archive_same_config(ar, config);
  ar(snapshot.at, snapshot.first, snapshot.stereo, snapshot.lidar, snapshot.ppp, snapshot.fusion,
     snapshot.mapmatch);
}

}  // namespace

void write_snapshot(const std::filesystem::path& file, const Snapshot& snapshot,
                    const VehicleConfig& config) {
  ArchiveWriter writer;
  describe(writer, snapshot, config);
  const Bytes sealed = seal(writer.content());
  const std::filesystem::path part = file.string() + ".part";
  errno = 0;
  std::ofstream stream(part, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(sealed.data()),
               static_cast<std::streamsize>(sealed.size()));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(part, file, error);
  if (stream && !error) return;
  const std::string why = error ? error.message() : std::strerror(errno);
  std::filesystem::remove(part, error);
  throw std::runtime_error("cannot write the snapshot '" + file.string() + "': " + why +
                           "; does its folder exist, and has the disk room?");
}

Snapshot read_snapshot(const std::filesystem::path& file, const VehicleConfig& config) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("cannot resume from '" + file.string() + "': " + why);
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) refuse("there is no such file");
  if (std::filesystem::file_size(file, error) > largest_file) refuse("too large for a snapshot");
  std::ifstream stream(file, std::ios::binary);
  const Bytes sealed{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) refuse("it cannot be read");
  Snapshot snapshot;
  try {
    ArchiveReader reader(unseal(sealed));
    describe(reader, snapshot, config);
    reader.finish();
  } catch (const ArchiveError& e) {
    refuse(e.what());
  }
  return snapshot;
}

}  // namespace maploop::vehicle
