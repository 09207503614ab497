// Pieces of the page's text.
#pragma once

#include <string>

namespace maploop::report {

// A number with so many digits and its unit; a dash where it is not finite.
std::string figure(double value, int digits, const char* unit = "");

// HTML of plain text.
std::string paragraph(const std::string& text);

// HTML that opens at a click on the plain text of its summary.
std::string folded(const std::string& summary, const std::string& html);

}  // namespace maploop::report
