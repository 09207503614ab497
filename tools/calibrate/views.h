// Finds out which images are pairs, and the board in them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

struct ImagePair {
  std::string name;  // the part of the name that left and right share
  std::filesystem::path left, right;
};

// An image that cannot be used, and the reason.
struct Unusable {
  std::string name;
  std::string reason;
};

struct ImagePairs {
  std::vector<ImagePair> pairs;  // in order of names; numbers in names are in numerical order
  std::vector<Unusable> unpaired;
};

// `images` is one of
//   - one folder with two folders of images, left and right (or cam0 and cam1, or image_00 and
//     image_01; each may have its images in a subfolder data): files of the same name are a pair;
//   - one folder with files left* and right*: files with the same rest of the name are a pair;
//   - two patterns with one * each in the file's name, left and right: files with the same text in
//     place of the * are a pair.
// Images are PNG or JPEG, recognized by the extensions of their names. Throws std::runtime_error
// that states what was searched for if there is no image, or no pair, at all.
ImagePairs list_pairs(const std::vector<std::string>& images);

struct FoundViews {
  int width = 0, height = 0;  // px, of every image
  std::vector<View> views;
  std::vector<ImagePair> pairs;    // one for each view
  std::vector<Unusable> unusable;  // unreadable, of an uncommon size, or board not found
  std::string hint;                // if no view has the board: which other board is visible
};

// `progress` is called with the number of pairs done. Throws std::runtime_error if the left and
// right images have different sizes, or no pair can be read.
FoundViews find_views(const Board& board, const std::vector<ImagePair>& pairs,
                      const std::function<void(std::size_t)>& progress);

}  // namespace maploop::calibrate
