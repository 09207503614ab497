// This file checks the size of an image for all readers and writers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "msgs/input_limits.h"

namespace maploop::sensors {

inline std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

// Throws std::runtime_error if the image has no pixel, or more than input_limits::pixels.
inline void require_size(std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) throw std::runtime_error("the image is incomplete: it has no size");
  if (width > input_limits::pixels / height) {
    throw std::runtime_error("the image has " + size_text(width, height) + ", more than " +
                             std::to_string(input_limits::pixels));
  }
}

// Returns true if `bytes` are the grey pixels of an image of that size, and false if they are its
// red, green and blue ones. Throws std::runtime_error if they are neither.
inline bool is_grey(std::size_t bytes, int width, int height) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (count == 0 || (bytes != count && bytes != 3 * count)) {
    throw std::runtime_error("an image of " + size_text(width, height) + " has not " +
                             std::to_string(bytes) + " bytes");
  }
  return bytes == count;
}

}  // namespace maploop::sensors
