#include "runtime/vehicle/graph/graph.h"

#include <fmt/format.h>

#include <string>
#include <tuple>

namespace maploop::vehicle {
namespace {

std::string ms(Duration d) {
  return d == Duration::zero() ? "-" : fmt::format("{:g} ms", to_milliseconds(d));
}

std::string_view when_late(const StageSpec& stage) {
  if (stage.period == Duration::zero()) return "-";
  return stage.overrun == runtime::Overrun::skip ? "leaves ticks out" : "catches up";
}

std::string rates(const StageSpec& stage) {
  return stage.max_rate == 0.0 ? "-"
                               : fmt::format("{:g} to {:g} Hz", stage.min_rate, stage.max_rate);
}

std::string row(std::initializer_list<std::string_view> cells) {
  std::string line = "|";
  for (const std::string_view cell : cells) line += ' ' + std::string(cell) + " |";
  return line + '\n';
}

std::string header(std::initializer_list<std::string_view> cells) {
  std::string line = row(cells) + '|';
  for (std::size_t i = 0; i < cells.size(); ++i) line += " --- |";
  return line + '\n';
}

// "NavState", as the compiler spells the type.
template <class T>
std::string carried(const RingSpec<T>&) {
  const std::string_view all = __PRETTY_FUNCTION__;
  const std::size_t begin = all.find("T = ") + 4;
  const std::string_view type = all.substr(begin, all.find_first_of(";]", begin) - begin);
  return std::string(type.substr(type.rfind(':') + 1));
}

template <class T>
std::string condition(const RingSpec<T>& spec) {
  if (spec.instead_of != nullptr) return "there is no " + std::string(spec.instead_of->name);
  switch (spec.needs) {
    case RingNeeds::raw_log:
      return "raw samples are logged";
    case RingNeeds::feedback:
      return "the map feeds back";
    case RingNeeds::ppp_feedback:
      return "the map feeds back, `tight`";
    case RingNeeds::carried:
      return "`[ppp] carried_by_motion`";
    case RingNeeds::both_ends:
      break;
  }
  return "-";
}

std::string_view name(runtime::Overflow overflow) {
  return overflow == runtime::Overflow::keep_all ? "keep all, the producer waits"
                                                 : "drop the newest";
}

}  // namespace

std::string graph_page() {
  std::string page =
      "# The vehicle's graph\n\n"
      "Made from the declaration in `stage_specs.h`, `ring_specs.h` and `channel_specs.h`; a test\n"
      "compares them.\n\n"
      "## Threads\n\n"
      "The patience, the budget and the rates are of data time, the deadline is of the machine's\n"
      "clock. A sample of one input waits at most the patience for the matching sample of the "
      "other.\n"
      "The column `when late` describes a live run: a replay catches up with every tick of the\n"
      "fusion, and stalls the data clock.\n\n";
  page += header({"thread", "runs", "released by", "period", "phase", "when late", "patience",
                  "budget", "deadline", "watched rate"});
  for (const StageSpec& s : stages::all) {
    page += row({s.name, s.runs, s.released, ms(s.period), ms(s.phase), when_late(s),
                 ms(s.patience), ms(s.budget), ms(s.deadline), rates(s)});
  }
  page +=
      "\n## Rings\n\n"
      "A ring exists in a vehicle that has both threads. A full ring of a live run drops the "
      "newest.\n\n";
  page += header({"ring", "carries", "capacity", "only if", "when full"});
  const auto ring = [&page](const auto& spec) {
    page += row({spec.name(), carried(spec), std::to_string(spec.capacity), condition(spec),
                 name(spec.overflow)});
  };
  std::apply([&](const auto&... spec) { (ring(spec), ...); }, rings::all);
  for (const StageSpec& stage : stages::all) {
    if (!stage.saved) continue;
    page += row({std::string(stage.name) + " -> snapshot", "StageSnapshot",
                 std::to_string(rings::snapshot_capacity), "snapshots are taken",
                 name(runtime::Overflow::keep_all)});
  }
  page += "\n## Newest values, given on request\n\n";
  page += header({"from -> to", "carries"});
  for (const CellSpec& c : cells::all) page += row({c.name, c.carries});
  page += "\n## Channels\n\n";
  page += header({"channel", "type", "from", "shows", "rate", "same bits each run"});
  for (const ChannelSpec& c : channels::all) {
    page += row({"`" + std::string(c.name) + "`", c.type, c.from, c.shows, c.rate,
                 c.from_data ? "yes" : "no"});
  }
  page += "\n## Paths, from a sensor's stamp to the state that holds it\n\n";
  page += header({"path", "deadline"});
  for (const Path& p : paths::all) page += row({p.name, ms(p.deadline)});
  return page;
}

}  // namespace maploop::vehicle
