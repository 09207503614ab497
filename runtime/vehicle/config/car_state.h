// Keeps what the filter has estimated of a car in a file, so that the next drive starts with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "estimators/fusion/self_calibration.h"

namespace maploop::vehicle {

// Returns what the file says of the car of that name; nothing if there is no such file. Throws
// std::runtime_error (runtime::ConfigError) that names file, line and key of what is wrong, and if
// the file is of a car with another name.
std::optional<fusion::RememberedCalibration> read_car_state(const std::filesystem::path& file,
                                                            const std::string& car);

// Writes the properties that have been observed, in place of an earlier file. `at` is the time of
// the estimate. Returns their number; without any, nothing is written. Throws std::runtime_error
// that names the file and states what to do.
std::size_t write_car_state(const std::filesystem::path& file, const std::string& car, Time at,
                            const fusion::SelfCalibrations& estimated);

}  // namespace maploop::vehicle
