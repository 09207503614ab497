// The files of a KITTI drive or sequence, by the first byte.
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "msgs/input_limits.h"
#include "sensors/folder/number_table.h"
#include "sensors/replay/kitti_calibration.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/packed_scan.h"
#include "sensors/replay/pose_odometry.h"
#include "sensors/replay/timestamps.h"
#include "sensors/replay/velodyne_source.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

namespace {

void read_timestamps(std::string_view text) {
  Timestamps t = parse_timestamps(text, "input");
  refuse_out_of_order(t.stamps, t.file, t.verdicts);
  const Time* last = nullptr;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.verdicts[i]) continue;
    fuzz::require(last == nullptr ||
                  (*last < t.stamps[i] &&
                   input_limits::within(input_limits::longest_gap, *last, t.stamps[i])));
    last = &t.stamps[i];
  }
}

// Three texts behind each other, cut at zero bytes.
void read_calibration(std::string_view text) {
  const auto next = [&text] {
    const std::string_view part = text.substr(0, text.find('\0'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return part;
  };
  KittiCalibrationText all;
  all.cam_to_cam = next();
  all.velo_to_cam = next();
  all.imu_to_velo = next();
  try {
    (void)parse_kitti_rig(all.cam_to_cam, "input");
  } catch (const std::runtime_error&) {
  }
  (void)parse_kitti_calibration(all);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto kind = input.byte() % 7U;
  const auto bytes = input.rest();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::vector<char> content(text.begin(), text.end());
  std::vector<LidarPoint> points;
  RangeImage image;
  const fuzz::MemoryFile file(bytes.data(), bytes.size());
  try {
    switch (kind) {
      case 0:
        read_timestamps(text);
        break;
      case 1:
        (void)parse_oxts_row(text);
        break;
      case 2:
        read_calibration(text);
        break;
      case 3:
        (void)NumberTable(file.path());
        break;
      case 4:
        (void)read_camera_poses(file.path());
        break;
      case 5:
        (void)parse_velodyne_points(content, points);
        break;
      default:
        unpack_scan(content, image, points);
        break;
    }
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
