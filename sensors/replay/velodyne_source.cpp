#include "sensors/replay/velodyne_source.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

static_assert(sizeof(LidarPoint) == 16 && std::endian::native == std::endian::little,
              "a scan file is copied as it is");

class VelodyneSource final : public Source<LidarScan> {
 public:
  VelodyneSource(VelodyneFolder folder, Duration max_turn, Time passed)
      : folder_(std::move(folder)), passed_(passed) {
    judge_stamps(max_turn);
    unstamped_ = files_without_stamp(folder_.data, verdicts_.size());
  }

  bool next(LidarScan& scan) override {
    while (index_ < verdicts_.size()) {
      const std::size_t i = index_++;
      if (verdicts_[i]) {
        report_.refuse(*verdicts_[i]);
        continue;
      }
      if (folder_.end.stamps[i] > passed_ && !read(i, scan.points)) continue;
      scan.stamp = folder_.middle.stamps[i];
      scan.start = folder_.start.stamps[i];
      scan.end = folder_.end.stamps[i];
      scan.available = scan.end;
      scan.sequence = i;
      ++report_.delivered;
      return true;
    }
    for (Finding& finding : unstamped_) report_.refuse(std::move(finding));
    unstamped_.clear();
    return false;
  }

  const SourceReport& report() const override { return report_; }

 private:
  void judge_stamps(Duration max_turn) {
    const VelodyneFolder& f = folder_;
    const std::size_t frames = std::max({f.start.size(), f.middle.size(), f.end.size()});
    for (std::size_t i = 0; i < frames; ++i) {
      auto found = verdict(f.middle, i);
      if (!found) found = verdict(f.start, i);
      if (!found) found = verdict(f.end, i);
      if (!found) {
        const Time start = f.start.stamps[i], middle = f.middle.stamps[i], end = f.end.stamps[i];
        if (!(start < middle && middle < end && end - start <= max_turn)) {
          found = Finding{f.middle.file.string(), i + 1,
                          "start, middle and end are not the stamps of one turn: from middle to "
                          "start " +
                              std::to_string(to_seconds(start - middle)) + " s, to end " +
                              std::to_string(to_seconds(end - middle)) + " s"};
        }
      }
      verdicts_.push_back(std::move(found));
    }
    for (const Timestamps* timestamps : {&f.middle, &f.end}) {
      std::vector<Time> stamps = timestamps->stamps;
      stamps.resize(frames);
      refuse_out_of_order(stamps, timestamps->file, verdicts_);
    }
  }

  bool read(std::size_t i, std::vector<LidarPoint>& points) {
    // A turn of the HDL-64E has 130 000 points; this is eight times as many.
    constexpr std::size_t largest_file = std::size_t{16} << 20;
    const std::filesystem::path file = folder_.data / numbered_file(i, ".bin");
    try {
      read_file(file, largest_file, bytes_);
      const std::size_t dropped = parse_velodyne_points(bytes_, points);
      if (dropped > 0) {
        report_.flaw({file.string(), 0,
                      std::to_string(dropped) + " of " + std::to_string(points.size() + dropped) +
                          " points are not finite and were dropped"});
      }
      return true;
    } catch (const std::exception& error) {
      report_.refuse({file.string(), 0, error.what()});
      return false;
    }
  }

  VelodyneFolder folder_;
  Time passed_;
  Verdicts verdicts_;
  std::vector<Finding> unstamped_;
  std::size_t index_ = 0;
  std::vector<char> bytes_;
  SourceReport report_;
};

}  // namespace

std::size_t parse_velodyne_points(const std::vector<char>& bytes, std::vector<LidarPoint>& points) {
  if (bytes.empty()) throw std::runtime_error("the scan is empty");
  if (bytes.size() % sizeof(LidarPoint) != 0) {
    throw std::runtime_error("the scan is cut: " + std::to_string(bytes.size()) +
                             " bytes are no multiple of " + std::to_string(sizeof(LidarPoint)));
  }
  points.resize(bytes.size() / sizeof(LidarPoint));
  std::memcpy(points.data(), bytes.data(), bytes.size());
  const std::size_t dropped = std::erase_if(points, [](const LidarPoint& p) {
    return !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
             std::isfinite(p.reflectance));
  });
  if (points.empty()) throw std::runtime_error("the scan has no finite point");
  return dropped;
}

std::unique_ptr<Source<LidarScan>> make_velodyne_source(VelodyneFolder folder, Duration max_turn,
                                                        Time passed) {
  return std::make_unique<VelodyneSource>(std::move(folder), max_turn, passed);
}

}  // namespace maploop::sensors
