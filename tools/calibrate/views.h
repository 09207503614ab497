// Finds the board in pairs of images.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/calibrate/board_adjustment.h"
#include "tools/calibrate/image_pairs.h"

namespace maploop::calibrate {

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
