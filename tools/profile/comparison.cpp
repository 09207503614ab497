#include "tools/profile/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::profile {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Returns the items of both by their names, in the order of the first.
template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& a, const std::vector<Item>& b) {
  std::vector<std::string> names;
  for (const auto* items : {&a, &b}) {
    for (const Item& item : *items) {
      if (std::find(names.begin(), names.end(), item.name) == names.end())
        names.push_back(item.name);
    }
  }
  return names;
}

// Returns figure(item) of that name; `unknown` without it, or if it was never measured.
template <class Item, class Figure>
double value(const std::vector<Item>& items, const std::string& name, Figure figure) {
  const Item* const item = find(items, name);
  return item != nullptr ? figure(*item) : unknown;
}

double share_missed(const LatencySummary& s, bool virtual_time) {
  if (virtual_time || s.deadline == Duration::zero() || s.count == 0) return unknown;
  return 100.0 * static_cast<double>(s.misses) / static_cast<double>(s.count);
}

template <class Summary>
ComparedGroup group(std::string title, const Profile& a, const Profile& b,
                    std::vector<Summary> Profile::*summaries) {
  ComparedGroup group{std::move(title), {}};
  for (const std::string& name : names_of(a.*summaries, b.*summaries)) {
    const auto both = [&](auto figure) {
      return BothRuns{value(a.*summaries, name, [&](const Summary& s) { return figure(s, a); }),
                      value(b.*summaries, name, [&](const Summary& s) { return figure(s, b); })};
    };
    const auto time = [&](Duration LatencySummary::*percentile) {
      return both([percentile](const LatencySummary& s, const Profile&) {
        return s.count > 0 ? to_milliseconds(s.*percentile) : unknown;
      });
    };
    group.items.push_back({name, time(&LatencySummary::p50), time(&LatencySummary::p99),
                           both([](const LatencySummary& s, const Profile& p) {
                             return share_missed(s, p.virtual_time());
                           })});
  }
  return group;
}

web::Columns<Compared> columns_of(const Comparison& c, const std::string& figure,
                                  const std::string& unit, BothRuns Compared::*both, int width,
                                  int digits, bool ratio) {
  web::Columns<Compared> columns{{figure + "/a", fmt::format("{} {}, {}", figure, unit, c.a), width,
                                  digits, [both](const Compared& item) { return (item.*both).a; }},
                                 {figure + "/b", fmt::format("{} {}, {}", figure, unit, c.b), width,
                                  digits, [both](const Compared& item) { return (item.*both).b; }}};
  if (ratio) {
    columns.push_back({figure + "/ratio", "ratio", 6, 2,
                       [both](const Compared& item) { return (item.*both).ratio(); }});
  }
  return columns;
}

web::Columns<Compared> joined(std::vector<web::Columns<Compared>> parts) {
  web::Columns<Compared> all{{"", "of", -20, 0, &Compared::name}};
  for (web::Columns<Compared>& part : parts) {
    all.insert(all.end(), std::make_move_iterator(part.begin()),
               std::make_move_iterator(part.end()));
  }
  return all;
}

web::Columns<Compared> latencies(const Comparison& c) {
  return joined({columns_of(c, "p50", "ms", &Compared::p50, 8, 3, true),
                 columns_of(c, "p99", "ms", &Compared::p99, 8, 3, true),
                 columns_of(c, "missed", "%", &Compared::missed, 6, 2, false)});
}

web::Columns<Compared> processor_columns(const Comparison& c) {
  return joined({columns_of(c, "processor", "s", &Compared::p50, 8, 3, true)});
}

}  // namespace

Comparison compare(const std::string& name_a, const Profile& a, const std::string& name_b,
                   const Profile& b) {
  Comparison c{name_a, name_b, {}, {}};
  c.groups.push_back(group("From release to result", a, b, &Profile::threads));
  c.groups.push_back(group("From stamp to state", a, b, &Profile::paths));
  c.groups.push_back(group("Wake-up", a, b, &Profile::wake_up));
  c.groups.push_back(group("Execution", a, b, &Profile::execution));
  std::erase_if(c.groups, [](const ComparedGroup& g) { return g.items.empty(); });
  const std::vector<ProcessorTime> of_a = processor_time(a.health), of_b = processor_time(b.health);
  const auto seconds = [](const ProcessorTime& t) { return t.seconds; };
  for (const std::string& name : names_of(of_a, of_b)) {
    c.processor.push_back({name,
                           {value(of_a, name, seconds), value(of_b, name, seconds)},
                           {unknown, unknown},
                           {unknown, unknown}});
  }
  return c;
}

std::string to_text(const Comparison& c) {
  std::string text = fmt::format("a: {}\nb: {}\nRatios are b to a. Latencies in ms.\n", c.a, c.b);
  const auto append = [&text](const std::vector<Compared>& items,
                              const web::Columns<Compared>& columns) {
    for (const Compared& item : items) text += web::to_text(columns, item) + '\n';
  };
  for (const ComparedGroup& group : c.groups) {
    text += fmt::format("\n{:<21} {:>8} {:>8} {:>6} {:>8} {:>8} {:>6} {:>6} {:>6}\n", group.title,
                        "p50 a", "b", "ratio", "p99 a", "b", "ratio", "miss a", "b %");
    append(group.items, latencies(c));
  }
  text += fmt::format("\n{:<21} {:>8} {:>8} {:>6}\n", "Processor time, s", "a", "b", "ratio");
  append(c.processor, processor_columns(c));
  return text;
}

std::string to_json(const Comparison& c) {
  nlohmann::json json{{"a", c.a}, {"b", c.b}};
  for (const ComparedGroup& group : c.groups)
    json[group.title] = web::by_name(latencies(c), group.items);
  json["Processor time"] = web::by_name(processor_columns(c), c.processor);
  return json.dump(2) + '\n';
}

std::string to_html(const Comparison& c) {
  web::Page page("Profile of " + c.b + " beside " + c.a);
  page.add(web::paragraph("Ratios are those of " + c.b + " to " + c.a + "."));
  for (const ComparedGroup& group : c.groups)
    page.add(web::heading(group.title) + web::table(latencies(c), group.items));
  page.add(web::heading("Processor time") + web::table(processor_columns(c), c.processor));
  return page.text();
}

}  // namespace maploop::profile
