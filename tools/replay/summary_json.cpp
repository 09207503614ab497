// The figures of a run as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/command/json_output.h"
#include "tools/match/score_output.h"
#include "tools/replay/replay_result.h"
#include "tools/replay/verdict.h"

namespace maploop::tools {
namespace {

using nlohmann::json;
using Channels = std::map<std::string, vehicle::ChannelSummary>;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json(const Accuracy& accuracy) {
  const evaluation::Score& raw = accuracy.raw;
  const evaluation::Score& removed = accuracy.common_rotation_removed;
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

template <class T>
json or_null(const std::optional<T>& value) {
  return value ? to_json(*value) : json(nullptr);
}

json to_json(const PppEpochs& e) {
  return {{"converged", e.of(PppStatus::converged)},
          {"converging", e.of(PppStatus::converging)},
          {"none", e.of(PppStatus::none)},
          {"never_converges", e.never_converges},
          {"converged_after_s", e.converged_after < 0.0 ? json(nullptr) : json(e.converged_after)}};
}

// How the run went.
json replay_json(const ReplayResult& r) {
  const vehicle::VehicleReport& v = r.vehicle;
  return {{"lockstep", r.lockstep},
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
}

// How good it is.
void add_scores(json& j, const ReplayResult& r) {
  j["vo"] = or_null(r.vo);
  j["lidar"] = or_null(r.lidar);
  j["fused"] = or_null(r.fused);
  if (r.ppp) j["ppp"] = to_json(*r.ppp);
  j["navigation"] = or_null(r.navigation);
  j["links"] = r.links ? match::to_json(*r.links) : json(nullptr);
  if (const auto& late = r.vehicle.imu_delay; late.known())
    j["imu_delay_left"] = {{"s", late.delay()}, {"sigma_s", late.sigma()}};
}

// What came of each sensor.
void add_sensors(json& j, const vehicle::VehicleReport& v) {
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
    if (s.clock.known) one["clock"] = tools::to_json(s.clock);
  }
}

// Rings, refusals and what was granted.
void add_health(json& j, const Health& health) {
  for (const RingHealth& ring : health.rings) {
    j["rings"][ring.name] = {{"pushed", ring.pushed},
                             {"popped", ring.popped},
                             {"lost", ring.lost},
                             {"held", ring.held},
                             {"capacity", ring.capacity}};
  }
  j["refusals"] = json::object();
  for (const RefusalCount& refusal : health.refusals)
    j["refusals"][refusal.stage][refusal.reason] = refusal.count;
  j["degraded"] = health.degraded;
  j["realtime"] = tools::to_json(health.settings);
}

}  // namespace

void write_json(const std::filesystem::path& file, const ReplayResult& r) {
  json j;
  j["run"] = r.run;
  j["drive"] = r.drive;
  j["verdict"] = verdict(r);
  const auto why = why_empty(r);
  j["empty"] = why ? json(*why) : json(nullptr);
  j["configuration"] = r.configuration;
  j["interrupted"] = r.interrupted;
  add_scores(j, r);
  j["replay"] = replay_json(r);
  j["deadlines"] = {{"misses", r.deadline_misses()},
                    {"threads", to_json(r.vehicle.deadlines.threads)},
                    {"paths", to_json(r.vehicle.deadlines.paths)}};
  add_sensors(j, r.vehicle);
  add_health(j, r.vehicle.health);
  j["faults"] = json::array();
  for (const vehicle::FaultCount& f : r.faults)
    j["faults"].push_back({{"fault", f.fault}, {"struck", f.struck}});
  j["channels"] = to_json(r.channels);
  if (r.snapshot) {
    j["snapshot"] = {{"file", r.snapshot->file},
                     {"at_s", r.snapshot->at},
                     {"channels", to_json(r.snapshot->channels)}};
  }
  if (r.trace) j["trace"] = {{"recorded", r.trace->recorded}, {"dropped", r.trace->dropped}};
  write_json_file(file, j);
}

}  // namespace maploop::tools
