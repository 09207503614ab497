// Images in pages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/base64.h"

namespace maploop::tools {

// An encoded image, written into the page; `format` as in "jpeg" or "png", `width` in px on the
// page, or what there is.
inline std::string image_tag(const std::vector<std::uint8_t>& bytes, std::string_view format,
                             int width) {
  return "<img style='max-width:100%' width='" + std::to_string(width) + "' src='data:image/" +
         std::string(format) + ";base64," + base64(bytes) + "'>";
}

}  // namespace maploop::tools
