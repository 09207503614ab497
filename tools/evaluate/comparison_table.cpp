// The figures of a comparison as tables and JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tools/evaluate/run_errors.h"
#include "tools/web/html.h"

namespace maploop::evaluation {
namespace {

using nlohmann::json;
using Cell = std::function<std::string(const RunErrors&)>;

class TableBuilder {
 public:
  explicit TableBuilder(const std::vector<RunErrors>& runs) : runs_(runs) {
    table.heading = {"figure", "unit"};
    for (const RunErrors& run : runs) table.heading.push_back(run.name);
  }

  void add(const std::string& figure, const std::string& unit, const Cell& cell) {
    table.rows.push_back({figure, unit});
    for (const RunErrors& run : runs_) table.rows.back().push_back(cell(run));
  }

  void add(const std::string& name, Statistics RunErrors::*of) {
    using Part = std::pair<const char*, double Statistics::*>;
    for (const auto& [part, value] : {Part{"rmse", &Statistics::rmse},
                                      {"mean", &Statistics::mean},
                                      {"median", &Statistics::median},
                                      {"95 %", &Statistics::p95},
                                      {"max", &Statistics::max}}) {
      add(name + ' ' + part, "m",
          [of, value = value](const RunErrors& run) { return web::figure(run.*of.*value, 3); });
    }
  }

  FigureTable table;

 private:
  const std::vector<RunErrors>& runs_;
};

void add_segments(TableBuilder& builder, const std::string& name,
                  const std::function<SegmentError(const RunErrors&)>& of) {
  builder.add(name, "%", [&](const RunErrors& r) { return web::figure(of(r).percent, 3); });
  builder.add(name + ", rotation", "deg/m", [&](const RunErrors& r) {
    return r.has_attitude ? web::figure(of(r).deg_per_m, 5) : "-";
  });
}

// Escapes the characters that LaTeX reads as commands.
std::string latex(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("%_&#${}").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c == '\\' || c == '^' || c == '~' ? '-' : c;
  }
  return escaped;
}

std::string csv(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string markdown(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string joined(const std::vector<std::string>& row, const char* between,
                   std::string (*cell)(const std::string&)) {
  std::string text;
  for (const std::string& value : row) text += (&value == row.data() ? "" : between) + cell(value);
  return text;
}

json to_json(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"p95", s.p95}, {"max", s.max}};
}

json to_json(const SegmentError& error, bool has_attitude) {
  return {{"percent", error.percent},
          {"deg_per_m", has_attitude ? json(error.deg_per_m) : json()},
          {"segments", error.segments}};
}

std::string letter(std::size_t run) {
  return run < 26 ? std::string(1, static_cast<char>('A' + run)) : fmt::format("{}", run + 1);
}

std::string said_of(const RunErrors& run) {
  std::string text = fmt::format("{} poses scored", run.matched.truth.size());
  if (run.matched.unmatched_estimate + run.matched.unmatched_truth > 0) {
    text += fmt::format("; without a partner: {} of its own, {} of the truth",
                        run.matched.unmatched_estimate, run.matched.unmatched_truth);
  }
  return text;
}

}  // namespace

FigureTable figures(const Comparison& comparison) {
  TableBuilder builder(comparison.runs);
  const auto count = [](std::size_t number) { return fmt::format("{}", number); };
  builder.add("poses scored", "", [&](const auto& r) { return count(r.matched.truth.size()); });
  builder.add("without partner, run", "",
              [&](const auto& r) { return count(r.matched.unmatched_estimate); });
  builder.add("without partner, truth", "",
              [&](const auto& r) { return count(r.matched.unmatched_truth); });
  builder.add("way", "m", [](const auto& r) { return web::figure(r.distance_m, 1); });
  builder.add("horizontal", &RunErrors::horizontal_m);
  builder.add("vertical", &RunErrors::vertical_m);
  builder.add("3-D", &RunErrors::absolute_m);
  builder.add("end point", "m", [](const auto& r) { return web::figure(r.end_point_m, 3); });
  for (std::size_t k = 0; k < comparison.lengths_m.size(); ++k) {
    const auto has = [k](const RunErrors& r) { return r.relative[k].segments > 0; };
    if (std::none_of(comparison.runs.begin(), comparison.runs.end(), has)) continue;
    add_segments(builder, fmt::format("over {:g} m", comparison.lengths_m[k]),
                 [k](const RunErrors& r) { return r.relative[k]; });
  }
  add_segments(builder, "KITTI metric", [](const RunErrors& r) { return r.kitti; });
  if (comparison.align == Align::sim3)
    builder.add("scale", "", [](const auto& r) { return web::figure(r.scale, 5); });
  return builder.table;
}

