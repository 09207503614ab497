// Finds out which images are pairs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace maploop::calibrate
