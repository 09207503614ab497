#include "sensors/replay/velodyne_source.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "sensors/replay/frame_source.h"
#include "sensors/replay/packed_scan.h"

namespace maploop::sensors {
namespace {

static_assert(sizeof(LidarPoint) == 16 && std::endian::native == std::endian::little,
              "a scan file is copied as it is");

FrameList judge(const VelodyneFolder& folder, Duration max_turn) {
  FrameList frames;
  const std::size_t count =
      std::max({folder.start.size(), folder.middle.size(), folder.end.size()});
  for (std::size_t i = 0; i < count; ++i) {
    auto found = verdict(folder.middle, i);
    if (!found) found = verdict(folder.start, i);
    if (!found) found = verdict(folder.end, i);
    if (!found) {
      const Time start = folder.start.stamps[i], middle = folder.middle.stamps[i],
                 end = folder.end.stamps[i];
      if (!(start < middle && middle < end && end - start <= max_turn)) {
        found = Finding{folder.middle.file.string(), i + 1,
                        "start, middle and end are not the stamps of one turn: from middle to "
                        "start " +
                            std::to_string(to_seconds(start - middle)) + " s, to end " +
                            std::to_string(to_seconds(end - middle)) + " s"};
      }
    }
    frames.verdicts.push_back(std::move(found));
  }
  for (const Timestamps* timestamps : {&folder.middle, &folder.end}) {
    std::vector<Time> stamps = timestamps->stamps;
    stamps.resize(count);
    refuse_out_of_order(stamps, timestamps->file, frames.verdicts);
  }
  frames.available = folder.end.stamps;
  frames.available.resize(count);
  frames.unstamped = files_without_stamp(folder.data, count);
  return frames;
}

class VelodyneSource final : public FrameSource<LidarScan> {
 public:
  VelodyneSource(VelodyneFolder folder, Duration max_turn, Time passed)
      : FrameSource(judge(folder, max_turn), passed), folder_(std::move(folder)) {}

 private:
  bool read(std::size_t i, LidarScan& scan) override {
    // A turn of the HDL-64E has 130 000 points; this allows eight times as many.
    constexpr std::size_t largest_file = std::size_t{16} << 20;
    const std::filesystem::path packed = folder_.data / numbered_file(i, ".scan");
    std::error_code ignored;
    if (std::filesystem::exists(packed, ignored)) {
      return read_and_parse(packed, largest_file, [&](const std::vector<char>& bytes) {
        unpack_scan(bytes, image_, scan.points);
      });
    }
    const std::filesystem::path file = folder_.data / numbered_file(i, ".bin");
    return read_and_parse(file, largest_file, [&](const std::vector<char>& bytes) {
      const std::size_t dropped = parse_velodyne_points(bytes, scan.points);
      if (dropped == 0) return;
      report_.flaw({file.string(), 0,
                    std::to_string(dropped) + " of " +
                        std::to_string(scan.points.size() + dropped) +
                        " points are not finite and were dropped"});
    });
  }

  void set_stamps(std::size_t i, LidarScan& scan) const override {
    scan.times.clear();
    scan.stamp = folder_.middle.stamps[i];
    scan.start = folder_.start.stamps[i];
    scan.end = folder_.end.stamps[i];
  }

  VelodyneFolder folder_;
  RangeImage image_;
};

}  // namespace

std::size_t parse_velodyne_points(const std::vector<char>& bytes, std::vector<LidarPoint>& points) {
  if (bytes.empty()) throw std::runtime_error("the scan is empty");
  if (bytes.size() % sizeof(LidarPoint) != 0) {
    throw std::runtime_error("the scan is incomplete: " + std::to_string(bytes.size()) +
                             " bytes are not a multiple of " + std::to_string(sizeof(LidarPoint)));
  }
  const std::size_t count = bytes.size() / sizeof(LidarPoint);
  if (points.capacity() < count) {  // resize() alone would double it for a few points more
    points.clear();
    points.reserve(count + count / 8);
  }
  points.resize(count);
  std::memcpy(points.data(), bytes.data(), bytes.size());
  const std::size_t dropped = std::erase_if(points, [](const LidarPoint& p) {
    return !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
             std::isfinite(p.reflectance));
  });
  if (points.empty()) throw std::runtime_error("the scan has no finite points");
  return dropped;
}

std::unique_ptr<Source<LidarScan>> make_velodyne_source(VelodyneFolder folder, Duration max_turn,
                                                        Time passed) {
  return std::make_unique<VelodyneSource>(std::move(folder), max_turn, passed);
}

}  // namespace maploop::sensors
