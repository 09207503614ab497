// Tests that a table's text, JSON and HTML come from one description.
#include "tools/web/table.h"

#include <gtest/gtest.h>

#include <limits>

#include "tools/web/html.h"

namespace maploop::web {
namespace {

struct Item {
  std::string name;
  std::uint64_t count;
  double error;
};

const Columns<Item> columns{
    {"", "name", -6, 0, &Item::name},
    {"count", "", 4, 0, &Item::count},
    {"parts/error_m", "error, m", 7, 2, &Item::error},
    {"", "twice", 0, 1, [](const Item& i) { return 2.0 * i.error; }},
};

const Item good{"a<b", 3, 1.255};
const Item unknown{"none", 0, std::numeric_limits<double>::quiet_NaN()};

TEST(Table, TextHasItsWidthsAndDashes) {
  EXPECT_EQ(to_text(columns, good), " a<b       3    1.25");
  EXPECT_EQ(to_text(columns, unknown), " none      0       -");
}

TEST(Table, JsonHasItsKeysWithPaths) {
  EXPECT_EQ(to_json(columns, good).dump(), R"({"count":3,"parts":{"error_m":1.255}})");
  EXPECT_EQ(by_name(columns, std::vector{unknown}).dump(),
            R"({"none":{"count":0,"parts":{"error_m":null}}})");
}

TEST(Table, HtmlHasItsHeadings) {
  EXPECT_EQ(table(columns, std::vector{good}),
            "<div class=\"wide\" tabindex=\"0\"><table>\n"
            "<tr><th>name</th><th>error, m</th><th>twice</th></tr>\n"
            "<tr><td>a&lt;b</td><td>1.25</td><td>2.5</td></tr>\n"
            "</table></div>\n");
}

}  // namespace
}  // namespace maploop::web
