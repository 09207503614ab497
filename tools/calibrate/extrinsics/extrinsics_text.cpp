#include "tools/calibrate/extrinsics/extrinsics_text.h"

#include <fmt/format.h>

#include "msgs/frames.h"
#include "tools/web/table.h"

namespace maploop::extrinsics {
namespace {

const web::Columns<SensorPair> pair_columns{
    {"a", "stamps of", -14, 0, [](const SensorPair& p) { return p.a; }},
    {"b", "against", -8, 0, [](const SensorPair& p) { return p.b; }},
    {"motions", "motions", 8, 0, [](const SensorPair& p) { return p.rates.motions; }},
    {"correlation", "correlation", 12, 3, [](const SensorPair& p) { return p.rates.correlation; }},
    {"delay_ms", "later by, ms", 13, 1, [](const SensorPair& p) { return 1e3 * p.rates.delay; }},
    {"delay_sigma_ms", "sigma, ms", 10, 1,
     [](const SensorPair& p) { return 1e3 * p.rates.delay_sigma(); }},
    {"found", "", 0, 0, [](const SensorPair& p) { return p.rates.status == AlignmentStatus::ok; }},
};

const web::Columns<FoundValue> value_columns{
    {"table", "table", -16, 0, &FoundValue::table},
    {"key", "key", -8, 0, &FoundValue::key},
    {"before", "before", 9, 3, &FoundValue::before},
    {"value", "found", 9, 3, &FoundValue::value},
    {"sigma", "sigma", 9, 4, &FoundValue::sigma},
    {"unit", "unit", -4, 0, &FoundValue::unit},
    {"written", "", 0, 0, &FoundValue::observed},
    {"", "written", -7, 0, [](const FoundValue& v) { return v.observed ? "yes" : "no"; }},
};

template <class Item>
std::string table_text(const web::Columns<Item>& columns, const std::vector<Item>& items) {
  if (items.empty()) return "";
  std::string text = web::heading_text(columns) + '\n';
  for (const Item& item : items) text += web::to_text(columns, item) + '\n';
  return text + '\n';
}

}  // namespace

std::string to_text(const Extrinsics& found) {
  std::string text =
      table_text(pair_columns, found.pairs) + table_text(value_columns, found.values);
  if (found.contradiction > 0.0) {
    text += fmt::format("Contradiction between the pairs' rotations: {:.1f} (1 is expected).\n",
                        found.contradiction);
  }
  for (const std::string& sentence : found.sentences) text += sentence + '\n';
  return text;
}

nlohmann::json to_json(const Extrinsics& found) {
  nlohmann::json json{{"pairs", web::list(pair_columns, found.pairs)},
                      {"values", web::list(value_columns, found.values)},
                      {"contradiction", found.contradiction},
                      {"sentences", found.sentences}};
  if (found.camera_lidar && found.camera_lidar->found) {
    const HandEye& eye = *found.camera_lidar;
    const auto& p = eye.T_a_b.translation();
    const auto& s = eye.position_sigma;
    json["lidar_in_camera"] = {{"position_m", {p.x(), p.y(), p.z()}},
                               {"sigma_m", {s.x(), s.y(), s.z()}},
                               {"scale", eye.scale},
                               {"scale_sigma", eye.scale_sigma}};
  }
  return json;
}

std::string to_toml(const Extrinsics& found, const std::string& recording) {
  return "# What is known of the vehicle, with what maploop calibrate extrinsics found in\n# " +
         recording + ".\n" + to_toml(found.description);
}

}  // namespace maploop::extrinsics
