#include "runtime/vehicle/vehicle_config.h"

#include <array>
#include <charconv>
#include <concepts>

#include "runtime/core/config.h"
#include "runtime/vehicle/config_fields.h"

namespace maploop::vehicle {
namespace {

void read_value(const runtime::ConfigTable& table, const char* key, auto& value) {
  if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, std::int64_t>) {
    int small = static_cast<int>(value);
    table.read(key, small);
    value = small;
  } else if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, runtime::Scheduling>) {
    vehicle::read(table, key, value);
  } else {
    table.read(key, value);
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string number(auto value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string toml_value(const std::string& text) {
  return quoted(text);
}
std::string toml_value(bool value) {
  return value ? "true" : "false";
}
std::string toml_value(std::integral auto value) {
  return number(value);
}
std::string toml_value(double value) {
  std::string text = number(value);
  // TOML takes a number without point and exponent for an integer.
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

VehicleConfig load_vehicle_config(const std::filesystem::path& file) {
  VehicleConfig config;
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  runtime::ConfigTable table = document.root();
  visit(
      config, [&](const char* name) { table = document.root().table(name); },
      [&](const char* key, auto& value) { read_value(table, key, value); });
  document.reject_unknown();
  return config;
}

std::string to_toml(const VehicleConfig& config) {
  std::string text;
  visit(
      config, [&](const char* name) { text += "\n[" + std::string(name) + "]\n"; },
      [&](const char* key, const auto& value) {
        text += std::string(key) + " = " + toml_value(value) + '\n';
      });
  return text;
}

}  // namespace maploop::vehicle
