// maploop ppp: positions from GNSS files.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "ppp/filter/parameter_table.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/evaluate/text_file.h"
#include "tools/ppp/page.h"
#include "tools/ppp/run.h"

namespace maploop::tools {
namespace {

struct PppOptions {
  std::vector<std::filesystem::path> files;
  std::string mode, systems, start, end, truth, score_start;
  std::optional<vehicle::MapMode> map_mode;
  std::optional<double> mask;
  bool broadcast = false, ecef = false;
  std::filesystem::path map, config, pos, nmea, geojson, kml, residuals, html, json;
};

// "2020-06-25 01:00:00" of GPS time, or "01:00:00" of the first epoch's day.
ppp::GpsTime moment(const std::string& text, const std::string& option, ppp::GpsTime first) {
  const std::string whole =
      text.find('-') == std::string::npos ? format_gps_time(first).substr(0, 11) + text : text;
  try {
    // GPS time's calendar has no leap seconds, as the parser's.
    return ppp::GpsTime(parse_time(whole) - Time(ppp::gps_epoch_day));
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(option + ": '" + text +
                             "' is neither YYYY-MM-DD HH:MM:SS nor HH:MM:SS of GPS time");
  }
}

// What the command line does not say is the configuration's.
vehicle::VehicleConfig config_of(const PppOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  vehicle::PppConfig& p = config.ppp;
  if (!options.mode.empty()) {
    p.filter.motion = options.mode == "static" ? ppp::Motion::fixed : ppp::Motion::kinematic;
  }
  if (!options.systems.empty()) p.filter.systems = options.systems;
  if (options.mask) p.filter.elevation_mask = *options.mask;
  validate_parameters(p.filter);
  p.broadcast |= options.broadcast;
  set_map(config.map, options.map, options.map_mode);
  if (config.map.mode == vehicle::MapMode::hard_reset) {
    throw std::runtime_error("[map] mode = \"hard-reset\" is none of PPP: none, loose or tight");
  }
  return config;
}

std::optional<gnss::MapOptions> map_of(const vehicle::VehicleConfig& config,
                                       const vehicle::RoadMap* map) {
  if (map == nullptr) return std::nullopt;
  return gnss::MapOptions{&map->network, &map->rules, config.mapmatch, config.feedback,
                          config.map.mode == vehicle::MapMode::tight};
}

gnss::RunOptions run_options(const PppOptions& options, const vehicle::PppConfig& config,
                             const std::optional<gnss::MapOptions>& map, ppp::GpsTime first) {
  gnss::RunOptions run;
  run.parameters = config.filter;
  run.broadcast = config.broadcast;
  run.map = map;
  if (!options.start.empty()) run.start = moment(options.start, "--start", first);
  if (!options.end.empty()) run.end = moment(options.end, "--end", first);
  return run;
}

nlohmann::json to_json(const gnss::Accuracy& a, std::optional<double> below) {
  return {
      {"epochs", a.with_truth},
      {"solved", a.solved},
      {"coverage", a.coverage()},
      {"horizontal_rmse_m", a.horizontal_rmse},
      {"horizontal_95_m", a.horizontal_95},
      {"across_rmse_m", a.across_rmse},
      {"up_rmse_m", a.up_rmse},
      {"mean_enu_m", {a.mean_enu.x(), a.mean_enu.y(), a.mean_enu.z()}},
      {"horizontal_rmse_without_mean_m", a.horizontal_rmse_without_mean},
      {"last_3d_m", a.three_d_last},
      {"nees", a.nees},
      {"seconds_to_stay_below_0.1_m", below ? nlohmann::json(*below) : nlohmann::json(nullptr)}};
}

nlohmann::json to_json(const ppp::MapAidedFilter& filter, std::size_t matched) {
  nlohmann::json feedback;
  for (std::size_t i = 0; i < ppp::map_use_count; ++i) {
    const auto use = static_cast<ppp::MapUse>(i);
    feedback[std::string(to_string(use))] = filter.count(use);
  }
  return {{"matched", matched},
          {"feedback", std::move(feedback)},
          {"restorations", filter.restorations()}};
}

std::string map_line(const ppp::MapAidedFilter& filter, std::size_t matched, std::size_t epochs) {
  std::string line = fmt::format("{} of {} epochs on a road of the map; fed back: {} used", matched,
                                 epochs, filter.count(ppp::MapUse::used));
  for (std::size_t i = 1; i < ppp::map_use_count; ++i) {
    const auto use = static_cast<ppp::MapUse>(i);
    if (use != ppp::MapUse::nothing_fed_back && filter.count(use) > 0)
      line += fmt::format(", {} {}", filter.count(use), to_string(use));
  }
  return line + fmt::format("; forgotten as a wrong road's: {}", filter.restorations());
}

// What a run gives to its texts and files.
struct PppResult {
  gnss::Solutions solutions;
  std::size_t solved = 0, matched = 0;
  std::unique_ptr<gnss::Truth> truth;
  std::unique_ptr<gnss::Score> score, without_map;  // where there is a truth; the second: and a map
  std::optional<ppp::GpsTime> scored_from;
};

PppResult process(gnss::PppRun& run, const PppOptions& options, double integrity_risk, bool on_map,
                  ppp::GpsTime first) {
  PppResult r;
  if (!options.truth.empty()) {
    r.truth = std::make_unique<gnss::Truth>(options.truth, first);
    r.score = std::make_unique<gnss::Score>(*r.truth, integrity_risk);
    if (on_map) r.without_map = std::make_unique<gnss::Score>(*r.truth, integrity_risk);
  }
  if (!options.score_start.empty())
    r.scored_from = moment(options.score_start, "--score-start", first);
  run.process([&](const ppp::PppSolution& s) {
    if (!s.message.empty()) std::cerr << format_gps_time(s.time) << ": " << s.message << '\n';
    r.solved += s.status != PppStatus::none;
    if (r.score) r.score->add(s);
    if (r.without_map) r.without_map->add(run.filter().map_free());
    r.matched += run.map_step().way_id.has_value();
    r.solutions.push_back(s);
  });
  if (r.solutions.empty()) throw std::runtime_error("no epoch between --start and --end");
  return r;
}

void append_score(std::vector<std::string>& lines, const PppResult& r, double integrity_risk) {
  lines.push_back("against the truth: " + to_text(r.score->accuracy(r.scored_from)));
  lines.push_back(
      fmt::format("{} of {} errors along, across and up are beyond their protection level "
                  "(integrity risk {:g})",
                  r.score->misleading(), 3 * r.score->errors().size(), integrity_risk));
  if (r.without_map)
    lines.push_back("the same without the map: " + to_text(r.without_map->accuracy(r.scored_from)));
  const auto below = r.score->time_to_stay_below(0.1);
  lines.push_back(below ? fmt::format("3-D error stays below 0.1 m after {:.1f} min", *below / 60)
                        : "3-D error does not stay below 0.1 m");
}

std::vector<std::string> summary_of(const gnss::PppRun& run, const PppResult& r,
                                    const vehicle::PppConfig& config, bool on_map,
                                    const ppp::GnssFiles& files) {
  const std::size_t epochs = r.solutions.size();
  std::vector<std::string> lines{
      fmt::format("{} orbits and clocks, {}, {}, systems {}",
                  run.setup().precise() ? "precise" : "broadcast",
                  run.setup().one_frequency() ? "one frequency" : "two frequencies",
                  to_string(config.filter.motion), config.filter.systems),
      fmt::format("{} of {} epochs have a position ({:.1f} %); filter {:.3f} s, {:.3f} ms an epoch",
                  r.solved, epochs,
                  100.0 * static_cast<double>(r.solved) / static_cast<double>(epochs),
                  run.seconds(), 1e3 * run.seconds() / static_cast<double>(epochs))};
  if (run.setup().never_converges())
    lines.push_back(
        "on one frequency with broadcast orbits the position cannot converge to 0.1 m: metres "
        "remain");
  if (r.score) append_score(lines, r, config.integrity_risk);
  if (on_map) lines.push_back(map_line(run.filter(), r.matched, epochs));
  for (const auto& line : run.setup().missing_models()) lines.push_back(line);
  for (const auto& line : run.missing_products()) lines.push_back(line);
  for (const auto& o : files.observations) {
    if (o.refused > 0)
      lines.push_back(
          fmt::format("{}: {} refused, first: {}", o.file, o.refused, o.refusals.front()));
  }
  if (leap_seconds(r.solutions.back().time).out_of_date)
    lines.push_back("the table of leap seconds ends before these data: UTC may be a second off");
  return lines;
}

nlohmann::json to_json(const gnss::PppRun& run, const PppResult& r, bool on_map) {
  nlohmann::json json = {{"epochs", r.solutions.size()},
                         {"solved", r.solved},
                         {"filter_seconds", run.seconds()},
                         {"missing_products", run.missing_products()},
                         {"lacks", run.setup().missing_models()}};
  const auto scored = [&](const gnss::Score& score) {
    return to_json(score.accuracy(r.scored_from), score.time_to_stay_below(0.1));
  };
  if (r.score) json["truth"] = scored(*r.score);
  if (on_map) json["map"] = to_json(run.filter(), r.matched);
  if (r.without_map) json["map"]["truth_without_map"] = scored(*r.without_map);
  return json;
}

void write_files(const PppOptions& options, const gnss::PppRun& run, const PppResult& r,
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
    return gnss::to_page("PPP of " + std::filesystem::path(name).filename().string(), summary,
                         r.solutions, r.score.get(), r.without_map.get(), integrity_risk);
  });
  if (!options.json.empty()) write_json_file(options.json, to_json(run, r, on_map));
}

