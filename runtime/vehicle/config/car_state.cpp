#include "runtime/vehicle/config/car_state.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "msgs/frames.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/whole_file.h"
#include "msgs/xxh3.h"
#include "runtime/core/config.h"
#include "runtime/core/number_text.h"

namespace maploop::vehicle {
namespace {

constexpr int version = 2;  // the first one had no place, and did not say it
constexpr std::string_view checksum_line = "# XXH3 of the lines above: ";

// A basic string of TOML is one of JSON.
std::string toml_text(std::string_view text) {
  return nlohmann::json(text).dump();
}

std::string checksum_of(std::string_view text) {
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

void check_version(const runtime::ConfigTable& root, std::string_view text) {
  int written = 1;
  root.read("version", written);
  if (written > version || written < 1) {
    root.fail("version", fmt::format("is {}, but this program reads 1 to {}: name another file, or "
                                     "delete this one",
                                     written, version));
  }
  if (written == 1) return;
  const std::size_t last = text.rfind(checksum_line);
  const bool whole = last != std::string_view::npos && text.substr(last + checksum_line.size()) ==
                                                           checksum_of(text.substr(0, last)) + '\n';
  if (!whole) {
    root.fail("version",
              "needs an unchanged file, and this one was cut, damaged or edited: delete it, and "
              "the car is learnt anew (or delete [place] and this key, to use the rest as it is)");
  }
}

Time read_time(const runtime::ConfigTable& table, std::string_view key) {
  std::string text;
  table.read(key, text);
  try {
    return parse_time(text);
  } catch (const std::invalid_argument& e) {
    table.fail(key, e.what());
  }
}

// A key of [place]: its numbers, and how many of their own unit a unit of the file is.
template <class Number>
struct PlaceKey {
  std::string_view key, unit;
  std::span<Number> values;
  double per_unit = 1.0;
};

template <class Place,
          class Number = std::remove_pointer_t<decltype(&std::declval<Place&>().speed)>>
std::vector<PlaceKey<Number>> keys_of(Place& p) {
  const auto one = [](Number& n) { return std::span(&n, 1); };
  const auto three = [](auto& v) { return std::span(v.data(), 3); };
  const double degree = radians(1.0);
  return {
      {"latitude", "deg", one(p.position.latitude), degree},
      {"longitude", "deg", one(p.position.longitude), degree},
      {"height", "m above the ellipsoid", one(p.position.height)},
      {"azimuth", "deg, clockwise from north", one(p.attitude.azimuth), degree},
      {"pitch", "deg, nose up", one(p.attitude.pitch), degree},
      {"roll", "deg, right side down", one(p.attitude.roll), degree},
      {"speed", "m/s, negative in reverse", one(p.speed)},
      {"position_sigma", "m, east, north, up", three(p.position_sigma)},
      {"azimuth_sigma", "deg", one(p.azimuth_sigma), degree},
      {"tilt_sigma", "deg, pitch and roll", one(p.tilt_sigma), degree},
      {"speed_sigma", "m/s", one(p.speed_sigma)},
      {"fix_offset", "lasting error of fixes, in their own standard deviation",
       three(p.fix_offset)},
      {"fix_offset_sigma", "the same", three(p.fix_offset_sigma)},
      {"fix_offset_correlation", "with the position", three(p.fix_offset_correlation)},
  };
}

fusion::LastPlace read_place(const runtime::ConfigTable& table) {
  fusion::LastPlace place;
  place.stamp = read_time(table, "stamp");
  for (const auto& key : keys_of(place)) {
    if (!table.has(key.key)) table.fail(key.key, "is missing");
    if (key.values.size() == 1) {
      table.read(key.key, key.values.front());
    } else {
      table.read(key.key, key.values);
    }
    for (double& value : key.values) value *= key.per_unit;
  }
  return place;
}

std::string text_of(const fusion::LastPlace& place) {
  std::string text = "\n[place]  # of the body's origin, where this run ended or was last\n";
  text += "stamp = " + toml_text(format_time(place.stamp)) + '\n';
  for (const auto& key : keys_of(place)) {
    std::string numbers;
    for (const double value : key.values) {
      if (!numbers.empty()) numbers += ", ";
      numbers += runtime::shortest_text(value / key.per_unit);
    }
    if (key.values.size() > 1) numbers = fmt::format("[{}]", numbers);
    text += fmt::format("{} = {}  # {}\n", key.key, numbers, key.unit);
  }
  return text;
}

fusion::RememberedCalibration read_calibration(const runtime::ConfigTable& root) {
  fusion::RememberedCalibration remembered;
  remembered.at = read_time(root, "at");
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
  return remembered;
}

}  // namespace

std::optional<CarState> read_car_state(const std::filesystem::path& file, const std::string& car) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  std::string text;
  try {
    text = read_text(file, input_limits::settings);
  } catch (const FileError& error) {
    throw runtime::ConfigError(std::string(error.what()) + "; --state needs a file it may read");
  }
  std::string named;
  CarState state;
  try {
    const auto document = runtime::ConfigDocument::parse(text, file.string());
    const runtime::ConfigTable root = document.root();
    check_version(root, text);
    root.read("car", named);
    state.calibration = read_calibration(root);
    if (root.has("place")) state.place = read_place(root.table("place"));
    document.reject_unknown();
  } catch (const runtime::ConfigError& damage) {
    throw DamagedCarState(damage.what());
  }
  if (named != car) {
    throw runtime::ConfigError(fmt::format(
        "{}: car: is {}, but [vehicle] name of the configuration is {}: name another file with "
        "--state, one for each car",
        file.string(), toml_text(named), toml_text(car)));
  }
  return state;
}

std::size_t write_car_state(const std::filesystem::path& file, const std::string& car,
                            const CarEstimate& estimate) {
  std::string text =
      "# Where this car was, and what maploop has estimated of it; --state reads and replaces "
      "it.\n";
  text += fmt::format("version = {}\ncar = {}\nat = {}\n", version, toml_text(car),
                      toml_text(format_time(estimate.at)));
  std::size_t count = 0;
  if (estimate.place) {
    ++count;
    text += text_of(*estimate.place);
  }
  for (std::size_t i = 0; i < estimate.calibration.size(); ++i) {
    const fusion::CalibratedProperty& p = estimate.calibration[i];
    const bool known = p.sigma > 0.0 && estimate.before.sigma[i] > 0.0;
    if (!p.observed() && !known) continue;
    ++count;
    text += fmt::format("\n[{}]  # {}\nvalue = {}\nsigma = {}\nunit = {}\n", p.key, p.name,
                        runtime::shortest_text(p.value), runtime::shortest_text(p.sigma),
                        toml_text(p.unit));
  }
  if (count == 0) return 0;
  const std::string checksum = checksum_of(text);
  text.append(checksum_line).append(checksum).append(1, '\n');
  write_whole_file(file, text);
  return count;
}

}  // namespace maploop::vehicle
