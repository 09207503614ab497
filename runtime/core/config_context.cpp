#include "runtime/core/config_context.h"

#include <cstddef>
#include <optional>

#include "runtime/core/config_state.h"

namespace maploop::runtime::detail {
namespace {

// Returns the dotted path that one line alone sets or opens, if the line is valid TOML by itself.
std::optional<std::string> path_of(std::string_view line) try {
  const toml::table table = toml::parse(line);
  const toml::table* level = &table;
  std::string path;
  while (level != nullptr && level->size() == 1 && !level->is_inline()) {
    const auto only = level->begin();
    const toml::node& value = only->second;
    path = dotted(path, only->first.str());
    const toml::array* array = value.as_array();
    level = array != nullptr && array->is_array_of_tables() ? array->front().as_table()
                                                            : value.as_table();
  }
  if (path.empty()) return std::nullopt;
  return path;
} catch (const toml::parse_error&) {
  return std::nullopt;
}

bool is_toml(std::string_view text) try {
  static_cast<void>(toml::parse(text));
  return true;
} catch (const toml::parse_error&) {
  return false;
}

std::size_t start_of_line_at(std::string_view text, std::size_t position) {
  if (position == 0) return 0;
  const std::size_t end_before = text.rfind('\n', position - 1);
  return end_before == std::string_view::npos ? 0 : end_before + 1;
}

std::size_t start_of_line_number(std::string_view text, std::size_t number) {
  std::size_t start = 0;
  for (std::size_t i = 1; i < number; ++i) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string_view::npos) break;
    start = end + 1;
  }
  return start;
}

std::string_view line_at(std::string_view text, std::size_t start) {
  const std::string_view line = text.substr(start, text.substr(start).find('\n'));
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

// Returns the table that the last header before `end` opened; the root has an empty path.
std::string table_before(std::string_view text, std::size_t end) {
  int tries = 100;  // each try parses the text above; limits the work on a hostile file
  while (end > 0 && tries > 0) {
    const std::size_t start = start_of_line_at(text, end - 1);
    const std::string_view line = line_at(text, start);
    if (line.starts_with('[')) {
      --tries;
      // If the text above is incomplete, this is not a header but part of an array or a string.
      if (is_toml(text.substr(0, start))) return path_of(line).value_or("");
    }
    end = start;
  }
  return {};
}

}  // namespace

std::string context_of(std::string_view text, const toml::parse_error& error) {
  const std::size_t start = start_of_line_number(text, error.source().begin.line);
  const std::string_view line = line_at(text, start);
  const std::optional<std::string> path = path_of(line);
  if (line.starts_with('[') && path) return *path + ": ";
  const std::string table = table_before(text, start);
  if (path) return (table.empty() ? *path : table + '.' + *path) + ": ";
  return table.empty() ? "" : "in [" + table + "]: ";
}

}  // namespace maploop::runtime::detail
