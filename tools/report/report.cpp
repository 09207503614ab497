#include "tools/report/report.h"

#include <cmath>

#include "tools/command/html_text.h"
#include "tools/evaluate/text_file.h"
#include "tools/profile/profile_page.h"
#include "tools/replay/verdict.h"
#include "tools/report/ppp_section.h"
#include "tools/report/road_section.h"
#include "tools/report/text.h"
#include "tools/report/trajectory_plots.h"
#include "tools/web/page.h"

namespace maploop::report {
namespace {

using tools::escaped;
using web::Row;

std::string opening(const tools::ReplayResult& result) {
  std::string html;
  for (const std::string& line : tools::verdict(result)) html += paragraph(line);
  if (const auto why = tools::why_empty(result)) html += paragraph("The result is empty: " + *why);
  return html;
}

std::string summary(const ReplayReport& r) {
  const vehicle::VehicleReport& v = r.result.vehicle;
  std::string text = figure(v.data_seconds, 1, " s of data in ") + figure(v.wall_seconds, 1, " s");
  text += r.result.live       ? ", live"
          : r.result.lockstep ? ", on virtual time"
                              : ", at " + figure(r.result.speed, 2, " times real time");
  if (r.result.interrupted) text += ", interrupted";
  text += "; " + figure(100.0 * v.cpu_seconds / std::max(v.wall_seconds, 1e-9), 0, " %") +
          " of one processor, " + figure(static_cast<double>(v.peak_memory) * 1e-6, 0, " MB") +
          " of memory. " + std::to_string(r.result.deadline_misses()) + " deadlines missed, " +
          std::to_string(r.result.samples_lost()) + " samples lost in rings, " +
          std::to_string(r.result.messages_unsent()) + " messages unsent.";
  if (r.result.lockstep) text += " Deadlines have no meaning on virtual time.";
  return paragraph(text);
}

std::string notes(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return paragraph("The watchdog had nothing to say at the end.");
  std::string html = "<ul>\n";
  for (const std::string& s : sentences) html += "<li>" + escaped(s) + "</li>\n";
  return html + "</ul>\n";
}

Row accuracy_row(const std::string& name, const tools::Accuracy& a) {
  const evaluation::Score& removed = a.common_rotation_removed;
  return {name,
          std::to_string(a.raw.frames),
          figure(a.raw.distance_m, 1),
          figure(a.raw.segment.percent, 3),
          figure(a.raw.segment.deg_per_m, 5),
          figure(a.raw.end_point_m, 2),
          figure(removed.segment.percent, 3),
          figure(removed.segment.deg_per_m, 5),
          figure(removed.end_point_m, 2)};
}

std::string accuracy(const tools::ReplayResult& r) {
  std::vector<Row> rows;
  const auto add = [&](const char* name, const std::optional<tools::Accuracy>& a) {
    if (a) rows.push_back(accuracy_row(name, *a));
  };
  add("stereo odometry", r.vo);
  add("LiDAR odometry", r.lidar);
  add("fused", r.fused);
  if (rows.empty()) return paragraph("There is no reference, or too little of it to score with.");
  return paragraph(
             "The left camera's poses against the reference, in segments of 100 m as KITTI's "
             "odometry benchmark measures them; on the right with one common rotation removed.") +
         web::table({"", "images", "distance, m", "%", "deg/m", "end point, m", "%", "deg/m",
                     "end point, m"},
                    rows);
}

Row navigation_row(const std::string& name, const fusion_score::Errors& e) {
  return {name,
          figure(e.distance, 1),
          figure(e.rmse, 2),
          figure(e.max, 2),
          figure(e.drift, 2),
          figure(e.percent(), 3),
          figure(e.azimuth_rms, 3),
          figure(e.nees_mean, 1),
          figure(100.0 * e.covered, 0)};
}

std::string navigation(const std::optional<fusion_score::Score>& score) {
  if (!score) return {};
  std::vector<Row> rows{navigation_row("whole drive", score->whole)};
  for (const fusion_score::OutageErrors& o : score->outages) {
    rows.push_back(navigation_row(
        "no GNSS " + figure(o.start, 1, " s + ") + figure(o.length, 1, " s"), o.errors));
  }
  return paragraph("The state as it was sent, horizontally:") +
         web::table({"", "distance, m", "RMSE, m", "max, m", "drift, m", "drift, %",
                     "azimuth RMS, deg", "NEES", "covered, %"},
                    rows);
}

std::string losses(const tools::ReplayResult& r) {
  std::vector<Row> rings, sensors, refused, faults;
  for (const vehicle::SensorReport& s : r.vehicle.sensors) {
    sensors.push_back({s.name, std::to_string(s.source.delivered), std::to_string(s.source.refused),
                       std::to_string(s.source.flawed)});
  }
  for (const RefusalCount& c : r.vehicle.health.refusals) {
    refused.push_back({c.stage + ": " + c.reason, std::to_string(c.count)});
  }
  for (const vehicle::FaultCount& f : r.faults) {
    faults.push_back({f.fault, std::to_string(f.struck)});
  }
  for (const RingHealth& ring : r.vehicle.health.rings) {
    rings.push_back({ring.name, std::to_string(ring.pushed), std::to_string(ring.popped),
                     std::to_string(ring.lost), std::to_string(ring.held),
                     std::to_string(ring.capacity)});
  }
  std::string html = web::table({"sensor", "delivered", "left out", "flawed"}, sensors);
  if (!faults.empty()) html += web::table({"fault asked for", "struck"}, faults);
  html += refused.empty() ? paragraph("The estimators used everything that they were given.")
                          : web::table({"not used", "count"}, refused);
  return html + folded("Rings: " + std::to_string(r.samples_lost()) + " lost",
                       web::table({"ring", "pushed", "popped", "lost", "held", "capacity"}, rings));
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
  std::vector<Row> rows;
  for (const RealtimeSetting& s : all) {
    rows.push_back(
        {s.name, s.asked, s.granted, std::string(to_string(s.verdict)), s.reason, s.remedy});
  }
  if (rows.empty()) return {};
  return folded("Real-time settings",
                web::table({"", "asked", "granted", "verdict", "why not", "what to do"}, rows));
}

}  // namespace

RoadMoment road_moment(const MapMatch& match) {
  RoadMoment moment{match.phase, match.on_road, {}, match.probability};
  if (match.on_road) {
    const Eigen::Vector3d place(match.matched_enu.x(), match.matched_enu.y(), 0.0);
    moment.place = LocalFrame(match.origin).to_geodetic(place);
  }
  return moment;
}

void write_report(const std::filesystem::path& file, const ReplayReport& r) {
  web::Page page("Replay of " + r.result.drive);
  page.add(opening(r.result)).add(trajectory_map(r)).add(summary(r));
  page.add("<h2>Accuracy</h2>\n" + accuracy(r.result) + navigation(r.result.navigation));
  page.add(state_plots(r));
  add_roads(page, r);
  add_ppp(page, r);
  page.add("<h2>Health</h2>\n" + notes(r.result.vehicle.health.degraded));
  page.add("<h2>What was lost or not used</h2>\n" + losses(r.result));
  const profile::Profile times =
      profile::profile_of(r.result.vehicle.deadlines, r.result.vehicle.health);
  page.add("<h2>Latencies and deadlines</h2>\n");
  profile::add_latencies(page, times);
  profile::add_processor_time(page, times);
  page.add("<h2>How it was run</h2>\n" + paragraph("maploop " + r.version) + channels(r.result) +
           settings(r.result.vehicle.health.settings) +
           folded("Configuration", "<pre>" + escaped(r.configuration) + "</pre>"));
  evaluation::write_text(file, page.text());
}

}  // namespace maploop::report
