#include "sensors/folder/image_lists.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "msgs/input_limits.h"
#include "sensors/cloud/scan_folder.h"
#include "sensors/folder/stamps.h"
#include "sensors/image/video_file.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

constexpr auto camera_names = std::to_array<std::pair<const char*, const char*>>(
    {{"left", "right"}, {"cam0", "cam1"}, {"image_0", "image_1"}, {"image_left", "image_right"}});

bool is_plain_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// Returns the folder with the files of a camera; nothing if there are none.
std::optional<fs::path> files_of_camera(const fs::path& camera) {
  for (const fs::path& folder : {camera / "data", camera})
    if (!files_of_kind(folder, {".png", ".jpg", ".jpeg"}).empty()) return folder;
  return std::nullopt;
}

// Returns the video of a camera; nothing if there is none.
std::optional<fs::path> video_of_camera(const fs::path& folder, std::string_view name) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (has_video_name(entry.path()) && entry.path().stem() == name) return entry.path();
  return std::nullopt;
}

bool has_camera(const fs::path& folder, const char* name) {
  return is_plain_file(folder / (std::string(name) + ".txt")) || files_of_camera(folder / name) ||
         video_of_camera(folder, name);
}

bool is_inside(const fs::path& name) {
  return !name.empty() && name.is_relative() && *name.lexically_normal().begin() != "..";
}

ImageFolder open_video(const fs::path& video, const fs::path& stamps) {
  ImageFolder images;
  images.data = video;
  Timestamps& t = images.timestamps;
  t.file = stamps;
  if (t.file.empty()) {
    throw std::runtime_error("the images of the video '" + video.string() +
                             "' have no stamps: write a line for each to '" +
                             fs::path(video).replace_extension(".txt").string() + "'");
  }
  t.stamps = read_times(t.file);
  t.verdicts.resize(t.stamps.size());
  for (std::size_t i = 0; i < t.size(); ++i) images.names.push_back(std::to_string(i));
  return images;
}

ImageFolder open_camera(const fs::path& folder, const char* name) {
  const fs::path list = folder / (std::string(name) + ".txt");
  const bool has_list = is_plain_file(list);
  if (const auto video = video_of_camera(folder, name)) {
    return open_video(*video, has_list ? list : times_file(folder).value_or(fs::path()));
  }
  if (has_list) return read_image_list(list);
  const fs::path camera = folder / name;
  ImageFolder images;
  images.data = *files_of_camera(camera);
  images.any_kind = true;
  if (is_plain_file(camera / "data.csv")) {
    images = read_image_list(camera / "data.csv");
    images.data = *files_of_camera(camera);
    return images;
  }
  images.names = files_of_kind(images.data, {".png", ".jpg", ".jpeg"});
  Timestamps& t = images.timestamps;
  t.file = times_file(camera).value_or(times_file(folder).value_or(fs::path()));
  if (!t.file.empty()) {
    t.stamps = read_times(t.file);
  } else if (auto stamps = stamps_in_names(images.names)) {
    t.file = images.data;
    t.stamps = std::move(*stamps);
  } else {
    throw std::runtime_error("the images of '" + camera.string() +
                             "' have no stamps: name the files by them (seconds with a point, or "
                             "nanoseconds), or write a line for each to '" +
                             (camera / "times.txt").string() + "'");
  }
  if (t.stamps.size() != images.names.size()) {
    throw std::runtime_error("'" + images.data.string() + "' has " +
                             std::to_string(images.names.size()) + " images, but '" +
                             t.file.string() + "' has " + std::to_string(t.stamps.size()) +
                             " stamps: each image needs a line");
  }
  t.verdicts.resize(t.stamps.size());
  return images;
}

// Returns the index of each stamp without a verdict, by its stamp.
std::multimap<Time, std::size_t> by_stamp(const Timestamps& t) {
  std::multimap<Time, std::size_t> found;
  for (std::size_t i = 0; i < t.size(); ++i)
    if (!t.verdicts[i]) found.emplace(t.stamps[i], i);
  return found;
}

// Takes the entry whose stamp is nearest, within `most`.
std::optional<std::size_t> take_nearest(std::multimap<Time, std::size_t>& entries, Time stamp,
                                        Duration most) {
  auto best = entries.end();
  const auto after = entries.lower_bound(stamp);
  for (auto entry : {after == entries.begin() ? entries.end() : std::prev(after), after}) {
    if (entry == entries.end() || !input_limits::within(most, entry->first, stamp)) continue;
    if (best == entries.end() ||
        std::chrono::abs(entry->first - stamp) < std::chrono::abs(best->first - stamp))
      best = entry;
  }
  if (best == entries.end()) return std::nullopt;
  const std::size_t i = best->second;
  entries.erase(best);
  return i;
}

}  // namespace

