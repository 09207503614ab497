// Tests the contents of written pages, but not how a browser draws them.
#include "tools/web/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/web/bundle.h"
#include "tools/web/html.h"
#include "tools/web/table.h"

namespace maploop::web {
namespace {

using nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string without_bundle(std::string page) {
  for (const std::string_view part : {page_script(), page_style()}) {
    const std::size_t at = part.empty() ? std::string::npos : page.find(part);
    if (at != std::string::npos) page.erase(at, part.size());
  }
  return page;
}

TEST(Page, APlotSaysAllThatTheScriptDraws) {
  Plot plot{"title", "s", "m", {{"line", {0.0, 1.0, 2.0}, {1.5, nan, infinity}}}, true};
  plot.roads = {{"", {1e7, -3.25}, {0.1, 1.0 / 3.0}}};
  plot.bands = {{"3 sigma", {0.0}, {-1.0}, {1.0}}};
  plot.lines[0].look = Line::Look::steps;
  plot.x_mark = Mark{50.0, "deadline"};
  const json j = json::parse(to_json(plot));
  EXPECT_EQ(j["lines"][0]["y"], json::parse("[1.5, null, null]"));
  EXPECT_EQ(j["lines"][0]["look"], "steps");
  EXPECT_EQ(j["roads"][0]["x"], json::parse("[1e7, -3.25]"));
  EXPECT_NEAR(j["roads"][0]["y"][1].get<double>(), 1.0 / 3.0, 1e-7);
  EXPECT_EQ(j["bands"][0]["high"], json::parse("[1.0]"));
  EXPECT_EQ(j["x_mark"]["value"], 50.0);
  EXPECT_EQ(j["equal_axes"], true);
  EXPECT_EQ(j["x_log"], false);
}

TEST(Page, NamesCannotBreakIt) {
  const std::string bad = "</script><b>\"\\ \xff &";
  const std::string page =
      Page(bad).add(Plot{bad, bad, bad, {{bad, {}, {}}}}).add(table({bad}, {{bad}})).text();
  const std::string own = without_bundle(page);
  EXPECT_EQ(own.find("<b>"), std::string::npos);
  const std::size_t begin = own.find("id=\"plots\">") + 11;
  const json plots = json::parse(own.substr(begin, own.find("</script>", begin) - begin));
  EXPECT_EQ(plots[0]["title"], "</script><b>\"\\ \xEF\xBF\xBD &");
}

TEST(Page, NeedsNothingButABrowser) {
  const std::string page = without_bundle(Page("a").add(Plot{"b", "c", "d"}).text());
  for (const char* outside : {"http", "src=", "href=", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  EXPECT_EQ(page_style().find("url("), std::string::npos);
  EXPECT_EQ(page_script().find("</script"), std::string::npos) << "it would end there";
  EXPECT_NE(page_style().find("light-dark("), std::string::npos);
}

TEST(Page, ThinningKeepsExtremesAndGaps) {
  std::vector<double> values(30'000, 1.0);
  values[7'001] = 9.0;
  values[15'013] = -9.0;
  values[20'017] = values[20'018] = nan;
  const auto kept = thinned(values.size(), {&values});
  EXPECT_LT(kept.size(), 8'000U);
  for (const std::size_t i : {0U, 7'001U, 15'013U, 20'017U, 29'999U})
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), i)) << i;
  EXPECT_EQ(chosen(values, {0, 7'001}), (std::vector<double>{1.0, 9.0}));
  EXPECT_EQ(thinned(2'000, {}).size(), 2'000U);
  EXPECT_TRUE(thinned(0, {}).empty());
}

TEST(Page, ContentsLeadToTheHeadings) {
  const std::string page =
      Page("a").add_contents().add(heading("Lost & found")).add(heading("Time")).text();
  EXPECT_NE(page.find("<a href=\"#Lost---found\">Lost &amp; found</a>"), std::string::npos);
  EXPECT_NE(page.find("<h2 id=\"Lost---found\">"), std::string::npos);
  EXPECT_NE(page.find("<a href=\"#Time\">Time</a>"), std::string::npos);
}

TEST(Page, EachPictureSaysWhyItIsNotThere) {
  const std::string page = Page("a").add({Plot{"one", "", ""}, Plot{"two", "", ""}}).text();
  EXPECT_NE(page.find("<figure data-plot=\"1\""), std::string::npos);
  EXPECT_NE(page.find(page_script().empty() ? "built without npm" : "needs JavaScript"),
            std::string::npos);
}

}  // namespace
}  // namespace maploop::web
