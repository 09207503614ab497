#include "tools/calibrate/views.h"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "msgs/input_file.h"

namespace maploop::calibrate {
namespace {

using Size = std::pair<int, int>;

std::string shown(const Size& size) {
  return std::to_string(size.first) + " x " + std::to_string(size.second) + " pixels";
}

struct ReadPair {
  ImagePair files;
  GreyImage left, right;
};

Size size_of(const GreyImage& image) {
  return {image.width, image.height};
}

std::optional<ReadPair> read(const ImagePair& pair, std::vector<Unusable>& unusable) {
  ReadPair result{pair, {}, {}};
  for (const auto& [file, image] :
       {std::pair(&pair.left, &result.left), std::pair(&pair.right, &result.right)}) {
    try {
      *image = read_image(*file);
    } catch (const FileError& error) {
      unusable.push_back({file->string(), error.reason()});
      return std::nullopt;
    } catch (const std::runtime_error& error) {
      unusable.push_back({file->string(), error.what()});
      return std::nullopt;
    }
  }
  return result;
}

// Returns the most frequent size of the images on one side.
Size common_size(const std::vector<ReadPair>& pairs, GreyImage ReadPair::*side) {
  std::map<Size, int> counts;
  for (const ReadPair& pair : pairs) ++counts[size_of(pair.*side)];
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// Returns a hint for the case that no image shows the board: another board that is visible.
std::string other_board(const Board& board, const std::vector<ReadPair>& pairs) {
  constexpr std::size_t tries = 5;
  for (std::size_t i = 0; i < std::min(tries, pairs.size()); ++i) {
    const auto other = find_any_board(pairs[i].left);
    if (other && (other->columns != std::max(board.columns, board.rows) ||
                  other->rows != std::min(board.columns, board.rows))) {
      return "a board of " + std::to_string(other->columns) + "x" + std::to_string(other->rows) +
             " inner corners is seen in " + pairs[i].files.left.string() + ": is --board right?";
    }
  }
  return "are --board's numbers those of the inner corners (one less than squares), and is the "
         "whole board in the images, with a white margin?";
}

}  // namespace

FoundViews find_views(const Board& board, const std::vector<ImagePair>& pairs,
                      const std::function<void(std::size_t)>& progress) {
  FoundViews found;
  std::vector<ReadPair> images;
  for (const ImagePair& pair : pairs)
    if (auto both = read(pair, found.unusable)) images.push_back(std::move(*both));
  if (images.empty()) {
    throw std::runtime_error("no pair of images can be read; the first: " +
                             found.unusable.front().name + ": " + found.unusable.front().reason);
  }
  const Size size = common_size(images, &ReadPair::left);
  if (const Size right = common_size(images, &ReadPair::right); right != size) {
    throw std::runtime_error("the left images have " + shown(size) + ", the right ones " +
                             shown(right) + ": both must have the same size");
  }
  std::tie(found.width, found.height) = size;

  std::size_t done = 0;
  for (const ReadPair& pair : images) {
    progress(done++);
    std::array<std::optional<Corners>, 2> corners;
    bool usable = true;
    for (std::size_t side = 0; side < 2 && usable; ++side) {
      const GreyImage& image = side == 0 ? pair.left : pair.right;
      const std::string name = (side == 0 ? pair.files.left : pair.files.right).string();
      if (size_of(image) != size) {
        found.unusable.push_back(
            {name, "it has " + shown(size_of(image)) + ", most others " + shown(size)});
        usable = false;
      } else if (corners[side] = find_corners(image, board); !corners[side]) {
        found.unusable.push_back({name, "no board of " + std::to_string(board.columns) + "x" +
                                            std::to_string(board.rows) +
                                            " inner corners is found in it"});
        usable = false;
      }
    }
    if (!usable) continue;
    found.views.push_back(
        {pair.files.name, *corners[0], order_alike(*corners[1], *corners[0], board)});
    found.pairs.push_back(pair.files);
  }
  if (found.views.empty()) found.hint = other_board(board, images);
  return found;
}

}  // namespace maploop::calibrate
