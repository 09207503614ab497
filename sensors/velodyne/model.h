// This file lists the supported Velodyne scanners.
#pragma once

#include <optional>
#include <string_view>

namespace maploop::sensors {

enum class VelodyneModel { hdl64e, hdl32e, vlp16 };

constexpr std::string_view to_string(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::hdl64e:
      return "HDL-64E";
    case VelodyneModel::hdl32e:
      return "HDL-32E";
    default:
      return "VLP-16";
  }
}

// Finds a model by the name above; returns nothing if there is no such scanner.
constexpr std::optional<VelodyneModel> velodyne_model(std::string_view name) {
  for (const auto model : {VelodyneModel::hdl64e, VelodyneModel::hdl32e, VelodyneModel::vlp16}) {
    if (name == to_string(model)) return model;
  }
  return std::nullopt;
}

}  // namespace maploop::sensors
