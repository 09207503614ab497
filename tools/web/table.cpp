#include "tools/web/table.h"

#include <fmt/format.h>

#include "tools/web/html.h"

namespace maploop::web {
namespace {

Row escaped_row(Row row) {
  for (std::string& cell : row) cell = escaped(cell);
  return row;
}

// A heading without a text is a plain cell.
void append_row(std::string& html, const Row& row, const char* element) {
  html += "<tr>";
  for (const std::string& cell : row) {
    html += fmt::format("<{0}>{1}</{0}>", cell.empty() ? "td" : element, cell);
  }
  html += "</tr>\n";
}

}  // namespace

std::string table_of_html(const Row& heading, const std::vector<Row>& rows) {
  std::string html = "<div class=\"wide\" tabindex=\"0\"><table>\n";
  append_row(html, heading, "th");
  for (const Row& row : rows) append_row(html, row, "td");
  return html + "</table></div>\n";
}

std::string table(const Row& heading, const std::vector<Row>& rows) {
  std::vector<Row> escaped_rows;
  escaped_rows.reserve(rows.size());
  for (const Row& row : rows) escaped_rows.push_back(escaped_row(row));
  return table_of_html(escaped_row(heading), escaped_rows);
}

Row joined(const std::vector<Row>& rows) {
  Row all;
  for (const Row& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

std::string shown(const nlohmann::json& value, int digits) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? figure(value.get<double>(), digits) : value.dump();
}

}  // namespace maploop::web