int positions(const PppOptions& options) {
  const vehicle::VehicleConfig vehicle_config = config_of(options);
  const vehicle::PppConfig& config = vehicle_config.ppp;
  const auto map = vehicle::load_road_map(vehicle_config.map);
  ppp::GnssFiles files;
  for (const auto& file : options.files) ppp::read_into(file, files);
  for (const auto& product : config.products) ppp::read_products(product, files);
  const ppp::GpsTime first = files.observations.empty() || files.observations[0].epochs.empty()
                                 ? ppp::GpsTime{}
                                 : files.observations[0].epochs[0].time;
  gnss::PppRun run(files, run_options(options, config, map_of(vehicle_config, map.get()), first));
  const bool on_map = map != nullptr;
  const PppResult result = process(run, options, config.integrity_risk, on_map, first);
  const std::vector<std::string> summary = summary_of(run, result, config, on_map, files);
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
  sub->add_option("FILES", options->files, "The files, told apart by content")->required();
  sub->add_option("--mode", options->mode,
                  "static or kinematic (with a vehicle's dynamics; the default)")
      ->check(CLI::IsMember({"static", "kinematic"}));
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
  sub->add_option("--start", options->start, "First epoch: [YYYY-MM-DD ]HH:MM:SS of GPS time");
  sub->add_option("--end", options->end, "Last epoch, the same way");
  sub->add_option("--map", options->map,
                  "OpenStreetMap file, or a network file of `maploop map build`")
      ->check(existing_file());
  add_choice(sub, "--map-mode", options->map_mode,
             "none; loose, the default where there is a map: matched, and nothing fed back; "
             "tight: the road corrects the filter");
  sub->add_flag("--broadcast", options->broadcast, "Broadcast orbits even where SP3 is given");
  sub->add_option("--truth", options->truth,
                  "X,Y,Z in metres, latitude,longitude,height, or a file: RTKLIB's .pos in XYZ, or "
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
  sub->add_option("--html", options->html, "Write a page with plots")->check(writable_file());
  sub->add_option("--json", options->json, "Write the figures as JSON")->check(writable_file());
  sub->footer(
      "Examples:\n"
      "    maploop ppp drive.21o.gz brdc.21n.gz --html drive.html  # broadcast orbits\n"
      "    maploop ppp drive.21o.gz *.SP3.gz *.CLK.gz *.atx.gz --pos out.pos");
  sub->callback([options, &command] { command = [options] { return positions(*options); }; });
}

}  // namespace maploop::tools
