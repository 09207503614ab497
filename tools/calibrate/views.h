// From pairs of images to views of the board.
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
  std::vector<ImagePair> pairs;    // of each view
  std::vector<Unusable> unusable;  // not readable, of another size than most, board not found
  std::string hint;                // where no view has a board: which board is seen instead
};

// `progress` is told how many pairs are done. Throws std::runtime_error where the left and the
// right images have different sizes, or none can be read.
FoundViews find_views(const Board& board, const std::vector<ImagePair>& pairs,
                      const std::function<void(std::size_t)>& progress);

}  // namespace maploop::calibrate
