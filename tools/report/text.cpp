#include "tools/report/text.h"

#include <fmt/format.h>
#include <cmath>

#include "tools/command/html_text.h"

namespace maploop::report {

std::string figure(double value, int digits, const char* unit) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.{}f}{}", value, digits, unit);
}

std::string paragraph(const std::string& text) {
  return "<p>" + tools::escaped(text) + "</p>\n";
}

std::string folded(const std::string& summary, const std::string& html) {
  return "<details><summary>" + tools::escaped(summary) + "</summary>\n" + html + "</details>\n";
}

}  // namespace maploop::report
