// Formats pieces of the page's text.
#pragma once

#include <string>

namespace maploop::report {

// Returns a number with `digits` decimals and its unit, or a dash if it is not finite.
std::string figure(double value, int digits, const char* unit = "");

// Returns the HTML of plain text.
std::string paragraph(const std::string& text);

// Returns HTML that unfolds at a click on its summary, which is plain text.
std::string folded(const std::string& summary, const std::string& html);

}  // namespace maploop::report
