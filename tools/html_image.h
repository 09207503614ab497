// Images in pages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::tools {

// An encoded image, written into the page; `format` as in "jpeg" or "png", `width` in px on the
// page, or what there is.
inline std::string image_tag(const std::vector<std::uint8_t>& bytes, std::string_view format,
                             int width) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "<img style='max-width:100%' width='" + std::to_string(width) +
                     "' src='data:image/" + std::string(format) + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i < 3 ? bytes.size() - i : 3;
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8U | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= left ? digits[three >> (18U - 6U * k) & 63U] : '=';
  }
  return text + "'>";
}

}  // namespace maploop::tools
