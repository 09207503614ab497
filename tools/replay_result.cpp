#include "tools/replay_result.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include "tools/json_output.h"
#include "tools/match/score_output.h"
#include "tools/verdict.h"

namespace maploop::tools {
namespace {

using nlohmann::json;

[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

// A dash where the drive is too short for segments.
void append_figure(std::string& text, int width, int precision, double value) {
  if (std::isnan(value)) {
    append(text, "%*s", width, "-");
  } else {
    append(text, "%*.*f", width, precision, value);
  }
}

void append_accuracy(std::string& text, const char* name, const std::optional<Accuracy>& accuracy) {
  if (!accuracy) {
    append(text, "  %-8s too few poses to score\n", name);
    return;
  }
  const evaluation::Score& raw = accuracy->raw;
  const evaluation::Score& removed = accuracy->common_rotation_removed;
  append(text, "  %-8s %6d %9.1f %8.2f", name, raw.frames, raw.distance_m, raw.end_point_m);
  append_figure(text, 7, 2, raw.end_point_percent);
  append_figure(text, 9, 3, raw.segment.percent);
  append_figure(text, 10, 5, raw.segment.deg_per_m);
  append_figure(text, 13, 3, removed.segment.percent);
  append_figure(text, 10, 5, removed.segment.deg_per_m);
  append_figure(text, 9, 2, removed.end_point_m);
  text += '\n';
}

void append_ppp(std::string& text, const PppEpochs& e) {
  append(
      text,
      "\nPrecise point positioning: %zu epochs converged, %zu converging, %zu without a position",
      e.of(PppStatus::converged), e.of(PppStatus::converging), e.of(PppStatus::none));
  if (e.converged_after >= 0.0) append(text, "; converged after %.0f s", e.converged_after);
  if (e.never_converges)
    text += "\n  (on one frequency with broadcast orbits it cannot converge to 0.1 m)";
  text += '\n';
}

void append_latency(std::string& text, const LatencySummary& s) {
  append(text, "  %-22s %7llu %9.3f %9.3f %9.3f %9.3f", s.name.c_str(),
         static_cast<unsigned long long>(s.count), to_milliseconds(s.p50), to_milliseconds(s.p90),
         to_milliseconds(s.p99), to_milliseconds(s.max));
  if (s.deadline > Duration::zero()) {
    append(text, " %9.0f %7llu", to_milliseconds(s.deadline),
           static_cast<unsigned long long>(s.misses));
  }
  text += '\n';
}

void append_worst(std::string& text, const std::vector<LatencySummary>& summaries) {
  for (const LatencySummary& s : summaries) {
    constexpr std::size_t shown = 5;
    for (std::size_t i = 0; i < std::min(s.worst.size(), shown); ++i) {
      const MissedDeadline& m = s.worst[i];
      append(text, "  missed: %s at %s: %.3f ms (", s.name.c_str(), format_time(m.stamp).c_str(),
             to_milliseconds(m.latency));
      const char* separator = "";
      for (const MissedDeadline::Part& part : m.parts) {
        append(text, "%s%s %.3f", separator, part.name.c_str(), to_milliseconds(part.lasted));
        separator = ", ";
      }
      text += ")\n";
    }
  }
}

void append_findings(std::string& text, const vehicle::SensorReport& sensor) {
  constexpr std::size_t shown = 5;
  const auto append_some = [&](const std::vector<sensors::Finding>& findings, std::uint64_t count,
                               const char* what) {
    for (std::size_t i = 0; i < findings.size() && i < shown; ++i) {
      const sensors::Finding& f = findings[i];
      text += "  " + std::string(what) + ": " + f.file;
      if (f.line > 0) text += ":" + std::to_string(f.line);
      text += ": " + f.reason + '\n';
    }
    if (count > shown)
      append(text, "  ... %llu %s of %s in all\n", static_cast<unsigned long long>(count), what,
             sensor.name.c_str());
  };
  append_some(sensor.source.refusals, sensor.source.refused, "left out");
  append_some(sensor.source.flaws, sensor.source.flawed, "flawed");
}

void append_faults(std::string& text, const std::vector<vehicle::FaultCount>& faults) {
  if (faults.empty()) return;
  text += "\nFaults asked for                  struck\n";
  for (const vehicle::FaultCount& f : faults) {
    append(text, "  %-28s %9llu%s\n", f.fault.c_str(), static_cast<unsigned long long>(f.struck),
           f.struck == 0 ? "  (outside of the drive, or the drive lacks the sensor)" : "");
  }
}

void append_live(std::string& text, const std::vector<SensorHealth>& sensors) {
  if (sensors.empty()) return;
  text += "\nLive             connected   drift ppm   jumps   UTC ahead of the host's  s\n";
  for (const SensorHealth& s : sensors) {
    append(text, "  %-12s %9llu x", s.name.c_str(), static_cast<unsigned long long>(s.connections));
    if (s.clock.known) {
      append(text, " %11.2f %7llu", -1e6 * s.clock.drift,
             static_cast<unsigned long long>(s.clock.jumps));
      if (s.clock.utc_ahead) append(text, "   %.6f", to_seconds(*s.clock.utc_ahead));
    }
    text += "   " + s.endpoint + (s.problem.empty() ? "" : ": " + s.problem) + '\n';
  }
}

void append_refusals(std::string& text, const std::vector<RefusalCount>& refusals) {
  if (refusals.empty()) return;
  text += "\nNot used by         count\n";
  for (const RefusalCount& r : refusals) {
    append(text, "  %-12s %10llu  %s\n", r.stage.c_str(), static_cast<unsigned long long>(r.count),
           r.reason.c_str());
  }
}

using Channels = std::map<std::string, vehicle::ChannelSummary>;

void append_channels(std::string& text, const Channels& channels) {
  for (const auto& [name, channel] : channels) {
    append(text, "  %-11s %9llu  %s\n", name.c_str(),
           static_cast<unsigned long long>(channel.count),
           channel.hash.empty() ? "(of this run)" : channel.hash.c_str());
  }
}

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json(const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return nullptr;
  const evaluation::Score& raw = accuracy->raw;
  const evaluation::Score& removed = accuracy->common_rotation_removed;
  return {{"distance_m", number(raw.distance_m)},
          {"end_point_m", number(raw.end_point_m)},
          {"segment_100m_percent", number(raw.segment.percent)},
          {"segment_100m_deg_per_m", number(raw.segment.deg_per_m)},
          {"frames", raw.frames},
          {"common_rotation_removed",
           {{"end_point_m", number(removed.end_point_m)},
            {"segment_100m_percent", number(removed.segment.percent)},
            {"segment_100m_deg_per_m", number(removed.segment.deg_per_m)}}}};
}

json to_json(const fusion_score::Errors& e) {
  return {{"distance_m", number(e.distance)},
          {"rmse_m", number(e.rmse)},
          {"rmse_percent", number(e.rmse_percent())},
          {"max_m", number(e.max)},
          {"drift_m", number(e.drift)},
          {"drift_percent", number(e.percent())},
          {"azimuth_rms_deg", number(e.azimuth_rms)},
          {"azimuth_end_deg", number(e.azimuth_end)},
          {"nees_mean", number(e.nees_mean)},
          {"nees_end", number(e.nees_end)},
          {"covered", number(e.covered)}};
}

json to_json(const fusion_score::Score& s) {
  json j = to_json(s.whole);
  j["reference_accuracy_m"] = number(s.reference_accuracy);
  j["outages"] = json::array();
  for (const fusion_score::OutageErrors& o : s.outages) {
    json one = to_json(o.errors);
    one["start_s"] = o.start;
    one["length_s"] = o.length;
    j["outages"].push_back(one);
  }
  return j;
}

json to_json(const LatencySummary& s) {
  return {{"count", s.count},
          {"misses", s.misses},
          {"deadline_ms", to_milliseconds(s.deadline)},
          {"p50_ms", to_milliseconds(s.p50)},
          {"p90_ms", to_milliseconds(s.p90)},
          {"p99_ms", to_milliseconds(s.p99)},
          {"p999_ms", to_milliseconds(s.p999)},
          {"max_ms", to_milliseconds(s.max)}};
}

json to_json(const std::vector<LatencySummary>& summaries) {
  json all = json::object();
  for (const LatencySummary& s : summaries) all[s.name] = to_json(s);
  return all;
}

json to_json(const Channels& channels) {
  json all = json::object();
  for (const auto& [name, channel] : channels) {
    all[name] = {{"hash", channel.hash}, {"count", channel.count}};
  }
  return all;
}

}  // namespace

std::uint64_t ReplayResult::samples_lost() const {
  std::uint64_t lost = 0;
  for (const RingHealth& ring : vehicle.health.rings) lost += ring.lost;
  return lost;
}

std::uint64_t ReplayResult::messages_unsent() const {
  std::uint64_t unsent = 0;
  for (const OutputHealth& output : vehicle.health.outputs) unsent += output.unsent;
  return unsent;
}

std::uint64_t ReplayResult::deadline_misses() const {
  std::uint64_t misses = 0;
  for (const LatencySummary& thread : vehicle.deadlines.threads) misses += thread.misses;
  return misses;
}

std::string format_table(const ReplayResult& r) {
  const vehicle::VehicleReport& v = r.vehicle;
  std::string t;
  append(t, "\n%s%s: %.1f s of data in %.1f s (%s)\n", r.drive.c_str(),
         r.interrupted ? " (interrupted)" : "", v.data_seconds, v.wall_seconds,
         r.live       ? "live"
         : r.lockstep ? "lockstep"
                      : ("speed " + std::to_string(r.speed)).c_str());
  append(t, "CPU %.0f %% of one core, peak memory %.0f MB\n",
         100.0 * v.cpu_seconds / v.wall_seconds, static_cast<double>(v.peak_memory) * 1e-6);

  if (r.vo || r.fused) {
    t += "\nAccuracy against the reference (left camera, WGS84)\n";
    t += "                  distance   end point      100 m segments   common rotation removed\n";
    t += "           frames        m        m      %        %     deg/m            %     deg/m"
         "  end m\n";
    append_accuracy(t, "vo", r.vo);
    if (r.lidar) append_accuracy(t, "lidar", r.lidar);
    append_accuracy(t, "fused", r.fused);
  } else if (!r.navigation && !r.live) {
    t += "\nAccuracy is not scored: the drive has no reference, or too few poses\n";
  }
  if (v.imu_delay.known()) {
    append(t, "  inertial stamps are %.1f +- %.1f ms late against odometry\n",
           1e3 * v.imu_delay.delay(), 1e3 * v.imu_delay.sigma());
  }
  if (r.navigation) t += fusion_score::to_text(*r.navigation);
  if (r.links) t += "\nLinks driven against their labels\n" + match::to_text(*r.links);

  if (r.ppp) append_ppp(t, *r.ppp);
  t += "\nSensors                 count  left out   late p50       p99       max  ms\n";
  for (const vehicle::SensorReport& s : v.sensors) {
    append(t, "  %-19s %7llu %9llu", s.name.c_str(),
           static_cast<unsigned long long>(s.source.delivered),
           static_cast<unsigned long long>(s.source.refused));
    if (!r.lockstep) {
      append(t, "  %9.3f %9.3f %9.3f", to_milliseconds(s.lateness.p50),
             to_milliseconds(s.lateness.p99), to_milliseconds(s.lateness.max));
    }
    t += '\n';
    append_findings(t, s);
  }
  if (!r.lockstep) {
    append(t, "  %-19s %7llu            %9.3f %9.3f %9.3f\n", "all",
           static_cast<unsigned long long>(v.lateness.count), to_milliseconds(v.lateness.p50),
           to_milliseconds(v.lateness.p99), to_milliseconds(v.lateness.max));
  }

  append_live(t, v.health.sensors);
  append_faults(t, r.faults);
  append_refusals(t, v.health.refusals);

  t += r.lockstep ? "\nRun time                 count       p50       p90       p99       max  ms\n"
                  : "\nFrom release             count       p50       p90       p99       max"
                    "  deadline  missed  ms\n";
  for (const LatencySummary& s : v.deadlines.threads) append_latency(t, s);
  if (!r.lockstep) {
    t += "From the sensor's stamp\n";
    for (const LatencySummary& s : v.deadlines.paths) append_latency(t, s);
    append_worst(t, v.deadlines.threads);
    append_worst(t, v.deadlines.paths);
  }

  t += "\nRings                                pushed    popped      lost      held  capacity\n";
  for (const RingHealth& ring : v.health.rings) {
    append(t, "  %-30s %10llu %9llu %9llu %9llu %9llu\n", ring.name.c_str(),
           static_cast<unsigned long long>(ring.pushed),
           static_cast<unsigned long long>(ring.popped), static_cast<unsigned long long>(ring.lost),
           static_cast<unsigned long long>(ring.held),
           static_cast<unsigned long long>(ring.capacity));
  }

  t += "\nChannels      messages  hash\n";
  append_channels(t, r.channels);
  if (r.snapshot) {
    append(t, "\nAfter the snapshot at %.3f s (%s), and of a run that resumes from it\n",
           r.snapshot->at, r.snapshot->file.c_str());
    append_channels(t, r.snapshot->channels);
  }
  if (r.trace) {
    append(t, "\nTrace: %llu events in %s, %llu dropped\n",
           static_cast<unsigned long long>(r.trace->recorded), r.trace->file.c_str(),
           static_cast<unsigned long long>(r.trace->dropped));
  }
  for (const std::string& sentence : v.health.degraded) t += "\nNote: " + sentence + '\n';
  return t;
}

void write_json(const std::filesystem::path& file, const ReplayResult& r) {
  const vehicle::VehicleReport& v = r.vehicle;
  json j;
  j["run"] = r.run;
  j["drive"] = r.drive;
  j["verdict"] = verdict(r);
  const auto why = why_empty(r);
  j["empty"] = why ? json(*why) : json(nullptr);
  j["configuration"] = r.configuration;
  j["interrupted"] = r.interrupted;
  j["vo"] = to_json(r.vo);
  j["lidar"] = to_json(r.lidar);
  j["fused"] = to_json(r.fused);
  if (r.ppp) {
    j["ppp"] = {{"converged", r.ppp->of(PppStatus::converged)},
                {"converging", r.ppp->of(PppStatus::converging)},
                {"none", r.ppp->of(PppStatus::none)},
                {"never_converges", r.ppp->never_converges},
                {"converged_after_s",
                 r.ppp->converged_after < 0.0 ? json(nullptr) : json(r.ppp->converged_after)}};
  }
  j["navigation"] = r.navigation ? to_json(*r.navigation) : json(nullptr);
  j["links"] = r.links ? match::to_json(*r.links) : json(nullptr);
  if (v.imu_delay.known()) {
    j["imu_delay_left"] = {{"s", v.imu_delay.delay()}, {"sigma_s", v.imu_delay.sigma()}};
  }
  j["replay"] = {{"lockstep", r.lockstep},
                 {"speed", r.speed},
                 {"images", r.images},
                 {"data_s", v.data_seconds},
                 {"wall_s", v.wall_seconds},
                 {"cpu_s", v.cpu_seconds},
                 {"peak_memory_bytes", v.peak_memory},
                 {"lateness_p50_ms", to_milliseconds(v.lateness.p50)},
                 {"lateness_p99_ms", to_milliseconds(v.lateness.p99)},
                 {"lateness_max_ms", to_milliseconds(v.lateness.max)},
                 {"lost", r.samples_lost()},
                 {"stalls", v.stalls},
                 {"stalled_s", to_seconds(v.stalled)},
                 {"send_failures", r.messages_unsent()}};
  j["deadlines"] = {{"misses", r.deadline_misses()},
                    {"threads", to_json(v.deadlines.threads)},
                    {"paths", to_json(v.deadlines.paths)}};
  for (const vehicle::SensorReport& s : v.sensors) {
    j["sensors"][s.name] = {{"delivered", s.source.delivered},
                            {"left_out", s.source.refused},
                            {"flawed", s.source.flawed},
                            {"lateness", to_json(s.lateness)}};
  }
  for (const SensorHealth& s : v.health.sensors) {
    json& one = j["live"][s.name];
    one = {{"endpoint", s.endpoint},
           {"connected", s.connected},
           {"connections", s.connections},
           {"problem", s.problem}};
    if (s.clock.known) one["clock"] = to_json(s.clock);
  }
  for (const RingHealth& ring : v.health.rings) {
    j["rings"][ring.name] = {{"pushed", ring.pushed},
                             {"popped", ring.popped},
                             {"lost", ring.lost},
                             {"held", ring.held},
                             {"capacity", ring.capacity}};
  }
  j["faults"] = json::array();
  for (const vehicle::FaultCount& f : r.faults) {
    j["faults"].push_back({{"fault", f.fault}, {"struck", f.struck}});
  }
  j["refusals"] = json::object();
  for (const RefusalCount& refusal : v.health.refusals) {
    j["refusals"][refusal.stage][refusal.reason] = refusal.count;
  }
  j["channels"] = to_json(r.channels);
  if (r.snapshot) {
    j["snapshot"] = {{"file", r.snapshot->file},
                     {"at_s", r.snapshot->at},
                     {"channels", to_json(r.snapshot->channels)}};
  }
  j["degraded"] = v.health.degraded;
  if (r.trace) {
    j["trace"] = {{"recorded", r.trace->recorded}, {"dropped", r.trace->dropped}};
  }
  j["realtime"] = to_json(v.health.settings);
  write_json_file(file, j);
}

}  // namespace maploop::tools
