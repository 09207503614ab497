#include "sensors/cloud/scan_folder.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "msgs/input_limits.h"
#include "sensors/cloud/cloud_file.h"
#include "sensors/cloud/time_unit.h"
#include "sensors/replay/files.h"
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
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const path kind = kind_of(entry->path());
    if (kind == ".pcd" || kind == ".ply" || kind == ".bin") files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end(), [](const path& a, const path& b) {
    return strverscmp(a.filename().c_str(), b.filename().c_str()) < 0;
  });
  return files;
}

std::vector<Time> read_stamps(const path& file) {
  const std::string text = read_text(file);
  std::vector<Time> stamps;
  for (const std::string_view line : split_lines(text)) {
    const std::string place = file.string() + ':' + std::to_string(stamps.size() + 1) + ": ";
    try {
      stamps.push_back(line.find(':') != std::string_view::npos
                           ? parse_time(line)
                           : Time(checked_seconds(parse_numbers(line).at(0))));
    } catch (const std::logic_error&) {
      throw std::runtime_error(place + quoted(line) +
                               " is neither seconds nor YYYY-MM-DD hh:mm:ss.fraction");
    }
    if (stamps.size() > 1 && stamps.back() <= stamps[stamps.size() - 2])
      throw std::runtime_error(place + "the stamps do not increase");
  }
  return stamps;
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

}  // namespace

bool ScanFolder::is(const path& folder) {
  return !scans_in(folder).empty();
}

ScanFolder::ScanFolder(const path& folder, path stamps) : files_(scans_in(folder)) {
  constexpr Duration turn = std::chrono::milliseconds(100);
  const std::string scans = "'" + folder.string() + "' has " + std::to_string(files_.size()) +
                            " scans (.pcd, .ply, .bin)";
  if (files_.empty() || files_.size() > input_limits::frames)
    throw std::runtime_error(scans + " in place of 1 to " + std::to_string(input_limits::frames));
  std::error_code ignored;
  if (stamps.empty() && std::filesystem::exists(folder / "timestamps.txt", ignored))
    stamps = folder / "timestamps.txt";
  stamped_ = !stamps.empty();
  if (stamped_) stamps_ = read_stamps(stamps);
  for (std::size_t i = 0; !stamped_ && i < files_.size(); ++i)
    stamps_.emplace_back(turn * static_cast<std::int64_t>(i));
  if (stamps_.size() != files_.size()) {
    throw std::runtime_error(scans + ", but " + stamps.string() + " has " +
                             std::to_string(stamps_.size()) + " stamps: each scan needs a line");
  }
}

bool ScanFolder::next(LidarScan& scan) {
  while (next_ < files_.size()) {
    const std::size_t i = next_++;
    try {
      read(files_[i], scan.points);
    } catch (const FileError& error) {
      report_.refuse({files_[i].string(), 0, error.reason()});
      continue;
    } catch (const std::exception& error) {
      report_.refuse({files_[i].string(), 0, error.what()});
      continue;
    }
    scan.stamp = scan.available = stamps_[i];
    scan.start = stamps_[i] - Duration(1);
    scan.end = stamps_[i] + Duration(1);
    scan.sequence = i;
    ++report_.delivered;
    return true;
  }
  return false;
}

void ScanFolder::read(const path& file, std::vector<LidarPoint>& points) {
  times_.clear();
  if (kind_of(file) == ".bin") {
    const std::string content = maploop::read_text(file, input_limits::cloud);
    parse_velodyne_points({content.begin(), content.end()}, points);
    return;
  }
  Cloud cloud = read_cloud(file);
  times_ = from_middle(cloud.times);
  timed_ = timed_ || !times_.empty();
  points = std::move(cloud.points);
}

std::string ScanFolder::remarks() const {
  std::string text = timed_ ? "Points are corrected for the motion by the time of each.\n"
                            : "Points are not corrected for the motion during a scan, because they "
                              "have no field of times.\n";
  if (!stamped_) text += "Scans are taken to be 0.1 s apart: no file has their stamps.\n";
  for (const Finding& refused : report_.refusals)
    text += refused.file + ": left out: " + refused.reason + '\n';
  return text;
}

}  // namespace maploop::sensors
