#include "tools/command/wrapped_text.h"

#include <algorithm>

namespace maploop::tools {
namespace {

// Where the last column of a line begins that has room for words.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  std::size_t indent = begin;
  for (std::size_t at = line.find("  ", begin); at != std::string_view::npos;
       at = line.find("  ", at)) {
    at = std::min(line.find_first_not_of(' ', at), line.size());
    if (at > width / 2) break;
    indent = at;
  }
  return std::min(indent, width / 2);
}

void append_wrapped(std::string_view line, std::size_t width, std::string& text) {
  const std::size_t indent = hanging_indent(line, width);
  // No break before the column's first word.
  std::size_t room = width, least = std::max(indent, line.find_first_not_of(' '));
  while (line.size() > room) {
    std::size_t end = line.rfind(' ', room);
    if (end == std::string_view::npos || end <= least) end = line.find(' ', std::max(least, room));
    if (end == std::string_view::npos) break;
    text += line.substr(0, end);
    text.resize(text.find_last_not_of(' ') + 1);
    text += '\n' + std::string(indent, ' ');
    line.remove_prefix(std::min(line.find_first_not_of(' ', end), line.size()));
    room = width - indent;
    least = 0;
  }
  text += line;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    append_wrapped(text.substr(0, end), width, result);
    if (end == std::string_view::npos) break;
    result += '\n';
    text.remove_prefix(end + 1);
  }
  return result;
}

}  // namespace maploop::tools
