// maploop experiment fusion: the filter's configurations on the sequences of KITTI's odometry
// benchmark, in dead reckoning from a known start and in GNSS outages.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "msgs/local_frame.h"
#include "sensors/replay/odometry_sequence.h"
#include "tools/command/median.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/text_file.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/sequence_run.h"
#include "tools/experiment/table.h"
#include "tools/web/page.h"

namespace maploop::tools {
namespace {

using namespace experiments;

// One run of one sequence.
struct FusionCase : SequenceCase {
  std::string azimuth_aiding = "as named";  // or "none", "chained"
  bool zero_velocity = true;
};

struct FusionResult {
  FusionCase setup;
  fusion_score::Score score;
  web::Line way, reference;  // m east and north of the reference's start
};

// One outage after another, as long as the first minute (or what a short drive has) has taught the
// filter its sensors.
std::string regular_outages(double duration, double length) {
  constexpr double settled = 60.0, least = 45.0;
  if (duration < settled + length + 1.0) {
    const double start = duration - length - 1.0;
    return start < least ? "" : std::to_string(start) + ":" + std::to_string(length);
  }
  std::string text;
  for (double start = settled; start + length < duration; start += length + settled) {
    text += (text.empty() ? "" : ",") + std::to_string(start) + ":" + std::to_string(length);
  }
  return text;
}

void add_dead_reckoning(const Sequence& s, int seeds, std::vector<FusionCase>& cases) {
  std::vector<std::string> configurations{"RISS"};
  if (s.tracks_end > 0.0) configurations = {"VO-RI", "RISS", "RISS-VO"};
  for (const std::string& configuration : configurations) {
    FusionCase c;
    c.sequence = s.name;
    c.configuration = configuration;
    c.end = s.tracks_end;
    cases.push_back(c);
    if (configuration == "VO-RI") {
      for (const char* aiding : {"none", "chained"}) {
        c.azimuth_aiding = aiding;
        cases.push_back(c);
      }
      c.azimuth_aiding = "as named";
    }
    c.zero_velocity = false;
    cases.push_back(c);
    c.zero_velocity = true;
    c.mems = true;
    for (c.seed = 1; c.seed <= seeds; ++c.seed) cases.push_back(c);
  }
}

void add_outages(const Sequence& s, int seeds, std::vector<FusionCase>& cases) {
  for (const double length : {30.0, 60.0, 120.0}) {
    for (const bool mems : {false, true}) {
      for (const char* configuration : {"GNSS+RISS", "GNSS+RISS-VO", "GNSS+VO-RI"}) {
        const bool with_tracks = std::string(configuration) != "GNSS+RISS";
        FusionCase c;
        c.sequence = s.name;
        c.configuration = configuration;
        c.mems = mems;
        c.speed_scale = 0.01;
        c.end = with_tracks ? s.tracks_end : 0.0;
        c.outages = regular_outages(with_tracks ? s.tracks_end : s.duration, length);
        if (c.outages.empty()) continue;
        for (c.seed = 1; c.seed <= seeds; ++c.seed) cases.push_back(c);
      }
    }
  }
}

FusionResult run(const std::filesystem::path& folder, const FusionCase& setup,
                 const vehicle::VehicleConfig& given) {
  vehicle::VehicleConfig config = config_of(given, setup);
  if (setup.azimuth_aiding == "none") config.fusion.use_odometry_azimuth = false;
  if (setup.azimuth_aiding == "chained") config.fusion.chain_odometry_azimuth = true;
  config.fusion.use_zero_velocity = setup.zero_velocity;
  const SequenceRun run = run_sequence(folder, setup, config);
  FusionResult result{setup,
                      run.score,
                      {setup.configuration + (setup.mems ? ", mems" : ""), {}, {}},
                      {"reference", {}, {}}};
  const LocalFrame frame(run.reference.front().position);
  const auto add = [&](const Geodetic& place, web::Line& line) {
    const Eigen::Vector3d p = frame.to_enu(place);
    line.x.push_back(p.x());
    line.y.push_back(p.y());
  };
  for (const ReferencePose& pose : run.reference) {
    if (setup.end > 0.0 && pose.stamp > run.recording.first_stamp + from_seconds(setup.end)) break;
    add(pose.position, result.reference);
  }
  for (const NavState& s : run.track.states())
    add(LocalFrame(s.origin).to_geodetic(s.position_enu), result.way);
  return result;
}

// Returns every case that there is data for in `folder` (kitti_odometry), with `seeds` realizations
// of what is random.
std::vector<FusionCase> fusion_cases(const std::filesystem::path& folder, int seeds) {
  std::vector<FusionCase> cases;
  for (const Sequence& s : sequences) {
    if (!sensors::OdometrySequence::is_named(folder / s.name)) continue;
    add_dead_reckoning(s, seeds, cases);
    add_outages(s, seeds, cases);
  }
  if (cases.empty()) {
    throw std::runtime_error("no sequence in '" + folder.string() +
                             "': it needs oxts/00.csv and the like");
  }
  return cases;
}

using fusion_score::Errors;
using Numbers = std::vector<double>;

double mean(Numbers values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double worst(Numbers values) {
  return *std::max_element(values.begin(), values.end());
}

// A column: what of each run's errors, and how the runs' are taken together.
struct Figure {
  const char* name;
  int digits;
  double (*of)(const Errors&);
  double (*together)(Numbers) = tools::median;
};

const std::vector<Figure> figures{
    {"m", 0, [](const Errors& e) { return e.distance; }, mean},
    {"% median", 3, [](const Errors& e) { return e.percent(); }},
    {"% worst", 3, [](const Errors& e) { return e.percent(); }, worst},
    {"drift m", 2, [](const Errors& e) { return e.drift; }},
    {"rmse m", 2, [](const Errors& e) { return e.rmse; }},
    {"max m", 2, [](const Errors& e) { return e.max; }},
    {"az rms deg", 3, [](const Errors& e) { return e.azimuth_rms; }},
    {"az end deg", 3, [](const Errors& e) { return std::abs(e.azimuth_end); }}};

// One row for each group of runs: its cells, the number of runs and the figures.
Table table_of(const std::string& title, Row heading, const Groups<std::vector<Errors>>& groups,
               double (*nees)(const Errors&)) {
  std::vector<Figure> columns = figures;
  columns.push_back({"NEES (2)", 1, nees, mean});
  heading.emplace_back("runs");
  for (const Figure& figure : columns) heading.emplace_back(figure.name);
  Table table{title, heading, {}};
  for (const auto& [cells, runs] : groups) {
    Row& row = table.rows.emplace_back(cells);
    row.push_back(std::to_string(runs.size()));
    for (const Figure& figure : columns) {
      Numbers values(runs.size());
      std::transform(runs.begin(), runs.end(), values.begin(), figure.of);
      row.push_back(number(figure.together(std::move(values)), figure.digits));
    }
  }
  return table;
}

Table dead_reckoning(const std::vector<FusionResult>& results) {
  Groups<std::vector<Errors>> groups;
  for (const FusionResult& r : results)
    if (r.setup.outages.empty())
      groups[{r.setup.sequence, r.setup.configuration, r.setup.unit(), r.setup.azimuth_aiding,
              r.setup.zero_velocity ? "yes" : "no"}]
          .push_back(r.score.whole);
  return table_of("Dead reckoning from a known start",
                  {"sequence", "configuration", "unit", "azimuth aiding", "standing still used"},
                  groups, [](const Errors& e) { return e.nees_mean; });
}

Table outages(const std::vector<FusionResult>& results) {
  constexpr double least_covered = 0.97;  // in the others the reference itself was silent
  Groups<std::vector<Errors>> groups;
  for (const FusionResult& r : results)
    for (const fusion_score::OutageErrors& o : r.score.outages)
      for (const std::string& sequence : {r.setup.sequence, std::string("pooled")})
        if (o.errors.covered > least_covered)
          groups[{r.setup.configuration, r.setup.unit(), number(o.length, 0), sequence}].push_back(
              o.errors);
  Table table =
      table_of("GNSS outages; wheels 1 % wrong; error at their end less that at their begin",
               {"configuration", "unit", "length s", "sequence"}, groups,
               [](const Errors& e) { return e.nees_end; });
  std::stable_sort(table.rows.begin(), table.rows.end(), [](const Row& a, const Row& b) {
    const auto rank = [](const Row& r) { return std::tuple(r[0], r[1], std::stoi(r[2]), r[3]); };
    return rank(a) < rank(b);
  });
  return table;
}

std::string to_html(const std::vector<FusionResult>& results) {
  // The dead reckoned ways of each sequence and the reference's, seen from above.
  Groups<std::vector<web::Line>> ways;
  for (const FusionResult& r : results) {
    const FusionCase& c = r.setup;
    if (!c.outages.empty() || c.seed != 1 || c.azimuth_aiding != "as named" || !c.zero_velocity)
      continue;
    std::vector<web::Line>& lines = ways[{c.sequence}];
    if (lines.empty()) lines.push_back(r.reference);
    lines.push_back(r.way);
  }
  std::vector<web::Plot> plots;
  for (const auto& [sequence, lines] : ways)
    plots.push_back(
        {"Sequence " + sequence[0] + ", dead reckoning", "east, m", "north, m", lines, true});
  return web::Page("Fusion: reduced inertial sensors, odometry and GNSS")
      .add(as_html(dead_reckoning(results)))
      .add(as_html(outages(results)))
      .add(plots)
      .text();
}

struct FusionOptions {
  std::filesystem::path folder, config, html;
  int seeds = 3;
};

int compare_fusion(const FusionOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  const auto cases = fusion_cases(options.folder, options.seeds);
  const auto results = run_all(
      cases, [](const FusionCase& c) { return "sequence " + c.sequence + ", " + c.configuration; },
      [&](const FusionCase& c) { return run(options.folder, c, config); });
  std::cout << as_text(dead_reckoning(results)) << as_text(outages(results));
  if (!options.html.empty()) evaluation::write_text(options.html, to_html(results));
  return 0;
}

}  // namespace

void add_fusion_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<FusionOptions>();
  CLI::App* sub = experiment.add_subcommand("fusion",
                                            "Configurations of the filter on KITTI's odometry "
                                            "sequences: dead reckoning and GNSS outages");
  sub->add_option("FOLDER", options->folder, "Folder kitti_odometry, with oxts, poses, tracks")
      ->required()
      ->check(existing_folder());
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  sub->add_option("--seeds", options->seeds, "Realizations of what is random")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_option("--html", options->html, "Write a page with tables and pictures to this file")
      ->check(writable_file());
  sub->callback([options, &command] { command = [options] { return compare_fusion(*options); }; });
}

}  // namespace maploop::tools
