#include "tools/replay/figures.h"

#include <functional>

namespace maploop::tools {
namespace {

using evaluation::Score;
using fusion_score::Errors;
using fusion_score::OutageEnd;
using fusion_score::ProtectionScore;
using nlohmann::json;

double percent(const Score& s) {
  return s.segment.percent;
}

double degrees_per_metre(const Score& s) {
  return s.segment.deg_per_m;
}

// A figure of the trajectory as it is, and of it with one common rotation removed.
auto raw(auto figure) {
  return [=](const Accuracy& a) { return std::invoke(figure, a.raw); };
}

auto rotated(auto figure) {
  return [=](const Accuracy& a) { return std::invoke(figure, a.common_rotation_removed); };
}

}  // namespace

const web::Columns<Accuracy> accuracy_columns{
    {"frames", "images", 6, 0, raw(&Score::frames)},
    {"distance_m", "distance, m", 9, 1, raw(&Score::distance_m)},
    {"end_point_m", "end point, m", 8, 2, raw(&Score::end_point_m)},
    {"", "", 7, 2, raw(&Score::end_point_percent)},
    {"segment_100m_percent", "%", 9, 3, raw(percent)},
    {"segment_100m_deg_per_m", "deg/m", 10, 5, raw(degrees_per_metre)},
    {"common_rotation_removed/segment_100m_percent", "%", 13, 3, rotated(percent)},
    {"common_rotation_removed/segment_100m_deg_per_m", "deg/m", 10, 5, rotated(degrees_per_metre)},
    {"common_rotation_removed/end_point_m", "end point, m", 9, 2, rotated(&Score::end_point_m)},
};

const web::Columns<Errors> error_columns{
    {"distance_m", "distance, m", 9, 1, &Errors::distance},
    {"rmse_m", "RMSE, m", 7, 2, &Errors::rmse},
    {"rmse_percent", "", 0, 0, &Errors::rmse_percent},
    {"max_m", "max, m", 7, 2, &Errors::max},
    {"drift_m", "drift, m", 7, 2, &Errors::drift},
    {"drift_percent", "drift, %", 8, 3, &Errors::percent},
    {"azimuth_rms_deg", "azimuth RMS, deg", 7, 3, &Errors::azimuth_rms},
    {"azimuth_end_deg", "", 6, 3, &Errors::azimuth_end},
    {"nees_mean", "NEES", 5, 1, &Errors::nees_mean},
    {"nees_end", "", 6, 1, &Errors::nees_end},
    {"nees_max", "", 0, 0, &Errors::nees_max},
    {"beyond_3_sigma_s", "beyond 3 sigma, s", 0, 0, &Errors::beyond},
    {"azimuth_beyond_3_sigma_s", "", 0, 0, &Errors::azimuth_beyond},
    {"covered", "", 0, 0, &Errors::covered},
    {"", "covered, %", 0, 0, [](const Errors& e) { return 100.0 * e.covered; }},
};

const web::Columns<OutageEnd> outage_end_columns{
    {"start_s", "", 0, 0, &OutageEnd::start},
    {"length_s", "", 0, 0, &OutageEnd::length},
    {"distance_m", "", 0, 0, &OutageEnd::distance},
    {"error_m", "", 0, 0, &OutageEnd::error},
    {"error_percent", "", 0, 0, &OutageEnd::percent},
    {"sigma_m", "", 0, 0, &OutageEnd::sigma},
    {"reference_error_m", "", 0, 0, [](const auto& o) { return o.peer ? json(*o.peer) : json(); }},
};

const web::Columns<ProtectionScore> protection_columns{
    {"risk", "", 0, 0, &ProtectionScore::risk},
    {"moments", "", 0, 0, [](const auto& s) { return s.moments.size(); }},
    {"doubted", "", 0, 0, &ProtectionScore::doubted},
    {"along/beyond", "", 0, 0, [](const auto& s) { return s.along.beyond; }},
    {"along/median_m", "", 0, 0, [](const auto& s) { return s.along.median; }},
    {"across/beyond", "", 0, 0, [](const auto& s) { return s.across.beyond; }},
    {"across/median_m", "", 0, 0, [](const auto& s) { return s.across.median; }},
    {"horizontal/beyond", "", 0, 0, [](const auto& s) { return s.horizontal.beyond; }},
    {"horizontal/median_m", "", 0, 0, [](const auto& s) { return s.horizontal.median; }},
    {"largest_ratio", "", 0, 0, &ProtectionScore::largest_ratio},
    {"below_5_m", "", 0, 0, &ProtectionScore::below_5},
    {"below_10_m", "", 0, 0, &ProtectionScore::below_10},
};

const web::Columns<vehicle::SensorReport> sensor_columns{
    {"", "sensor", -19, 0, &vehicle::SensorReport::name},
    {"delivered", "delivered", 7, 0, [](const auto& s) { return s.source.delivered; }},
    {"left_out", "left out", 9, 0, [](const auto& s) { return s.source.refused; }},
    {"flawed", "flawed", 0, 0, [](const auto& s) { return s.source.flawed; }},
};

const web::Columns<vehicle::FaultCount> fault_columns{
    {"fault", "fault asked for", -28, 0, &vehicle::FaultCount::fault},
    {"struck", "struck", 9, 0, &vehicle::FaultCount::struck},
};

const web::Columns<RefusalCount> refusal_columns{
    {"", "", -12, 0, &RefusalCount::stage},
    {"", "not used", 0, 0, [](const auto& r) { return r.stage + ": " + r.reason; }},
    {"", "count", 10, 0, &RefusalCount::count},
};

const web::Columns<RingHealth> ring_columns{
    {"", "ring", -30, 0, &RingHealth::name},
    {"pushed", "pushed", 10, 0, &RingHealth::pushed},
    {"popped", "popped", 9, 0, &RingHealth::popped},
    {"lost", "lost", 9, 0, &RingHealth::lost},
    {"held", "held", 9, 0, &RingHealth::held},
    {"capacity", "capacity", 9, 0, &RingHealth::capacity},
};

const web::Columns<RealtimeSetting> setting_columns{
    {"name", " ", 0, 0, &RealtimeSetting::name},
    {"asked", "asked", 0, 0, &RealtimeSetting::asked},
    {"granted", "granted", 0, 0, &RealtimeSetting::granted},
    {"verdict", "verdict", 0, 0, [](const auto& s) { return to_string(s.verdict); }},
    {"reason", "why not", 0, 0, &RealtimeSetting::reason},
    {"remedy", "what to do", 0, 0, &RealtimeSetting::remedy},
};

const web::Columns<SensorClock> clock_columns{
    {"drift", "", 0, 0, &SensorClock::drift},
    {"delay_s", "", 0, 0, [](const auto& c) { return to_seconds(c.delay); }},
    {"jumps", "", 0, 0, &SensorClock::jumps},
    {"utc_ahead_s", "", 0, 0,
     [](const auto& c) { return c.utc_ahead ? json(to_seconds(*c.utc_ahead)) : json(); }},
};

}  // namespace maploop::tools
