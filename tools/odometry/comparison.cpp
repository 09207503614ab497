#include "tools/odometry/comparison.h"

#include <fmt/format.h>

#include "tools/web/html.h"

namespace maploop::odometry {

evaluation::Evaluation scored(const evaluation::StampedTrajectory& estimate,
                              const evaluation::StampedTrajectory& truth) {
  return evaluation::evaluate(evaluation::match(estimate, truth, from_seconds(0.001)),
                              {25.0, 100.0});
}

std::string percent_cell(const evaluation::SegmentError& error) {
  return error.segments > 0 ? fmt::format("{:.2f}", error.percent) : "-";
}

std::string turning_cell(const evaluation::SegmentError& error) {
  return error.segments > 0 ? fmt::format("{:.4f}", error.deg_per_m) : "-";
}

std::string to_text(const Comparison& comparison) {
  std::string text;
  const auto line = [&](const web::Row& row) {
    text += fmt::format("{:34}", row[0]);
    for (std::size_t i = 1; i < row.size(); ++i)
      text += fmt::format("{:>{}}", row[i], static_cast<int>(comparison.heading[i].size()) + 2);
    text += '\n';
  };
  line(comparison.heading);
  for (const Compared& method : comparison.methods) line(method.cells);
  return text + comparison.notes + '\n';
}

std::string to_html(const Comparison& comparison, const std::string& heading) {
  std::vector<web::Row> rows;
  web::Plot paths{"Seen from above", "right of the first camera, m", "ahead, m", {}, true};
  web::Plot errors{"Position error", "way, m", "m", {}};
  for (const Compared& method : comparison.methods) {
    const std::string& name = rows.emplace_back(method.cells).front();
    const evaluation::Matched& matched = method.score.matched;
    if (paths.lines.empty())
      paths.lines.push_back(evaluation::seen_from_above("truth", matched.truth));
    paths.lines.push_back(evaluation::seen_from_above(name, matched.estimate));
    errors.lines.push_back({name, method.score.errors.along, method.score.errors.from_start});
  }
  return web::Page(heading)
      .add(web::table(comparison.heading, rows) + "<p>" + web::escaped(comparison.notes) + "</p>\n")
      .add({paths, errors})
      .text();
}

}  // namespace maploop::odometry
