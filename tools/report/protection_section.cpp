#include <fmt/format.h>

#include <utility>

#include "tools/report/sections.h"
#include "tools/web/html.h"
#include "tools/web/stanford.h"
#include "tools/web/table.h"

namespace maploop::report {
namespace {

using fusion_score::ProtectedMoment;
using fusion_score::ProtectionScore;
using web::Line;
using web::Plot;
using Error = ProtectedMoment::Error;
using Moments = std::vector<ProtectedMoment>;

// Many moments are thinned; the one with the largest error beside its level stays.
Line points(const char* name, const Moments& moments, bool doubted, Error ProtectedMoment::*which) {
  Line line{name, {}, {}, Line::Look::points};
  std::vector<double> ratios;
  for (const ProtectedMoment& moment : moments) {
    if (moment.doubted != doubted) continue;
    line.add((moment.*which).size, (moment.*which).level);
    ratios.push_back((moment.*which).ratio());
  }
  const auto kept = web::thinned(ratios.size(), {&ratios});
  for (auto* values : {&line.x, &line.y}) *values = web::chosen(*values, kept);
  return line;
}

Plot stanford(const ProtectionScore& score) {
  std::vector<Line> lines{points("along", score.moments, false, &ProtectedMoment::along),
                          points("across", score.moments, false, &ProtectedMoment::across),
                          points("horizontal", score.moments, false, &ProtectedMoment::horizontal)};
  if (score.doubted > 0) {
    lines.push_back(points("horizontal, with an aid doubted", score.moments, true,
                           &ProtectedMoment::horizontal));
  }
  return web::stanford_plot("Stanford plot of the fused position", std::move(lines));
}

Plot over_time(const Scene& scene, const Moments& moments) {
  std::vector<double> seconds, error, level;
  for (const ProtectedMoment& moment : moments) {
    seconds.push_back(scene.second(moment.stamp));
    error.push_back(moment.horizontal.size);
    level.push_back(moment.doubted ? unknown : moment.horizontal.level);
  }
  const auto kept = web::thinned(seconds.size(), {&error, &level});
  const std::vector<double> x = web::chosen(seconds, kept);
  Plot plot{
      "Horizontal error and its protection level",
      "s",
      "m",
      {{"protection level", x, web::chosen(level, kept)}, {"error", x, web::chosen(error, kept)}}};
  plot.over_time = true;
  return plot;
}

}  // namespace

void add_protection(web::Page& page, const Scene& scene) {
  const auto& score = scene.report.result.protection;
  if (!score) return;
  const auto row = [](const char* name, const ProtectionScore::Level& level) {
    return web::Row{name, std::to_string(level.beyond), web::figure(level.median, 2)};
  };
  page.add(web::heading("Protection levels") +
           web::paragraph(fmt::format(
               "At one moment, an error is to be beyond its level with a probability of {:g}. "
               "There are {} moments with a reference; in {} of them an aid was doubted, and the "
               "levels did not hold.",
               score->risk, score->moments.size(), score->doubted)) +
           web::table({"", "errors beyond it", "median level, m"},
                      {row("along the way", score->along), row("across", score->across),
                       row("horizontal", score->horizontal)}));
  page.add({stanford(*score), over_time(scene, score->moments)});
}

}  // namespace maploop::report
