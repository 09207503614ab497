#include "tools/report/text.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "tools/html_text.h"

namespace maploop::report {

std::string figure(double value, int digits, const char* unit) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> text{};  // the longest double has 309 digits before the decimal point
  std::snprintf(text.data(), text.size(), "%.*f%s", digits, value, unit);
  return text.data();
}

std::string paragraph(const std::string& text) {
  return "<p>" + tools::escaped(text) + "</p>\n";
}

std::string folded(const std::string& summary, const std::string& html) {
  return "<details><summary>" + tools::escaped(summary) + "</summary>\n" + html + "</details>\n";
}

}  // namespace maploop::report
