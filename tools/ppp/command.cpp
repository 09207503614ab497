// maploop ppp: positions from GNSS files.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "ppp/filter/parameter_table.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/text_lines.h"
#include "tools/ppp/chosen_times.h"
#include "tools/ppp/epoch_messages.h"
#include "tools/ppp/page.h"
#include "tools/ppp/run.h"
#include "tools/ppp/summary.h"
#include "tools/replay/wrong_road_map.h"

namespace maploop::tools {
namespace {

struct PppOptions {
  std::vector<std::filesystem::path> files;
  std::string mode, systems, start, end, truth, score_start, gnss_outage;
  std::optional<gnss::Direction> direction;
  std::optional<vehicle::MapMode> map_mode;
  std::optional<match::MapFault> map_fault;
  std::optional<double> mask;
  bool broadcast = false, ecef = false;
  std::vector<std::string> settings;
  std::vector<std::filesystem::path> compared;
  std::filesystem::path map, config, pos, nmea, geojson, kml, residuals, html, json, heights;
};

// What the command line does not say is the configuration's.
vehicle::VehicleConfig config_of(const PppOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config, options.settings);
  vehicle::PppConfig& p = config.ppp;
  if (!options.mode.empty()) {
    p.filter.motion = options.mode == "static" ? ppp::Motion::fixed : ppp::Motion::kinematic;
  }
  if (!options.systems.empty()) p.filter.systems = options.systems;
  if (options.mask) p.filter.elevation_mask = *options.mask;
  validate_parameters(p.filter);
  p.broadcast |= options.broadcast;
  if (!options.heights.empty()) p.heights = options.heights.string();
  set_map(config.map, options.map, options.map_mode);
  if (config.map.mode == vehicle::MapMode::hard_reset) {
    throw std::runtime_error(
        "[map] mode = \"hard-reset\" is not for PPP: use none, loose or tight");
  }
  return config;
}

std::optional<gnss::MapOptions> map_of(const vehicle::VehicleConfig& config,
                                       std::shared_ptr<const vehicle::RoadMap> map) {
  if (map == nullptr) return std::nullopt;
  return gnss::MapOptions{std::move(map), config.mapmatch, config.feedback,
                          config.map.mode == vehicle::MapMode::tight};
}

gnss::RunOptions run_options(const PppOptions& options, const vehicle::PppConfig& config,
                             const std::optional<gnss::MapOptions>& map, ppp::GpsTime first,
                             ppp::GpsTime last) {
  gnss::RunOptions run;
  static_cast<ppp::SetupOptions&>(run) = vehicle::setup_options(config);
  run.map = map;
  run.direction = options.direction.value_or(gnss::Direction::forward);
  if (map && run.direction != gnss::Direction::forward) {
    throw std::runtime_error(
        "with a map the filter runs forward only: leave out --direction, or --map and [map] file");
  }
  if (!options.start.empty()) run.start = gnss::beginning(options.start, "--start", first, last);
  if (!options.end.empty())
    run.end = gnss::ending(options.end, "--end", first, run.start.value_or(first), last);
  if (options.gnss_outage.empty()) return run;
  constexpr std::int64_t seed = 1;
  for (const auto& o :
       vehicle::parse_outages(options.gnss_outage, Time{}, Time{} + (last - first), seed)) {
    const ppp::GpsTime end = o.end == Time::max() ? ppp::GpsTime::max() : first + (o.end - Time{});
    run.outages.emplace_back(first + (o.begin - Time{}), end);
  }
  return run;
}

// Returns the solutions of the current epoch that a run gives beside its own, with their names.
std::vector<std::pair<const char*, const ppp::PppSolution*>> by_products(const gnss::PppRun& run,
                                                                         bool on_map) {
  if (run.direction() == gnss::Direction::smoothed) {
    return {{"forward", &run.both_ways()[0]}, {"backward", &run.both_ways()[1]}};
  }
  if (on_map) return {{"without the map", &run.filter().map_free()}};
  return {};
}

gnss::PppResult process(gnss::PppRun& run, const PppOptions& options, double integrity_risk,
                        bool on_map, ppp::GpsTime first) {
  gnss::PppResult r;
  std::vector<gnss::OtherSolution> compared;  // read before the run, which a wrong file would waste
  compared.reserve(options.compared.size());
  for (const auto& file : options.compared) compared.push_back(gnss::read_solution(file));
  for (const auto& [name, solution] : by_products(run, on_map)) r.others.push_back({name});
  if (!options.truth.empty()) {
    r.truth = std::make_unique<gnss::Truth>(options.truth, first);
    r.score = std::make_unique<gnss::Score>(*r.truth, integrity_risk);
    if (on_map) r.without_map = std::make_unique<gnss::Score>(*r.truth, integrity_risk);
  }
  if (!options.score_start.empty()) {
    r.scored_from = gnss::beginning(options.score_start, "--score-start", first,
                                    run.setup().observations().epochs.back().time);
  }
  if (on_map && r.truth)
    r.comparison = std::make_unique<gnss::MapComparison>(*r.truth, r.scored_from);
  gnss::EpochMessages messages;
  Progress progress("epochs");
  const auto epochs = static_cast<double>(run.epoch_count());
  run.process([&](const ppp::PppSolution& s) {
    progress.at(static_cast<double>(r.solutions.size()), epochs);
    if (!s.message.empty()) messages.add(s);
    r.solved += s.status != PppStatus::none;
    r.bridged += s.bridged;
    if (r.score) r.score->add(s);
    if (r.without_map) r.without_map->add(run.filter().map_free());
    if (r.comparison) r.comparison->add(s, run.filter().map_free());
    std::size_t other = 0;
    for (const auto& [name, solution] : by_products(run, on_map)) r.others[other++].add(*solution);
    r.matched += run.map_step().way_id.has_value();
    r.solutions.push_back(s);
  });
  messages.write(std::cerr);
  if (r.solutions.empty()) {
    throw std::runtime_error(
        "no epoch is left between --start and --end, and outside --gnss-outage");
  }
  for (gnss::OtherSolution& other : compared) {
    const bool compares =
        std::any_of(r.solutions.begin(), r.solutions.end(),
                    [&](const ppp::PppSolution& s) { return other.at(s.time).has_value(); });
    if (!compares) {
      std::cerr << "maploop: '" << other.name
                << "' has no position at the time of an epoch, and is not compared\n";
    }
    r.others.push_back(std::move(other));
  }
  return r;
}

void write_files(const PppOptions& options, const gnss::PppRun& run, const gnss::PppResult& r,
                 const std::vector<std::string>& summary, double integrity_risk, bool on_map) {
  const auto write = [](const std::filesystem::path& path, auto&& content) {
    if (!path.empty()) evaluation::write_text(path, content());
  };
  const std::string name = run.setup().observations().file;
  write(options.pos, [&] { return gnss::to_pos(r.solutions, options.ecef, name); });
  write(options.nmea, [&] { return gnss::to_nmea(r.solutions); });
  write(options.geojson, [&] { return gnss::to_geojson(r.solutions); });
  write(options.kml, [&] { return gnss::to_kml(r.solutions); });
  write(options.residuals, [&] { return gnss::to_residual_csv(r.solutions); });
  write(options.html, [&] {
    return gnss::to_page("PPP of " + std::filesystem::path(name).filename().string(), summary, r,
                         integrity_risk);
  });
  if (!options.json.empty()) write_json_file(options.json, gnss::to_json(run, r, on_map));
}

// Reads a file, or those files of a folder whose kind is known.
void read(const std::filesystem::path& path, ppp::GnssFiles& files) {
  if (!std::filesystem::is_directory(path)) {
    if (is_regular_file(path) && file_size(path) == 0) {
      std::cerr << "maploop: " << path.string() << ": is empty, and is passed over\n";
    } else {
      ppp::read_into(path, files);
    }
    return;
  }
  bool any = false;
  for (const std::filesystem::path& file : ppp::files_in(path)) {
    if (ppp::kind_of_file(file) == ppp::FileKind::unknown) continue;
    ppp::read_into(file, files);
    any = true;
  }
  if (!any) {
    throw std::runtime_error("the folder '" + path.string() +
                             "' has no GNSS files: observations and their products are needed");
  }
}

int positions(const PppOptions& options) {
  const vehicle::VehicleConfig vehicle_config = config_of(options);
  const vehicle::PppConfig& config = vehicle_config.ppp;
  const auto map = load_road_map(vehicle_config.map, options.map_fault, {});
  ppp::GnssFiles files;
  for (const auto& file : options.files) read(file, files);
  for (const auto& product : config.products) ppp::read_products(product, files);
  const bool any = !files.observations.empty() && !files.observations[0].epochs.empty();
  const ppp::GpsTime first = any ? files.observations[0].epochs.front().time : ppp::GpsTime{};
  const ppp::GpsTime last = any ? files.observations[0].epochs.back().time : first;
  gnss::PppRun run(files, run_options(options, config, map_of(vehicle_config, map), first, last));
  const bool on_map = map != nullptr;
  const gnss::PppResult result = process(run, options, config.integrity_risk, on_map, first);
  const std::vector<std::string> summary =
      gnss::summary_lines(run, result, config.integrity_risk, on_map, files);
  for (const auto& line : summary) std::cout << line << '\n';
  write_files(options, run, result, summary, config.integrity_risk, on_map);
  return result.solved > 0 ? 0 : 1;
}

}  // namespace

