// What a run of the vehicle, live or recorded, can be asked for: where it sends its messages, and
// what it writes at its end.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "runtime/core/realtime.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "runtime/vehicle/output/runs.h"
#include "tools/command/commands.h"
#include "tools/replay/car_memory.h"
#include "tools/replay/run_pass.h"

namespace maploop::tools {

// Files that are empty are not written.
// The frame of the written poses: `map` is absolute and may jump, `odom` is continuous and drifts.
enum class OutputFrame : std::uint8_t { map, odom };

constexpr auto names_of(OutputFrame) {
  return names_up_to<OutputFrame::odom>({"map", "odom"});
}

struct RunOptions {
  std::filesystem::path config;
  std::vector<std::string> settings;  // TABLE.KEY=VALUE
  bool verbose = false;               // the tables at the end, and every real-time setting
  std::filesystem::path record;
  bool record_raw = false;
  std::filesystem::path black_box;
  std::uint64_t black_box_size = 1000;  // MB
  bool no_lcm = false;
  std::string lcm_url;  // empty: vehicle::bus_url() chooses one
  std::filesystem::path json, report, trace;
  WritePage* write_page = nullptr;              // that report is written by
  std::filesystem::path state;                  // what is kept of the car
  std::filesystem::path poses, tum, csv, nmea;  // of the fused state
  std::optional<OutputFrame> frame;             // of poses and tum; map without it
  std::filesystem::path map;
  std::optional<vehicle::MapMode> map_mode;

  bool states() const { return !(poses.empty() && tum.empty() && csv.empty() && nmea.empty()); }
};

// Adds all of them but the configuration; --report if there is `write_page`.
void add_run_options(CLI::App* sub, RunOptions& options, WritePage* write_page);

class RunOutput {
 public:
  // `what` describes the run to others on the bus. The options and the configuration must outlive
  // this.
  RunOutput(const RunOptions& options, const vehicle::VehicleConfig& config, std::string what)
      : options_(options),
        config_(config),
        run_(vehicle::new_run(std::move(what))),
        car_(options.state, config) {}

  const std::string& run() const { return run_.id; }

  // Opens the bus unless --no-lcm is given, and announces the run on it until write(). Returns what
  // the kernel granted for it. Throws std::runtime_error if LCM cannot open it.
  std::vector<RealtimeSetting> open_bus();
  // nullptr without a bus.
  vehicle::LcmBus* bus() { return bus_.get(); }
  vehicle::RunPresence* presence() { return presence_ ? &*presence_ : nullptr; }

  // Returns the memory of the car, which --state names.
  CarMemory& car() { return car_; }

  // Returns the sinks of the run's messages: the hashes, the bus and the log.
  std::vector<vehicle::MessageSink*> sinks(RunPass& pass, vehicle::LogRecorder::WhenBehind behind);
  // Lets the vehicle save itself in the black box of this pass, if one was asked for, and PPP in
  // what is kept of the car; before start().
  void take_snapshots(vehicle::Vehicle& vehicle, RunPass& pass);
  // Returns a new tracer, which replaces the one before; nullptr without --trace. Throws
  // std::runtime_error if its file cannot be written.
  runtime::Tracer* new_tracer();

  // Fills what the result of any run contains.
  ReplayResult result(const vehicle::Vehicle& vehicle, const RunPass& pass) const;

  // Writes the files that were asked for, then prints the verdict, with the tables if --verbose is
  // given. A file that cannot be written is reported on standard error; the others are written all
  // the same. Returns whether the run itself and all of its output are complete.
  bool write(const ReplayResult& result, const RunPass& pass, const VehicleCalibration& calibration,
             std::vector<ReferencePose> reference, const vehicle::RoadMap* map);

 private:
  const RunOptions& options_;
  const vehicle::VehicleConfig& config_;
  vehicle::Run run_;
  std::unique_ptr<vehicle::LcmBus> bus_;
  std::optional<vehicle::RunPresence> presence_;
  std::unique_ptr<runtime::Tracer> tracer_;
  CarMemory car_;
};

}  // namespace maploop::tools
