// The tables and pictures of the fusion's experiment.
#include <algorithm>
#include <map>
#include <tuple>

#include "msgs/local_frame.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/command/median.h"
#include "tools/experiment/fusion_experiment.h"
#include "tools/experiment/table.h"
#include "tools/web/page.h"

namespace maploop::experiments {
namespace {

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// Realizations of the same thing together, in the order they came in.
template <class Key, class Value>
struct Groups {
  std::vector<Key> order;
  std::map<Key, std::vector<Value>> of;

  void add(const Key& key, const Value& value) {
    if (!of.contains(key)) order.push_back(key);
    of[key].push_back(value);
  }
};

std::vector<double> column(const std::vector<fusion_score::Errors>& errors,
                           double (*value)(const fusion_score::Errors&)) {
  std::vector<double> values;
  for (const fusion_score::Errors& e : errors) values.push_back(value(e));
  return values;
}

Row figures(const std::vector<fusion_score::Errors>& e, bool nees_at_end) {
  using E = fusion_score::Errors;
  const std::vector<double> percent = column(e, [](const E& x) { return x.percent(); });
  return {std::to_string(e.size()),
          number(mean(column(e, [](const E& x) { return x.distance; })), 0),
          number(tools::median(percent), 3),
          number(*std::max_element(percent.begin(), percent.end()), 3),
          number(tools::median(column(e, [](const E& x) { return x.drift; })), 2),
          number(tools::median(column(e, [](const E& x) { return x.rmse; })), 2),
          number(tools::median(column(e, [](const E& x) { return x.max; })), 2),
          number(tools::median(column(e, [](const E& x) { return x.azimuth_rms; })), 3),
          number(tools::median(column(e, [](const E& x) { return std::abs(x.azimuth_end); })), 3),
          number(nees_at_end ? mean(column(e, [](const E& x) { return x.nees_end; }))
                             : mean(column(e, [](const E& x) { return x.nees_mean; })),
                 1)};
}

const Row figure_names{"runs",   "m",     "% median",   "% worst",    "drift m",
                       "rmse m", "max m", "az rms deg", "az end deg", "NEES (2)"};

Table dead_reckoning(const std::vector<FusionResult>& results) {
  using Key = std::tuple<std::string, std::string, std::string, std::string, std::string>;
  Groups<Key, fusion_score::Errors> groups;
  for (const FusionResult& r : results) {
    if (!r.setup.outages.empty()) continue;
    groups.add({r.setup.sequence, r.setup.configuration, r.setup.unit(), r.setup.azimuth_aiding,
                r.setup.zero_velocity ? "yes" : "no"},
               r.score.whole);
  }
  Table table{"Dead reckoning from a known start",
              {"sequence", "configuration", "unit", "azimuth aiding", "standing still used"},
              {}};
  table.heading.insert(table.heading.end(), figure_names.begin(), figure_names.end());
  for (const Key& k : groups.order) {
    Row row{std::get<0>(k), std::get<1>(k), std::get<2>(k), std::get<3>(k), std::get<4>(k)};
    const Row f = figures(groups.of[k], false);
    row.insert(row.end(), f.begin(), f.end());
    table.rows.push_back(row);
  }
  return table;
}

// The reference itself was silent in the others.
bool scored(const fusion_score::OutageErrors& o) {
  constexpr double least = 0.97;
  return o.errors.covered > least;
}

Table outages(const std::vector<FusionResult>& results) {
  using Key = std::tuple<std::string, std::string, std::string, std::string>;
  Groups<Key, fusion_score::Errors> groups;
  std::vector<Key> pooled;
  for (const FusionResult& r : results) {
    for (const fusion_score::OutageErrors& o : r.score.outages) {
      if (!scored(o)) continue;
      const std::string length = number(o.length, 0), unit = r.setup.unit();
      groups.add({r.setup.configuration, unit, length, r.setup.sequence}, o.errors);
      groups.add({r.setup.configuration, unit, length, "pooled"}, o.errors);
    }
  }
  std::vector<Key> order = groups.order;
  std::stable_sort(order.begin(), order.end(), [](const Key& a, const Key& b) {
    const auto rank = [](const Key& k) {
      return std::tuple(std::get<0>(k), std::get<1>(k), std::stoi(std::get<2>(k)), std::get<3>(k));
    };
    return rank(a) < rank(b);
  });
  Table table{"GNSS outages; wheels 1 % wrong; error at their end less that at their begin",
              {"configuration", "unit", "length s", "sequence"},
              {}};
  table.heading.insert(table.heading.end(), figure_names.begin(), figure_names.end());
  for (const Key& k : order) {
    Row row{std::get<0>(k), std::get<1>(k), std::get<2>(k), std::get<3>(k)};
    const Row f = figures(groups.of[k], true);
    row.insert(row.end(), f.begin(), f.end());
    table.rows.push_back(row);
  }
  return table;
}

web::Line path_of(const FusionResult& r, const LocalFrame& frame) {
  web::Line line{r.setup.configuration + (r.setup.mems ? ", mems" : ""), {}, {}};
  for (const NavState& s : r.track.states()) {
    const Eigen::Vector3d p = frame.to_enu(LocalFrame(s.origin).to_geodetic(s.position_enu));
    line.x.push_back(p.x());
    line.y.push_back(p.y());
  }
  return line;
}

// The dead reckoned ways of a sequence and the reference's, seen from above.
web::Plot map_of(const std::filesystem::path& folder, const std::string& sequence,
                 const std::vector<FusionResult>& results) {
  web::Plot plot{"Sequence " + sequence + ", dead reckoning", "east, m", "north, m", {}, true};
  const vehicle::Recording recording = vehicle::open_recording(folder / sequence, {});
  LocalFrame frame;
  web::Line truth{"reference", {}, {}};
  double end = 0.0;
  for (const FusionResult& r : results) {
    if (r.setup.sequence == sequence && r.setup.outages.empty()) end = r.setup.end;
  }
  for (const ReferencePose& pose : sensors::read_rows(recording.sensors(Time::max()).reference)) {
    if (truth.x.empty()) frame = LocalFrame(pose.position);
    if (end > 0.0 && pose.stamp > recording.first_stamp + from_seconds(end)) break;
    const Eigen::Vector3d p = frame.to_enu(pose.position);
    truth.x.push_back(p.x());
    truth.y.push_back(p.y());
  }
  plot.lines.push_back(truth);
  for (const FusionResult& r : results) {
    if (r.setup.sequence == sequence && r.setup.outages.empty() && r.setup.seed == 1 &&
        r.setup.azimuth_aiding == "as named" && r.setup.zero_velocity) {
      plot.lines.push_back(path_of(r, frame));
    }
  }
  return plot;
}

}  // namespace

std::string to_text(const std::vector<FusionResult>& results) {
  return as_text(dead_reckoning(results)) + as_text(outages(results));
}

std::string to_html(const std::filesystem::path& folder, const std::vector<FusionResult>& results) {
  std::vector<web::Plot> plots;
  std::vector<std::string> shown;
  for (const FusionResult& r : results) {
    if (std::find(shown.begin(), shown.end(), r.setup.sequence) != shown.end()) continue;
    shown.push_back(r.setup.sequence);
    plots.push_back(map_of(folder, r.setup.sequence, results));
  }
  return web::Page("Fusion: reduced inertial sensors, odometry and GNSS")
      .add(as_html(dead_reckoning(results)))
      .add(as_html(outages(results)))
      .add(plots)
      .text();
}

}  // namespace maploop::experiments
