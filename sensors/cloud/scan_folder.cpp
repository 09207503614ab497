#include "sensors/cloud/scan_folder.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/bag/cloud_scans.h"
#include "sensors/cloud/cloud_file.h"
#include "sensors/cloud/time_unit.h"
#include "sensors/folder/stamps.h"
#include "sensors/replay/velodyne_source.h"

namespace maploop::sensors {
namespace {

using std::filesystem::path;

// Returns the extension, without .gz.
path kind_of(const path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).extension();
}

std::vector<path> scans_in(const path& folder) {
  std::vector<path> files;
  for (const std::string& name : files_of_kind(folder, {".pcd", ".ply", ".bin"}))
    files.push_back(folder / name);
  return files;
}

// Returns the times in seconds after their middle.
std::vector<float> from_middle(const std::vector<double>& times) {
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  if (times.empty() || *first == *last) return {};
  const double middle = 0.5 * (*first + *last);
  const auto unit = time_unit(*last - *first);
  if (!unit) {
    throw std::runtime_error("the times of its points span " + std::to_string(*last - *first) +
                             ", which is no scan of 0.5 to 500 ms in s, ms, us or ns");
  }
  std::vector<float> seconds;
  seconds.reserve(times.size());
  for (const double time : times) seconds.push_back(static_cast<float>((time - middle) * *unit));
  return seconds;
}

// Times from the middle are as far before it as after it.
Duration half_of(const std::vector<float>& times) {
  return from_seconds(static_cast<double>(*std::ranges::max_element(times)));
}

}  // namespace

bool ScanFolder::is(const path& folder) {
  return !scans_in(folder).empty();
}

ScanFolder::ScanFolder(const path& folder, path stamps) : files_(scans_in(folder)) {
  const std::string scans = "'" + folder.string() + "' has " + std::to_string(files_.size()) +
                            " scans (.pcd, .ply, .bin)";
  if (files_.empty() || files_.size() > input_limits::frames)
    throw std::runtime_error(scans + " in place of 1 to " + std::to_string(input_limits::frames));
  find_stamps(folder, std::move(stamps));
}

void ScanFolder::find_stamps(const path& folder, path file) {
  constexpr Duration turn = std::chrono::milliseconds(100);
  if (file.empty()) file = times_file(folder).value_or(path());
  if (file.empty()) {
    const auto above = times_file(std::filesystem::absolute(folder).parent_path());
    if (above && read_times(*above).size() == files_.size()) file = *above;
  }
  if (!file.empty()) stamps_ = read_times(file);
  stamped_ = !file.empty();
  if (!stamped_) {
    std::vector<std::string> names;
    for (const path& scan : files_) names.push_back(scan.filename().string());
    if (auto stamps = stamps_in_names(names)) {
      stamps_ = std::move(*stamps);
      stamped_ = true;
    }
  }
  for (std::size_t i = 0; !stamped_ && i < files_.size(); ++i)
    stamps_.emplace_back(turn * static_cast<std::int64_t>(i));
  if (stamps_.size() != files_.size()) {
    throw std::runtime_error("'" + folder.string() + "' has " + std::to_string(files_.size()) +
                             " scans (.pcd, .ply, .bin), but " + file.string() + " has " +
                             std::to_string(stamps_.size()) + " stamps: each scan needs a line");
  }
}

bool ScanFolder::next(LidarScan& scan) {
  while (next_ < files_.size()) {
    const std::size_t i = next_++;
    try {
      scan.points.clear();
      scan.times.clear();
      if (stamps_[i] > passed_) read(files_[i], scan);
    } catch (const FileError& error) {
      report_.refuse({files_[i].string(), 0, error.reason()});
      continue;
    } catch (const std::exception& error) {
      report_.refuse({files_[i].string(), 0, error.what()});
      continue;
    }
    scan.stamp = scan.available = stamps_[i];
    const auto half = scan.times.empty() ? Duration(1) : half_of(scan.times);
    scan.start = stamps_[i] - half;
    scan.end = stamps_[i] + half;
    scan.sequence = i;
    ++report_.delivered;
    return true;
  }
  return false;
}

void ScanFolder::read(const path& file, LidarScan& scan) {
  if (kind_of(file) == ".bin") {
    const std::string content = maploop::read_text(file, input_limits::cloud);
    parse_velodyne_points({content.begin(), content.end()}, scan.points);
    return;
  }
  Cloud cloud = read_cloud(file);
  scan.times = from_middle(cloud.times);
  timed_ = timed_ || !scan.times.empty();
  scan.points = std::move(cloud.points);
}

std::string ScanFolder::assumption() const {
  return stamped_ ? "" : "Scans are taken to be 0.1 s apart: no file has their stamps.";
}

std::string ScanFolder::remarks() const {
  std::string text = timed_ ? "Points are corrected for the motion by the time of each.\n"
                            : "Points are not corrected for the motion during a scan, because they "
                              "have no field of times.\n";
  if (!stamped_) text += assumption() + '\n';
  for (const Finding& refused : report_.refusals)
    text += refused.file + ": left out: " + refused.reason + '\n';
  return text;
}

namespace {

class ScanSource final : public Source<LidarScan> {
 public:
  ScanSource(const path& folder, Duration max_turn, Time passed)
      : folder_(folder), scans_(max_turn) {
    folder_.pass_until(passed);
    const std::vector<Time>& stamps = folder_.stamps();
    if (stamps.size() < 2) return;
    const Duration mean =
        (stamps.back() - stamps.front()) / static_cast<std::int64_t>(stamps.size() - 1);
    if (mean <= max_turn) half_turn_ = mean / 2;
  }

  bool next(LidarScan& scan) override {
    while (true) {
      if (scans_.next(scan)) {
        if (scan.stamp > last_) break;
        continue;
      }
      if (!folder_.next(file_)) {
        if (!scans_.end()) return false;
        continue;
      }
      if (file_.times.empty()) {
        std::swap(scan, file_);
        scan.start = scan.stamp - half_turn_;
        scan.end = scan.available = scan.stamp + half_turn_;
        break;
      }
      timed_.points.swap(file_.points);
      timed_.times.clear();
      for (const float time : file_.times)
        timed_.times.push_back(file_.stamp + from_seconds(static_cast<double>(time)));
      scans_.add(timed_);
    }
    last_ = scan.stamp;
    return true;
  }
  const SourceReport& report() const override { return folder_.report(); }

 private:
  ScanFolder folder_;
  CloudScans scans_;
  LidarScan file_;
  TimedCloud timed_;
  Duration half_turn_ = std::chrono::milliseconds(50);
  Time last_ = Time::min();
};

}  // namespace

std::unique_ptr<Source<LidarScan>> make_scan_source(const path& folder, Duration max_turn,
                                                    Time passed) {
  return std::make_unique<ScanSource>(folder, max_turn, passed);
}

}  // namespace maploop::sensors