std::string to_text(const FigureTable& table, TableFormat format) {
  const bool is_latex = format == TableFormat::latex, is_csv = format == TableFormat::csv;
  const auto line = [&](const std::vector<std::string>& row) {
    if (is_csv) return joined(row, ",", csv) + '\n';
    if (is_latex) return joined(row, " & ", latex) + " \\\\\n";
    return "| " + joined(row, " | ", markdown) + " |\n";
  };
  const std::size_t runs = table.heading.size() - 2;
  std::string text;
  if (is_latex) text = "\\begin{tabular}{ll" + std::string(runs, 'r') + "}\n\\hline\n";
  text += line(table.heading);
  if (is_latex) text += "\\hline\n";
  if (format == TableFormat::markdown) {
    text += "|---|---|";
    for (std::size_t i = 0; i < runs; ++i) text += "---:|";
    text += '\n';
  }
  for (const auto& row : table.rows) text += line(row);
  if (is_latex) text += "\\hline\n\\end{tabular}\n";
  return text;
}

std::string to_text(const Comparison& c) {
  std::string text = fmt::format("truth {}: {} poses, {:.1f} m\nalignment: {}\n", c.truth.name,
                                 c.truth.way.size(), c.truth.way.back(), to_string(c.align));
  for (std::size_t i = 0; i < c.runs.size(); ++i)
    text += fmt::format("{}  {}\n   {}\n", letter(i), c.runs[i].name, said_of(c.runs[i]));
  const FigureTable table = figures(c);
  constexpr std::size_t most = 5;  // runs beside each other in 80 columns
  for (std::size_t first = 0; first < c.runs.size(); first += most) {
    const std::size_t end = std::min(first + most, c.runs.size());
    text += fmt::format("\n{:30}", "");
    for (std::size_t i = first; i < end; ++i) text += fmt::format("{:>10}", letter(i));
    text += '\n';
    for (const auto& row : table.rows) {
      text += fmt::format("{:24} {:5}", row[0], row[1]);
      for (std::size_t i = first; i < end; ++i) text += fmt::format("{:>10}", row[i + 2]);
      text += '\n';
    }
  }
  return text;
}

nlohmann::json to_json(const Comparison& c) {
  json runs = json::array();
  for (const RunErrors& r : c.runs) {
    json lengths = json::array();
    for (std::size_t k = 0; k < c.lengths_m.size(); ++k) {
      lengths.push_back(to_json(r.relative[k], r.has_attitude));
      lengths.back()["length_m"] = c.lengths_m[k];
    }
    runs.push_back(
        {{"name", r.name},
         {"frames", r.matched.truth.size()},
         {"unmatched",
          {{"estimate", r.matched.unmatched_estimate}, {"truth", r.matched.unmatched_truth}}},
         {"distance_m", r.distance_m},
         {"scale", r.scale},
         {"horizontal_m", to_json(r.horizontal_m)},
         {"vertical_m", to_json(r.vertical_m)},
         {"absolute_m", to_json(r.absolute_m)},
         {"end_point_m", r.end_point_m},
         {"kitti", to_json(r.kitti, r.has_attitude)},
         {"lengths", lengths}});
  }
  return {{"truth", c.truth.name}, {"align", to_string(c.align)}, {"runs", runs}};
}

std::string to_csv(const Comparison& comparison) {
  std::string text = "run,stamp,way,horizontal,vertical,absolute\n";
  for (const RunErrors& run : comparison.runs) {
    const std::string name = csv(run.name);
    for (std::size_t i = 0; i < run.absolute.size(); ++i) {
      text += fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:.4f}\n", name, stamp_text(run.matched, i),
                          comparison.truth.way[run.matched.frames[i]], run.horizontal[i],
                          run.vertical[i], run.absolute[i]);
    }
  }
  return text;
}

}  // namespace maploop::evaluation
