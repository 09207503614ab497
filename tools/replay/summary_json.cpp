// The figures of a run as JSON. Numbers that are not finite become null.
#include "tools/command/json_output.h"
#include "tools/match/match_score.h"
#include "tools/profile/profile.h"
#include "tools/replay/figures.h"

namespace maploop::tools {
namespace {

using nlohmann::json;

json to_json(const fusion_score::Score& s) {
  json j = web::to_json(error_columns, s.whole);
  j["reference_accuracy_m"] = s.reference_accuracy;
  j["unsaid_s"] = s.unsaid;
  j["odom_100m_percent"] = s.odom_percent;
  j["outages"] = json::array();
  for (const fusion_score::OutageErrors& o : s.outages) {
    json& one = j["outages"].emplace_back(web::to_json(error_columns, o.errors));
    one["start_s"] = o.start;
    one["length_s"] = o.length;
  }
  return j;
}

json to_json(const LatencySummary& s) {
  json j = web::to_json(profile::percentiles, s);
  j["misses"] = s.misses;
  j["deadline_ms"] = to_milliseconds(s.deadline);
  return j;
}

json to_json(const std::vector<LatencySummary>& summaries) {
  json all = json::object();
  for (const LatencySummary& s : summaries) all[s.name] = to_json(s);
  return all;
}

json to_json(const std::map<std::string, vehicle::ChannelSummary>& channels) {
  json all = json::object();
  for (const auto& [name, channel] : channels) {
    all[name] = {{"hash", channel.hash}, {"count", channel.count}};
  }
  return all;
}

json to_json(const PppEpochs& e) {
  return {{"converged", e.of(PppStatus::converged) + e.of(PppStatus::fixed)},
          {"fixed", e.of(PppStatus::fixed)},
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
          {"without_position_s", r.without_position},
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

// How good the results are.
void add_scores(json& j, const ReplayResult& r) {
  const auto accuracy = [](const std::optional<Accuracy>& a) {
    return a ? web::to_json(accuracy_columns, *a) : json(nullptr);
  };
  j["vo"] = accuracy(r.vo);
  j["lidar"] = accuracy(r.lidar);
  j["fused"] = accuracy(r.fused);
  j["odom"] = accuracy(r.odom);
  if (r.ppp) j["ppp"] = to_json(*r.ppp);
  j["navigation"] = r.navigation ? to_json(*r.navigation) : json(nullptr);
  j["protection"] = r.protection ? web::to_json(protection_columns, *r.protection) : json(nullptr);
  j["outage_ends"] = web::list(outage_end_columns, r.outage_ends);
  j["links"] = r.links ? match::to_json(*r.links) : json(nullptr);
  if (r.links && r.links->lacking_fixes > 0) {
    const auto fixes = static_cast<double>(r.links->lacking_fixes);
    j["links"]["lacking"] = {{"fixes", r.links->lacking_fixes},
                             {"p_said", r.links->lacking_p_sum / fixes}};
  }
  for (std::size_t i = 0; i < r.feedbacks.size(); ++i) {
    if (r.feedbacks[i] > 0)
      j["map_feedback"][std::string(to_string(static_cast<FeedbackReason>(i)))] = r.feedbacks[i];
  }
  for (const fusion::CalibratedProperty& c : r.vehicle.calibration) {
    if (c.sigma == 0.0) continue;
    j["calibration"].push_back({{"name", c.name},
                                {"unit", c.unit},
                                {"value", c.value},
                                {"sigma", c.sigma},
                                {"observed", c.observed()}});
  }
}

// What each sensor delivered.
void add_sensors(json& j, const vehicle::VehicleReport& v) {
  for (const vehicle::SensorReport& s : v.sensors) {
    json& one = j["sensors"][s.name] = web::to_json(sensor_columns, s);
    one["lateness"] = to_json(s.lateness);
  }
  for (const SensorHealth& s : v.health.sensors) {
    json& one = j["live"][s.name];
    one = {{"endpoint", s.endpoint},
           {"connected", s.connected},
           {"connections", s.connections},
           {"problem", s.problem}};
    if (s.clock.known) one["clock"] = web::to_json(clock_columns, s.clock);
  }
}

}  // namespace

json to_json(const ReplayResult& r) {
  const Health& health = r.vehicle.health;
  const auto why = why_empty(r);
  json j{{"run", r.run},
         {"drive", r.drive},
         {"verdict", verdict(r)},
         {"empty", why ? json(*why) : json(nullptr)},
         {"configuration", r.configuration},
         {"interrupted", r.interrupted},
         {"replay", replay_json(r)},
         {"deadlines",
          {{"misses", r.deadline_misses()},
           {"threads", to_json(r.vehicle.deadlines.threads)},
           {"paths", to_json(r.vehicle.deadlines.paths)}}},
         {"rings", web::by_name(ring_columns, health.rings)},
         {"refusals", json::object()},
         {"degraded", health.degraded},
         {"realtime", web::list(setting_columns, health.settings)},
         {"faults", web::list(fault_columns, r.faults)},
         {"channels", to_json(r.channels)}};
  j["named"] = json::array();
  for (const vehicle::Naming& naming : r.vehicle.named)
    j["named"].push_back({{"what", naming.what}, {"at_s", to_seconds(naming.at - r.begin)}});
  add_scores(j, r);
  add_sensors(j, r.vehicle);
  for (const RefusalCount& refusal : health.refusals)
    j["refusals"][refusal.stage][refusal.reason] = refusal.count;
  if (r.snapshot) {
    j["snapshot"] = {{"file", r.snapshot->file},
                     {"at_s", r.snapshot->at},
                     {"channels", to_json(r.snapshot->channels)}};
  }
  if (r.trace) j["trace"] = {{"recorded", r.trace->recorded}, {"dropped", r.trace->dropped}};
  return j;
}

void write_json(const std::filesystem::path& file, const ReplayResult& result) {
  write_json_file(file, to_json(result));
}

}  // namespace maploop::tools
