// Which images belong together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace maploop::calibrate {

struct ImagePair {
  std::string name;  // what left and right have in common
  std::filesystem::path left, right;
};

// What cannot be used, and why.
struct Unusable {
  std::string name;
  std::string reason;
};

struct ImagePairs {
  std::vector<ImagePair> pairs;  // by name; numbers in the order of their values
  std::vector<Unusable> unpaired;
};

// `images` is one of
//   one folder with two folders of images, left and right (or cam0 and cam1, or image_00 and
//   image_01, each also with its images in a folder data): files of the same name are a pair
//   one folder with files left* and right*: the rest of the name says which are a pair
//   two patterns with one * each in the file's name, left and right: what the * stands for does
// Images are PNG or JPEG by the ends of their names. Throws std::runtime_error that
// says what was looked for where there is no image, or no pair, at all.
ImagePairs list_pairs(const std::vector<std::string>& images);

}  // namespace maploop::calibrate
