#include "runtime/vehicle/graph.h"

#include <array>
#include <cstdio>

namespace maploop::vehicle {
namespace {

std::string ms(Duration d) {
  if (d == Duration::zero()) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g ms", to_milliseconds(d));
  return text.data();
}

std::string_view when_late(const Stage& stage) {
  if (stage.period == Duration::zero()) return "-";
  switch (stage.overrun) {
    case runtime::Overrun::skip:
      return "leaves ticks out";
    case runtime::Overrun::shed:
      return "cuts ticks short";
    default:
      return "catches up";
  }
}

std::string rates(const Stage& stage) {
  if (stage.max_rate == 0.0) return "-";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%g to %g Hz", stage.min_rate, stage.max_rate);
  return text.data();
}

std::string row(std::initializer_list<std::string_view> cells) {
  std::string line = "|";
  for (const std::string_view cell : cells) line += ' ' + std::string(cell) + " |";
  return line + '\n';
}

std::string_view name(runtime::Overflow overflow) {
  return overflow == runtime::Overflow::keep_all ? "keep all, the producer waits"
                                                 : "drop the newest";
}

}  // namespace

std::string graph_page() {
  std::string page =
      "# The vehicle's graph\n\n"
      "Made from the table in `graph.h`; a test compares them.\n\n"
      "## Threads\n\n"
      "The patience, the budget and the rates are of data time, the deadline is of the machine's\n"
      "clock. What came on one input waits that long for what belongs to it on the other. What a\n"
      "thread does when its ticks fall behind is of a live run: a replay catches up with every "
      "tick\n"
      "of the fusion, and stalls the data clock.\n\n";
  page += row({"thread", "runs", "released by", "period", "phase", "when late", "patience",
               "budget", "deadline", "watched rate"});
  page += row({"---", "---", "---", "---", "---", "---", "---", "---", "---", "---"});
  for (const Stage& s : stages::all) {
    page += row({s.name, s.runs, s.released, ms(s.period), ms(s.phase), when_late(s),
                 ms(s.patience), ms(s.budget), ms(s.deadline), rates(s)});
  }
  page += "\n## Rings\n\nA full ring of a live run drops the newest.\n\n";
  page += row({"ring", "carries", "capacity", "when full"});
  page += row({"---", "---", "---", "---"});
  for (const EdgeSpec& e : edges::all) {
    page += row({e.name, e.carries, std::to_string(e.capacity), name(e.overflow)});
  }
  page += "\n## Newest values, given where their reader asks\n\n";
  page += row({"from -> to", "carries"});
  page += row({"---", "---"});
  for (const CellSpec& c : cells::all) page += row({c.name, c.carries});
  page += "\n## Channels\n\n";
  page += row({"channel", "type", "from", "shows", "rate", "same bits each run"});
  page += row({"---", "---", "---", "---", "---", "---"});
  for (const Channel& c : channels::all) {
    page += row({"`" + std::string(c.name) + "`", c.type, c.from, c.shows, c.rate,
                 c.from_data ? "yes" : "no"});
  }
  page += "\n## Paths, from a sensor's stamp to the state that holds it\n\n";
  page += row({"path", "deadline"});
  page += row({"---", "---"});
  for (const Path& p : paths::all) page += row({p.name, ms(p.deadline)});
  return page;
}

}  // namespace maploop::vehicle
