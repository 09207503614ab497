// Finds out which images are pairs.
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "tools/calibrate/views.h"

namespace maploop::calibrate {
namespace {

namespace fs = std::filesystem;

// Sorts "view9" before "view10".
struct ByNumber {
  bool operator()(const std::string& a, const std::string& b) const {
    return std::pair(digits(a), a) < std::pair(digits(b), b);
  }
  // Returns the digits of the text without leading zeros, preceded by their count.
  static std::pair<std::size_t, std::string> digits(const std::string& text) {
    std::string found;
    for (const char c : text)
      if (std::isdigit(static_cast<unsigned char>(c)) != 0 && (c != '0' || !found.empty()))
        found += c;
    return {found.size(), found};
  }
};

using Images = std::map<std::string, fs::path, ByNumber>;  // by the shared part of the name

bool is_image(const fs::path& file) {
  std::string end = file.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".png" || end == ".jpg" || end == ".jpeg";
}

// Returns the images of a folder whose names begin with `begin` and end with `end`, by the text
// between.
Images images_in(const fs::path& folder, const std::string& begin, const std::string& end) {
  Images found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < begin.size() + end.size() || !name.starts_with(begin) ||
        !name.ends_with(end) || !is_image(entry.path()))
      continue;
    found[name.substr(begin.size(), name.size() - begin.size() - end.size())] = entry.path();
  }
  return found;
}

Images matching(const std::string& pattern) {
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  const std::size_t star = name.find('*');
  if (star == std::string::npos || name.find('*', star + 1) != std::string::npos ||
      path.parent_path().string().find('*') != std::string::npos) {
    throw std::runtime_error("'" + pattern +
                             "' is no pattern with one * in the file's name, such as "
                             "'images/left*.png' (in quotes, so that the shell leaves it alone)");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  Images found = images_in(folder, name.substr(0, star), name.substr(star + 1));
  if (found.empty()) throw std::runtime_error("no image fits '" + pattern + "'");
  return found;
}

ImagePairs pair_up(const Images& left, const Images& right) {
  ImagePairs result;
  for (const auto& [name, file] : left) {
    if (const auto other = right.find(name); other != right.end()) {
      result.pairs.push_back({fs::path(name).stem().string(), file, other->second});
    } else {
      result.unpaired.push_back({file.string(), "it has no right image"});
    }
  }
  for (const auto& [name, file] : right)
    if (!left.contains(name)) result.unpaired.push_back({file.string(), "it has no left image"});
  if (result.pairs.empty()) {
    throw std::runtime_error("no left image has a right one of the same name or number: " +
                             left.begin()->second.string() + " and " +
                             right.begin()->second.string() + ", for instance");
  }
  return result;
}

std::optional<ImagePairs> in_two_folders(const fs::path& folder) {
  constexpr std::array<std::pair<const char*, const char*>, 3> names = {
      {{"left", "right"}, {"cam0", "cam1"}, {"image_00", "image_01"}}};
  for (const auto& [left, right] : names) {
    if (!fs::is_directory(folder / left) && !fs::is_directory(folder / right)) continue;
    std::array<Images, 2> images;
    for (std::size_t i = 0; i < 2; ++i) {
      const fs::path side = folder / (i == 0 ? left : right);
      images[i] = images_in(fs::is_directory(side / "data") ? side / "data" : side, "", "");
      if (images[i].empty())
        throw std::runtime_error("no images in '" + side.string() + "', where the " +
                                 (i == 0 ? "left" : "right") + " ones should be");
    }
    return pair_up(images[0], images[1]);
  }
  return std::nullopt;
}

}  // namespace

ImagePairs list_pairs(const std::vector<std::string>& images) {
  if (images.size() == 2) return pair_up(matching(images[0]), matching(images[1]));
  if (images.size() != 1) {
    throw std::runtime_error(
        "name one folder, or two patterns in quotes ('left*.png' 'right*.png')"
        "; the shell has made " +
        std::to_string(images.size()) + " names of what was given");
  }
  const fs::path folder(images[0]);
  if (!fs::is_directory(folder))
    throw std::runtime_error("'" + images[0] +
                             "' is not a folder; name one, or two patterns in quotes "
                             "('left*.png' 'right*.png')");
  if (auto pairs = in_two_folders(folder)) return *pairs;
  const Images left = images_in(folder, "left", ""), right = images_in(folder, "right", "");
  if (left.empty() || right.empty()) {
    throw std::runtime_error("no pairs of images in '" + images[0] +
                             "': it has neither folders left and right (or cam0 and cam1, "
                             "image_00 and image_01) nor files left* and right*");
  }
  return pair_up(left, right);
}

}  // namespace maploop::calibrate
