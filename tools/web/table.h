// Describes the columns of a table once; its lines of text, its JSON and its HTML are made from
// the same description.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace maploop::web {

using Row = std::vector<std::string>;

// Returns the HTML of a table that scrolls sideways if it is wider than the screen. Texts are
// plain in table(), and already HTML in table_of_html().
std::string table(const Row& heading, const std::vector<Row>& rows);
std::string table_of_html(const Row& heading, const std::vector<Row>& rows);

// Returns one row with the cells of all.
Row joined(const std::vector<Row>& rows);

// Returns a value as it is shown: a number that is not an integer has `digits` decimals; null and
// numbers that are not finite are a dash.
std::string shown(const nlohmann::json& value, int digits);

// One figure of an Item.
template <class Item>
struct Column {
  std::string key;      // in JSON, "a/b": b of the object a; empty: it is not there
  std::string heading;  // in HTML; empty: it is not there
  int width;            // in text, right-aligned, if negative left-aligned; 0: it is not there
  int digits;           // decimals in text and HTML
  std::function<nlohmann::json(const Item&)> value;
};

template <class Item>
using Columns = std::vector<Column<Item>>;

// Returns one line of text of the columns that have a width, with a blank before each.
template <class Item>
std::string text_line(const Columns<Item>& columns,
                      const std::function<std::string(const Column<Item>&)>& cell) {
  std::string text;
  for (const Column<Item>& c : columns) {
    if (c.width == 0) continue;
    const std::string value = cell(c);
    const auto width = static_cast<std::size_t>(std::abs(c.width));
    const std::string blanks(width - std::min(width, value.size()), ' ');
    text += ' ' + (c.width > 0 ? blanks + value : value + blanks);
  }
  return text;
}

// Returns the text of one item.
template <class Item>
std::string to_text(const Columns<Item>& columns, const Item& item) {
  return text_line<Item>(columns,
                         [&](const Column<Item>& c) { return shown(c.value(item), c.digits); });
}

// Returns the headings above such texts.
template <class Item>
std::string heading_text(const Columns<Item>& columns) {
  return text_line<Item>(columns, [](const Column<Item>& c) { return c.heading; });
}

template <class Item>
nlohmann::json to_json(const Columns<Item>& columns, const Item& item) {
  nlohmann::json json = nlohmann::json::object();
  for (const Column<Item>& c : columns) {
    if (!c.key.empty()) json[nlohmann::json::json_pointer('/' + c.key)] = c.value(item);
  }
  return json;
}

template <class Item>
nlohmann::json list(const Columns<Item>& columns, const std::vector<Item>& items) {
  nlohmann::json json = nlohmann::json::array();
  for (const Item& item : items) json.push_back(to_json(columns, item));
  return json;
}

// Returns an object that contains the items by their names.
template <class Item>
nlohmann::json by_name(const Columns<Item>& columns, const std::vector<Item>& items) {
  nlohmann::json json = nlohmann::json::object();
  for (const Item& item : items) json[item.name] = to_json(columns, item);
  return json;
}

// Return the parts of an HTML table, as plain text.
template <class Item>
Row headings(const Columns<Item>& columns) {
  Row row;
  for (const Column<Item>& c : columns) {
    if (!c.heading.empty()) row.push_back(c.heading);
  }
  return row;
}

template <class Item>
Row cells(const Columns<Item>& columns, const Item& item) {
  Row row;
  for (const Column<Item>& c : columns) {
    if (!c.heading.empty()) row.push_back(shown(c.value(item), c.digits));
  }
  return row;
}

template <class Item>
std::string table(const Columns<Item>& columns, const std::vector<Item>& items) {
  std::vector<Row> rows;
  rows.reserve(items.size());
  for (const Item& item : items) rows.push_back(cells(columns, item));
  return table(headings(columns), rows);
}

}  // namespace maploop::web
