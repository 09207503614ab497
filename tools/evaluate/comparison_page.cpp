// The page of a comparison: what its script draws, thinned, and its tables.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/evaluate/run_errors.h"
#include "tools/web/html.h"
#include "tools/web/page.h"
#include "tools/web/table.h"

namespace maploop::evaluation {
namespace {

using nlohmann::json;
using Indices = std::vector<std::size_t>;

json chosen(const std::vector<double>& values, const Indices& kept) {
  return web::with_seven_digits(web::chosen(values, kept));
}

// Positions seen from above, in metres from the truth's first: for a camera's frame right and
// ahead, for a local frame east and north.
class Plane {
 public:
  explicit Plane(const TruthTrack& truth) : origin_(truth.trajectory.poses.front().translation()) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
    const Eigen::Vector3d& start = std::abs(truth.up.x()) < 0.9 ? x : y;
    x_ = (start - truth.up.dot(start) * truth.up).normalized();
    y_ = truth.up.cross(x_);
  }

  json json_of(const Trajectory& poses, const Indices& kept) const {
    std::vector<double> x, y;
    for (const std::size_t i : kept) {
      const Eigen::Vector3d p = poses[i].translation() - origin_;
      x.push_back(x_.dot(p));
      y.push_back(y_.dot(p));
    }
    return {{"x", web::with_seven_digits(x)}, {"y", web::with_seven_digits(y)}};
  }

 private:
  Eigen::Vector3d origin_, x_, y_;
};

json json_of(const std::vector<ErrorBin>& bins) {
  json list = json::array();
  for (const ErrorBin& bin : bins) {
    list.push_back(
        {{"low", bin.low},
         {"high", bin.high < std::numeric_limits<double>::max() ? json(bin.high) : json()},
         {"rmse", bin.absolute.rmse},
         {"p95", bin.absolute.p95},
         {"poses", bin.poses}});
  }
  return list;
}

json json_of(const RunErrors& run, const TruthTrack& truth, const Plane& plane,
             const std::vector<double>& lengths) {
  const Indices kept =
      web::thinned(run.absolute.size(), {&run.horizontal, &run.vertical, &run.absolute});
  Indices frames;
  for (const std::size_t i : kept) frames.push_back(run.matched.frames[i]);
  std::vector<double> sorted = run.absolute, shares;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i <= 200; ++i) shares.push_back(quantile(sorted, i / 200.0));
  json relative = json::array();
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    if (run.relative[k].segments > 0) relative.push_back({lengths[k], run.relative[k].percent});
  }
  json j = plane.json_of(run.matched.estimate, kept);
  j.update({{"name", run.name},
            {"poses", run.absolute.size()},
            {"unmatched", run.matched.unmatched_estimate},
            {"unmatched_truth", run.matched.unmatched_truth},
            {"time", chosen(truth.time, frames)},
            {"way", chosen(truth.way, frames)},
            {"horizontal", chosen(run.horizontal, kept)},
            {"vertical", chosen(run.vertical, kept)},
            {"absolute", chosen(run.absolute, kept)},
            {"quantiles", web::with_seven_digits(shares)},
            {"relative", relative},
            {"by_speed", json_of(run.by_speed)},
            {"by_turn_rate", json_of(run.by_turn_rate)}});
  return j;
}

json json_of(const TruthTrack& truth, const Plane& plane) {
  const Indices kept = web::thinned(truth.way.size(), {});
  json j = plane.json_of(truth.trajectory.poses, kept);
  j.update({{"name", truth.name},
            {"time", chosen(truth.time, kept)},
            {"way", chosen(truth.way, kept)},
            {"has_stamps", !truth.trajectory.stamps.empty()}});
  return j;
}

std::string unmatched(const Comparison& comparison) {
  std::string html;
  for (const RunErrors& run : comparison.runs) {
    if (run.matched.unmatched_estimate + run.matched.unmatched_truth == 0) continue;
    html += web::paragraph(
        fmt::format("{}: not scored, for want of a partner: {} poses of the run, {} of the truth.",
                    run.name, run.matched.unmatched_estimate, run.matched.unmatched_truth));
  }
  return html;
}

}  // namespace

std::string to_html(const Comparison& c) {
  const Plane plane(c.truth);
  const FigureTable table = figures(c);
  json data{{"truth", json_of(c.truth, plane)}, {"runs", json::array()}};
  for (const TableFormat format : {TableFormat::csv, TableFormat::markdown, TableFormat::latex})
    data["tables"][std::string(to_string(format))] = to_text(table, format);
  bool is_thinned = false;
  for (const RunErrors& run : c.runs) {
    data["runs"].push_back(json_of(run, c.truth, plane, c.lengths_m));
    is_thinned |= data["runs"].back()["x"].size() < run.absolute.size();
  }
  web::Page page(fmt::format("{} run{} against {}", c.runs.size(), c.runs.size() == 1 ? "" : "s",
                             c.truth.name));
  page.add(
          web::paragraph(fmt::format("{} poses of the truth, {:.1f} m. Alignment: {}. Figures are "
                                     "of all poses{}.",
                                     c.truth.way.size(), c.truth.way.back(), to_string(c.align),
                                     is_thinned ? "; plots over time and way are thinned, with the "
                                                  "smallest and largest error of each stretch kept"
                                                : "")))
      .add(unmatched(c))
      .add_place("comparison", data)
      .add(web::heading("Figures"))
      .add(web::table(table.heading, table.rows))
      .add("<div id=\"copies\"></div>\n");
  return page.text();
}

}  // namespace maploop::evaluation