ImageFolder parse_image_list(std::string_view text, const fs::path& file) {
  ImageFolder images;
  images.data = file.parent_path();
  images.any_kind = true;
  Timestamps& t = images.timestamps;
  t.file = file;
  bool any = false;
  std::size_t number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++number;
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t end = std::min(line.find_first_of(", \t"), line.size());
    const std::size_t name = std::min(line.find_first_not_of(", \t", end), line.size());
    const auto stamp = stamp_of(line.substr(0, end));
    const fs::path image(line.substr(name));
    t.stamps.push_back(stamp.value_or(Time{}));
    images.names.push_back(image.string());
    t.verdicts.emplace_back();
    if (!stamp || !is_inside(image)) {
      t.verdicts.back() =
          Finding{file.string(), number,
                  "is not a stamp and the name of a file in the list's folder: " + quoted(line)};
    }
    any = any || !t.verdicts.back();
    if (t.size() > input_limits::frames) {
      throw std::runtime_error("'" + file.string() + "' has more than " +
                               std::to_string(input_limits::frames) + " images; cut the recording");
    }
  }
  if (!any) {
    throw std::runtime_error("'" + file.string() +
                             "' has no line with a stamp and an image's name");
  }
  return images;
}

ImageFolder read_image_list(const fs::path& file) {
  return parse_image_list(read_text(file), file);
}

ImagePair paired(const ImageFolder& left, const ImageFolder& right, Duration max_skew) {
  ImagePair pair{left, {}};
  ImageFolder& l = pair.left;
  ImageFolder& r = pair.right;
  r.data = right.data;
  r.any_kind = right.any_kind;
  r.timestamps.file = right.timestamps.file;
  r.names.resize(left.names.size());
  r.timestamps.stamps = left.timestamps.stamps;
  r.timestamps.verdicts.resize(left.names.size());
  auto partners = by_stamp(right.timestamps);
  bool any = false;
  for (std::size_t i = 0; i < l.names.size(); ++i) {
    auto& verdict = l.timestamps.verdicts[i];
    if (verdict) continue;
    const auto found = take_nearest(partners, l.timestamps.stamps[i], max_skew);
    if (!found) {
      verdict = Finding{(l.data / l.names[i]).string(), 0,
                        "has no image of the right camera within max_pair_skew"};
      continue;
    }
    any = true;
    r.names[i] = right.names[*found];
    r.timestamps.stamps[i] = right.timestamps.stamps[*found];
  }
  if (!any) {
    throw std::runtime_error("no image of '" + left.timestamps.file.string() + "' has one of '" +
                             right.timestamps.file.string() +
                             "' at its time ([replay] max_pair_skew): a pair of cameras is needed");
  }
  for (const auto& verdict : right.timestamps.verdicts)
    if (verdict) r.unpaired.push_back(*verdict);
  for (const auto& [stamp, i] : partners) {
    r.unpaired.push_back({(right.data / right.names[i]).string(), 0,
                          "has no image of the left camera within max_pair_skew"});
  }
  return pair;
}

std::optional<ImagePair> find_images(const fs::path& folder, Duration max_skew) {
  for (const auto& [left, right] : camera_names) {
    const bool has_left = has_camera(folder, left), has_right = has_camera(folder, right);
    if (has_left && has_right) {
      const ImageFolder of_left = open_camera(folder, left);
      return paired(of_left, open_camera(folder, right), max_skew);
    }
    if (has_left || has_right) {
      throw std::runtime_error("'" + folder.string() + "' has the images of one camera, '" +
                               (has_left ? left : right) + "', and none of '" +
                               (has_left ? right : left) +
                               "': a pair of cameras is needed, one camera alone is not supported");
    }
  }
  if (is_plain_file(folder / "rgb.txt")) {
    throw std::runtime_error("'" + folder.string() +
                             "' has the images of one camera, rgb.txt: a pair of cameras is needed "
                             "(left.txt and right.txt); one camera alone, also with depth images, "
                             "is not supported");
  }
  return std::nullopt;
}

bool has_images(const fs::path& folder) {
  return is_plain_file(folder / "rgb.txt") ||
         std::ranges::any_of(camera_names, [&](const auto& names) {
           return has_camera(folder, names.first) || has_camera(folder, names.second);
         });
}

std::optional<fs::path> find_scans(const fs::path& folder) {
  for (const char* name : {"velodyne", "lidar", "scans", "clouds"}) {
    for (const fs::path& scans : {folder / name, folder / name / "data"})
      if (ScanFolder::is(scans)) return scans;
  }
  return std::nullopt;
}

}  // namespace maploop::sensors
