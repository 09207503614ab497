// Formats pieces of HTML pages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::web {

// Returns plain text as HTML.
std::string escaped(std::string_view text);

// Return elements that contain plain text.
std::string heading(std::string_view text);  // with the id heading_id(text), for links
std::string paragraph(std::string_view text);
std::string preformatted(std::string_view text);

std::string heading_id(std::string_view text);

// Returns HTML that unfolds at a click on its summary, which is plain text.
std::string folded(std::string_view summary, std::string_view html);

// Returns a button that moves the cursor of the page's timeline to a time; the stretch until `to`
// is what it stands for. Both are as the x of plots over time, the text is plain.
std::string time_button(double from, double to, std::string_view text);

// Returns an image with its data, scaled down if the page is narrower than `width` (px). `format`
// is that of `bytes`, such as "jpeg" or "png".
std::string image(const std::vector<std::uint8_t>& bytes, std::string_view format, int width);

// Returns a number with `digits` decimals and its unit, or a dash if it is not finite.
std::string figure(double value, int digits, const char* unit = "");

}  // namespace maploop::web