void add_ppp(CLI::App& app, Command& command) {
  auto options = std::make_shared<PppOptions>();
  CLI::App* sub = app.add_subcommand(
      "ppp",
      "Precise point positioning: one observation file and its products (navigation, SP3, clocks, "
      "ANTEX, biases, ERP, BLQ), in any order, plain or .gz");
  sub->add_option("FILES", options->files, "The files, told apart by content, or folders of them")
      ->required();
  sub->add_option("--mode", options->mode,
                  "static or kinematic (with a vehicle's dynamics; the default)")
      ->check(CLI::IsMember({"static", "kinematic"}));
  add_choice(sub, "--direction", options->direction,
             "The order in which epochs are taken: forward, as live (the default); backward; or "
             "smoothed, both ways combined, the most accurate for a recording");
  sub->add_option("--systems", options->systems, "Letters of G R E C J S I; GREC without it")
      ->check([](const std::string& text) {
        return text.find_first_not_of("GRECJSI") == std::string::npos && !text.empty()
                   ? std::string{}
                   : "'" + text + "' has other letters than G R E C J S I";
      });
  sub->add_option("--mask", options->mask, "Lowest elevation in degrees; 7 without it")
      ->check(number_in(1.0, 60.0));
  sub->add_option(
         "--config", options->config,
         "TOML file whose [ppp], [map], [mapmatch] and [feedback] set what these options do not")
      ->check(existing_file());
  add_settings(sub, options->settings);
  sub->add_option(
      "--start", options->start,
      "First epoch: [YYYY-MM-DD ]HH:MM:SS of GPS time, or seconds since the first in the files");
  sub->add_option("--end", options->end, "Last epoch, the same way");
  sub->add_option("--gnss-outage", options->gnss_outage,
                  "Leave out epochs, as maploop replay does: START:LENGTH[,...] in seconds")
      ->check(vehicle::check_outages, "OUTAGES");
  sub->add_option("--map", options->map,
                  "OpenStreetMap file, or network file or tiled map of `maploop map build`")
      ->check(existing_file());
  add_choice(sub, "--map-mode", options->map_mode,
             "none; loose, the default where there is a map: matched, and nothing fed back; "
             "tight: the road corrects the filter",
             {"none", "loose", "tight"});
  add_choice(sub, "--map-fault", options->map_fault,
             "A map that is wrong, as of maploop replay; there are no labels of the roads driven");
  sub->add_option("--heights", options->heights,
                  "The height of the ground: a tile of SRTM (.hgt, .hgt.gz, .hgt.zip), or a folder "
                  "of them")
      ->check(CLI::ExistingPath);
  sub->add_flag("--broadcast", options->broadcast, "Broadcast orbits even where SP3 is given");
  sub->add_option("--truth", options->truth,
                  "X,Y,Z in metres, latitude,longitude,height, or a file: RTKLIB's .pos, or "
                  "rows 'index,GPS second,X,Y,Z'");
  sub->add_option("--score-start", options->score_start,
                  "Accuracy is that of the epochs from this one on, the same way as --start; "
                  "convergence and protection levels are of all")
      ->needs("--truth");
  sub->add_option("--pos", options->pos, "Write RTKLIB's .pos")->check(writable_file());
  sub->add_flag("--ecef", options->ecef, "XYZ in --pos");
  sub->add_option("--nmea", options->nmea, "Write NMEA sentences GGA, RMC, GST")
      ->check(writable_file());
  sub->add_option("--geojson", options->geojson, "Write the way as GeoJSON")
      ->check(writable_file());
  sub->add_option("--kml", options->kml, "Write the way as KML")->check(writable_file());
  sub->add_option("--csv", options->residuals, "Write residuals, a row a satellite and epoch")
      ->check(writable_file());
  auto* html =
      sub->add_option("--html", options->html, "Write a page with plots")->check(writable_file());
  sub->add_option("--compare", options->compared,
                  "Another solution of the same epochs, RTKLIB's .pos, which the page subtracts")
      ->needs(html)
      ->check(existing_file());
  sub->add_option("--json", options->json, "Write the figures as JSON")->check(writable_file());
  sub->callback([options, &command] { command = [options] { return positions(*options); }; });
}

}  // namespace maploop::tools
