#include "tools/web/html.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "msgs/base64.h"

namespace maploop::web {

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else if (c == '>') {
      html += "&gt;";
    } else if (c == '\'') {
      html += "&#39;";
    } else if (c == '"') {
      html += "&quot;";
    } else {
      html += c;
    }
  }
  return html;
}

std::string heading(std::string_view text) {
  return "<h2 id=\"" + heading_id(text) + "\">" + escaped(text) + "</h2>\n";
}

std::string heading_id(std::string_view text) {
  std::string id(text);
  for (char& c : id) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return id;
}

std::string paragraph(std::string_view text) {
  return "<p>" + escaped(text) + "</p>\n";
}

std::string preformatted(std::string_view text) {
  return "<pre>" + escaped(text) + "</pre>\n";
}

std::string folded(std::string_view summary, std::string_view html) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), html);
}

std::string time_button(double from, double to, std::string_view text) {
  return fmt::format(
      "<button type=\"button\" title=\"Move the cursor there\" data-from=\"{:.7g}\" "
      "data-to=\"{:.7g}\">{}</button>",
      from, to, escaped(text));
}

std::string image(const std::vector<std::uint8_t>& bytes, std::string_view format, int width) {
  return fmt::format("<img style='max-width:100%' width='{}' src='data:image/{};base64,{}'>", width,
                     format, base64(bytes));
}

std::string figure(double value, int digits, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.{}f}{}", value, digits, unit) : "-";
}

}  // namespace maploop::web
