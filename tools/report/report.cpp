#include "tools/report/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/evaluate/text_file.h"
#include "tools/profile/profile.h"
#include "tools/replay/figures.h"
#include "tools/report/sections.h"
#include "tools/web/html.h"

namespace maploop::report {
namespace {

using web::folded;
using web::heading;
using web::paragraph;
using web::Row;

std::string opening(const tools::ReplayResult& result) {
  std::string html = "<section class=\"verdict\">";
  for (const std::string& line : tools::verdict(result)) html += paragraph(line);
  if (const auto why = tools::why_empty(result)) html += paragraph("The result is empty: " + *why);
  return html + "</section>\n";
}

std::string summary(const tools::ReplayResult& r) {
  const vehicle::VehicleReport& v = r.vehicle;
  const std::string pace = r.live       ? "live"
                           : r.lockstep ? "on virtual time"
                                        : fmt::format("at {:.2f} times real time", r.speed);
  return paragraph(fmt::format(
      "{:.1f} s of data in {:.1f} s, {}{}; {:.0f} % of one processor, {:.0f} MB of memory. {} "
      "deadlines missed, {} samples lost in rings, {} messages unsent.{}",
      v.data_seconds, v.wall_seconds, pace, r.interrupted ? ", interrupted" : "",
      100.0 * v.cpu_seconds / std::max(v.wall_seconds, 1e-9),
      static_cast<double>(v.peak_memory) * 1e-6, r.deadline_misses(), r.samples_lost(),
      r.messages_unsent(), r.lockstep ? " Deadlines have no meaning on virtual time." : ""));
}

std::string notes(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return paragraph("The watchdog had nothing to say at the end.");
  std::string html = "<ul>\n";
  for (const std::string& s : sentences) html += "<li>" + web::escaped(s) + "</li>\n";
  return html + "</ul>\n";
}

std::string accuracy(const tools::ReplayResult& r) {
  std::vector<Row> rows;
  const auto add = [&](const char* name, const std::optional<tools::Accuracy>& a) {
    if (a) rows.push_back(web::joined({{name}, web::cells(tools::accuracy_columns, *a)}));
  };
  add("stereo odometry", r.vo);
  add("LiDAR odometry", r.lidar);
  add("odom", r.odom);
  add("fused", r.fused);
  if (rows.empty()) return {};
  return heading("Error of the path") +
         paragraph(
             "The left camera's poses against the reference, in segments of 100 m as KITTI's "
             "odometry benchmark measures them; on the right with one common rotation removed.") +
         web::table(web::joined({{""}, web::headings(tools::accuracy_columns)}), rows);
}

std::string navigation(const std::optional<fusion_score::Score>& score) {
  if (!score) return paragraph("There is no reference, or too little of it to score with.");
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const fusion_score::Errors& e) {
    rows.push_back(web::joined({{name}, web::cells(tools::error_columns, e)}));
  };
  add("whole drive", score->whole);
  for (const fusion_score::OutageErrors& o : score->outages) {
    add(fmt::format("no GNSS {:.1f} s + {:.1f} s", o.start, o.length), o.errors);
  }
  return paragraph("The state as it was sent, horizontally:") +
         web::table(web::joined({{""}, web::headings(tools::error_columns)}), rows);
}

std::string losses(const tools::ReplayResult& r) {
  const Health& health = r.vehicle.health;
  std::string html = web::table(tools::sensor_columns, r.vehicle.sensors);
  if (!r.faults.empty()) html += web::table(tools::fault_columns, r.faults);
  html += health.refusals.empty()
              ? paragraph("The estimators used everything that they were given.")
              : web::table(tools::refusal_columns, health.refusals);
  return html + folded(fmt::format("Rings: {} lost", r.samples_lost()),
                       web::table(tools::ring_columns, health.rings));
}

std::string channels(const tools::ReplayResult& r) {
  std::vector<Row> rows;
  for (const auto& [name, channel] : r.channels) {
    rows.push_back({name, std::to_string(channel.count),
                    channel.hash.empty() ? "of this run only" : channel.hash});
  }
  return folded("Messages and their hashes: the same input gives the same ones",
                web::table({"channel", "messages", "hash"}, rows));
}

std::string settings(const std::vector<RealtimeSetting>& all) {
  if (all.empty()) return {};
  return folded("Real-time settings", web::table(tools::setting_columns, all));
}

}  // namespace

void write_report(const std::filesystem::path& file, const ReplayReport& r) {
  const tools::ReplayResult& result = r.result;
  const Health& health = result.vehicle.health;
  const Scene scene(r);
  const profile::Profile times = profile::profile_of(result.vehicle.deadlines, health);
  web::Page page("Replay of " + result.drive);
  page.add(opening(result)).add_contents().add_timeline(events(scene, times));
  page.add_overview(trajectory_map(scene)).add(summary(result));
  page.add(heading("Health") + notes(health.degraded));
  page.add(heading(error_heading) + navigation(result.navigation)).add(state_plots(scene));
  page.add(heading("Events")).add_events().add(accuracy(result));
  add_protection(page, scene);
  add_roads(page, scene);
  add_ppp(page, scene);
  add_calibration(page, scene);
  page.add(heading(loss_heading) + losses(result));
  page.add(heading(latency_heading));
  profile::add_latencies(page, times);
  profile::add_distributions(page, times);
  profile::add_processor_time(page, times);
  page.add(heading("How it was run") + paragraph("maploop " MAPLOOP_VERSION) + channels(result) +
           settings(health.settings) +
           folded("Configuration", web::preformatted(vehicle::to_toml(r.config))));
  evaluation::write_text(file, page.text());
}

}  // namespace maploop::report
