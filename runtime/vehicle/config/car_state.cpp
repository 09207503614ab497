#include "runtime/vehicle/config/car_state.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>

#include "msgs/frames.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "runtime/core/config.h"
#include "runtime/core/number_text.h"
#include "runtime/core/whole_file.h"

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

// Keys of [place] with the values and how many of the value's own unit a unit of the file is.
template <class Place>
auto numbers_of(Place& p) {
  struct Number {
    std::string_view key, unit;
    decltype(&p.speed) value;
    double per_unit;
  };
  const double degree = radians(1.0);
  return std::to_array<Number>({
      {"latitude", "deg", &p.position.latitude, degree},
      {"longitude", "deg", &p.position.longitude, degree},
      {"height", "m above the ellipsoid", &p.position.height, 1.0},
      {"azimuth", "deg, clockwise from north", &p.attitude.azimuth, degree},
      {"pitch", "deg, nose up", &p.attitude.pitch, degree},
      {"roll", "deg, right side down", &p.attitude.roll, degree},
      {"speed", "m/s, negative in reverse", &p.speed, 1.0},
      {"horizontal_sigma", "m, east and north", &p.horizontal_sigma, 1.0},
      {"up_sigma", "m", &p.up_sigma, 1.0},
      {"azimuth_sigma", "deg", &p.azimuth_sigma, degree},
      {"tilt_sigma", "deg, pitch and roll", &p.tilt_sigma, degree},
      {"speed_sigma", "m/s", &p.speed_sigma, 1.0},
  });
}

fusion::LastPlace read_place(const runtime::ConfigTable& table) {
  fusion::LastPlace place;
  place.stamp = read_time(table, "stamp");
  for (const auto& number : numbers_of(place)) {
    if (!table.has(number.key)) table.fail(number.key, "is missing");
    table.read(number.key, *number.value);
    *number.value *= number.per_unit;
  }
  return place;
}

std::string text_of(const fusion::LastPlace& place) {
  std::string text = "\n[place]  # of the body's origin, where this run ended or was last\n";
  text += "stamp = " + toml_text(format_time(place.stamp)) + '\n';
  for (const auto& number : numbers_of(place)) {
    text += fmt::format("{} = {}  # {}\n", number.key,
                        runtime::shortest_text(*number.value / number.per_unit), number.unit);
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
  const auto document = runtime::ConfigDocument::parse(text, file.string());
  const runtime::ConfigTable root = document.root();
  check_version(root, text);
  std::string named;
  root.read("car", named);
  if (named != car) {
    root.fail("car", "is " + toml_text(named) + ", but [vehicle] name of the configuration is " +
                         toml_text(car) + ": name another file with --state, one for each car");
  }
  CarState state{read_calibration(root), std::nullopt};
  if (root.has("place")) state.place = read_place(root.table("place"));
  document.reject_unknown();
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
  runtime::write_whole_file(file, text);
  return count;
}

}  // namespace maploop::vehicle
