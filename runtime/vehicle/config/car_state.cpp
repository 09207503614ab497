#include "runtime/vehicle/config/car_state.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "runtime/core/config.h"
#include "runtime/core/number_text.h"
#include "runtime/core/whole_file.h"

namespace maploop::vehicle {
namespace {

// A basic string of TOML is one of JSON.
std::string toml_text(std::string_view text) {
  return nlohmann::json(text).dump();
}

Time read_time(const runtime::ConfigTable& root) {
  std::string text;
  root.read("at", text);
  try {
    return parse_time(text);
  } catch (const std::invalid_argument& e) {
    root.fail("at", e.what());
  }
}

}  // namespace

std::optional<fusion::RememberedCalibration> read_car_state(const std::filesystem::path& file,
                                                            const std::string& car) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  const runtime::ConfigTable root = document.root();
  std::string named;
  root.read("car", named);
  if (named != car) {
    root.fail("car", "is " + toml_text(named) + ", but [vehicle] name of the configuration is " +
                         toml_text(car) + ": name another file with --state, one for each car");
  }
  fusion::RememberedCalibration remembered;
  remembered.at = read_time(root);
  const fusion::SelfCalibrations properties =
      fusion::self_calibrations({}, fusion::StateVector::Zero());
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (!root.has(properties[i].key)) continue;
    const runtime::ConfigTable table = root.table(properties[i].key);
    std::string unit(properties[i].unit);
    table.read_one_of("unit", unit, std::array{properties[i].unit});
    if (!table.has("value")) table.fail("value", "is missing");
    table.read("value", remembered.value[i]);
    table.read("sigma", remembered.sigma[i]);
    if (!(remembered.sigma[i] > 0.0)) table.fail("sigma", "must be above 0");
  }
  document.reject_unknown();
  return remembered;
}

std::size_t write_car_state(const std::filesystem::path& file, const std::string& car, Time at,
                            const fusion::SelfCalibrations& estimated) {
  std::string text = "# What maploop has estimated of this car; --state reads and replaces it.\n";
  text += "car = " + toml_text(car) + "\nat = " + toml_text(format_time(at)) + '\n';
  std::size_t count = 0;
  for (const fusion::CalibratedProperty& p : estimated) {
    if (!p.observed()) continue;
    ++count;
    text += fmt::format("\n[{}]  # {}\nvalue = {}\nsigma = {}\nunit = {}\n", p.key, p.name,
                        runtime::shortest_text(p.value), runtime::shortest_text(p.sigma),
                        toml_text(p.unit));
  }
  if (count == 0) return 0;
  runtime::WholeFile output(file);
  output.write(text);
  output.keep();
  return count;
}

}  // namespace maploop::vehicle
