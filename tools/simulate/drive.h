// Everything about a drive that is fixed before its first frame is taken.
#pragma once

#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/time.h"
#include "tools/simulate/scene/appearance.h"
#include "tools/simulate/scene/ray_scene.h"
#include "tools/simulate/sensors/calibration_errors.h"
#include "tools/simulate/sensors/simulated_car.h"
#include "tools/simulate/sensors/vehicle_motion.h"
#include "tools/simulate/simulation.h"
#include "tools/simulate/town/site.h"
#include "tools/simulate/town/streets.h"
#include "tools/simulate/town/terrain.h"

namespace maploop::simulate {

struct Drive {
  static constexpr double frame_interval = 0.1;  // s

  // Throws like choose_site().
  explicit Drive(const SimulationOptions& options);

  Time start;
  LocalFrame frame;
  Streets streets;
  Terrain terrain;
  StreetIndex index;
  Appearance appearance;
  SimulatedCar car;
  VehicleCalibration calibration;  // of the car
  CalibrationErrors errors;        // of the calibration
  VehicleMotion motion;
  std::vector<VehicleMotion> traffic;
  std::optional<World> world;
  std::vector<double> times;          // s, when the images of the frames are taken
  std::vector<double> turns;          // s, when the scanner's turns begin, one for each frame
  double turn_time = frame_interval;  // s

 private:
  Drive(const SimulationOptions& options, Site site);
};

}  // namespace maploop::simulate
