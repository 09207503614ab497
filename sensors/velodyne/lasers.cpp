#include "sensors/velodyne/lasers.h"

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

Laser at_elevation(double degrees_up, double upwards) {
  Laser laser;
  laser.cos_elevation = std::cos(radians(degrees_up));
  laser.sin_elevation = std::sin(radians(degrees_up));
  laser.upwards = upwards;
  return laser;
}

std::vector<Laser> vlp16() {
  // The table is in degrees and mm: VLP-16 user's manual (63-9243 Rev. E), table 9-1.
  constexpr std::array<std::array<double, 2>, 16> table{{{-15, 11.2},
                                                         {1, -0.7},
                                                         {-13, 9.7},
                                                         {3, -2.2},
                                                         {-11, 8.1},
                                                         {5, -3.7},
                                                         {-9, 6.6},
                                                         {7, -5.1},
                                                         {-7, 5.1},
                                                         {9, -6.6},
                                                         {-5, 3.7},
                                                         {11, -8.1},
                                                         {-3, 2.2},
                                                         {13, -9.7},
                                                         {-1, 0.7},
                                                         {15, -11.2}}};
  std::vector<Laser> lasers;
  for (const auto& [elevation, offset] : table) {
    lasers.push_back(at_elevation(elevation, 1e-3 * offset));
  }
  return lasers;
}

std::vector<Laser> hdl32e() {
  // Every second laser belongs to the lower half; lasers are 4/3 of a degree apart (user's manual,
  // appendix A).
  std::vector<Laser> lasers;
  for (int i = 0; i < 16; ++i) {
    lasers.push_back(at_elevation(-92.0 / 3.0 + i * 4.0 / 3.0, 0.0));
    lasers.push_back(at_elevation(-28.0 / 3.0 + i * 4.0 / 3.0, 0.0));
  }
  return lasers;
}

// Returns a value of a laser's entry; throws if its magnitude exceeds `largest`.
double value(const boost::property_tree::ptree& entry, const char* key, double largest) {
  const double v = entry.get<double>(key);
  if (!(std::fabs(v) <= largest)) {
    throw std::invalid_argument(std::string(key) + " is " + entry.get<std::string>(key));
  }
  return v;
}

Laser laser_of(const boost::property_tree::ptree& entry) {
  constexpr double cm = 1e-2;
  const double elevation = radians(value(entry, "vertCorrection_", 90.0));
  const double azimuth = radians(value(entry, "rotCorrection_", 360.0));
  const double vertical_offset = cm * value(entry, "vertOffsetCorrection_", 100.0);
  Laser laser;
  laser.cos_elevation = std::cos(elevation);
  laser.sin_elevation = std::sin(elevation);
  laser.cos_azimuth_correction = std::cos(azimuth);
  laser.sin_azimuth_correction = std::sin(azimuth);
  laser.range_correction = cm * value(entry, "distCorrection_", 1000.0);
  laser.outwards = -vertical_offset * laser.sin_elevation;
  laser.sideways = cm * value(entry, "horizOffsetCorrection_", 100.0);
  laser.upwards = vertical_offset * laser.cos_elevation;
  return laser;
}

std::vector<Laser> parse_calibration(const std::string& text, std::size_t count) {
  boost::property_tree::ptree tree;
  std::istringstream stream(text);
  try {
    read_xml(stream, tree);
  } catch (const boost::property_tree::xml_parser_error& e) {
    throw std::runtime_error("is not a calibration of a scanner: line " + std::to_string(e.line()) +
                             ": " + e.message());
  }
  std::vector<Laser> lasers(count);
  std::vector<bool> found(count, false);
  for (const auto& [name, item] : tree.get_child("boost_serialization.DB.points_")) {
    if (name != "item") continue;
    const auto& entry = item.get_child("px");
    const std::size_t id = entry.get<std::size_t>("id_");
    if (id >= count) continue;  // the files of all models have 64 entries
    if (found[id]) throw std::invalid_argument("has laser " + std::to_string(id) + " twice");
    try {
      lasers[id] = laser_of(entry);
    } catch (const std::exception& error) {
      throw std::invalid_argument("laser " + std::to_string(id) + ": " + error.what());
    }
    found[id] = true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!found[i]) throw std::invalid_argument("has no laser " + std::to_string(i));
  }
  return lasers;
}

}  // namespace

std::size_t laser_count(VelodyneModel model) {
  return model == VelodyneModel::hdl64e ? 64 : model == VelodyneModel::hdl32e ? 32 : 16;
}

std::vector<Laser> factory_lasers(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::vlp16:
      return vlp16();
    case VelodyneModel::hdl32e:
      return hdl32e();
    default:
      throw std::invalid_argument(
          "each HDL-64E has its own lasers: give the calibration file that came with it (db.xml)");
  }
}

std::vector<Laser> read_velodyne_calibration(const std::filesystem::path& file,
                                             VelodyneModel model) {
  try {
    return parse_calibration(read_text(file), laser_count(model));
  } catch (const FileError& error) {
    throw std::runtime_error("the Velodyne calibration '" + file.string() + "': " + error.reason());
  } catch (const std::exception& error) {
    throw std::runtime_error("the Velodyne calibration '" + file.string() + "' " + error.what());
  }
}

}  // namespace maploop::sensors
