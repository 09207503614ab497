// Keeps where a car was, and what the filter has estimated of it, in a file, so that the next drive
// starts with it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "estimators/fusion/last_place.h"
#include "estimators/fusion/self_calibration.h"

namespace maploop::vehicle {

struct CarState {
  fusion::RememberedCalibration calibration;
  std::optional<fusion::LastPlace> place;
};

// Names file, line and key of what is wrong: the file is of another version, cut off, or was
// changed since it was written.
class DamagedCarState : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns what the file says of the car of that name; nothing if there is no such file. Throws
// DamagedCarState, and another std::runtime_error if the file cannot be read or is of a car with
// another name. (Files of the first version have neither a place nor a checksum.)
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
