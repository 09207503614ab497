// Clouds: .pcd and .ply. What is read can be written, and is then read as the same.
#include <cmath>
#include <stdexcept>

#include "sensors/cloud/cloud_file.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  sensors::Cloud cloud;
  try {
    cloud = sensors::parse_cloud(input.text());
  } catch (const std::runtime_error&) {
    return 0;
  }
  fuzz::require(!cloud.points.empty());
  fuzz::require(cloud.times.empty() || cloud.times.size() == cloud.points.size());
  sensors::CloudTable table{{"x", "y", "z", "intensity"}, {}};
  for (const LidarPoint& p : cloud.points)
    table.values.insert(table.values.end(), {p.x, p.y, p.z, p.reflectance});
  for (const char* file : {"a.pcd", "a.ply"}) {
    using enum sensors::CloudEncoding;
    for (const auto encoding : {ascii, binary, compressed}) {
      if (encoding == compressed && file == std::string("a.ply")) continue;
      const auto again = sensors::parse_cloud(sensors::encode_cloud(table, file, encoding));
      fuzz::require(again.points.size() == cloud.points.size());
      fuzz::require(again.points.back().z == cloud.points.back().z);
    }
  }
  return 0;
}
