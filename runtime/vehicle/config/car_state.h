// Keeps where a car was, and what the filter has estimated of it, in a file, so that the next drive
// starts with it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "estimators/fusion/last_place.h"
#include "estimators/fusion/self_calibration.h"

namespace maploop::vehicle {

struct CarState {
  fusion::RememberedCalibration calibration;
  std::optional<fusion::LastPlace> place;
};

// Returns what the file says of the car of that name; nothing if there is no such file. Throws
// std::runtime_error (runtime::ConfigError) that names file, line and key of what is wrong, and if
// the file is of a car with another name, of another version, or was changed since it was written.
// (Files of the first version have neither a place nor a checksum.)
std::optional<CarState> read_car_state(const std::filesystem::path& file, const std::string& car);

// What is to be written, as of the time `at`.
struct CarEstimate {
  Time at{};
  fusion::SelfCalibrations calibration;
  std::optional<fusion::LastPlace> place;
  // What the drive began with: such a property is kept even where this drive has not observed it.
  fusion::RememberedCalibration before;
};

// Writes the place, and the properties that have been observed, in place of an earlier file.
// Returns the number of both together; without any, nothing is written. Throws std::runtime_error
// that names the file and states what to do.
std::size_t write_car_state(const std::filesystem::path& file, const std::string& car,
                            const CarEstimate& estimate);

}  // namespace maploop::vehicle
