// The whole vehicle on a recording.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/command/options.h"
#include "tools/python/arrays.h"
#include "tools/python/opened_recording.h"
#include "tools/python/state_record.h"
#include "tools/replay/recording_run.h"
#include "tools/replay/run_pass.h"

namespace maploop::python {
namespace {

// Gives states to the user's function, on the publisher's thread.
class StateCallback {
 public:
  explicit StateCallback(const py::object& function) : function_(function) {}

  void call(const StateRecord& state) {
    if (function_.is_none() || failed_) return;
    const py::gil_scoped_acquire acquired;
    keep_error([&] { function_(scalar_of(state)); });
  }

  // Returns false after an error, or when the user has interrupted the program.
  bool go_on() {
    const py::gil_scoped_acquire acquired;
    keep_error([] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    return !failed_;
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  template <class F>
  void keep_error(F&& f) {
    try {
      f();
    } catch (py::error_already_set&) {
      if (!failed_) error_ = std::current_exception();
      failed_ = true;
    }
  }

  const py::object& function_;
  std::exception_ptr error_;  // with Python's lock
  std::atomic<bool> failed_ = false;
};

struct PythonReplay {
  std::vector<StateRecord> states;
  std::string json;
  std::string verdict;
};

PythonReplay run(const OpenedRecording& opened, const std::filesystem::path& map,
                 std::optional<vehicle::MapMode> mode, double end, bool keep_states,
                 StateCallback& callback) {
  const py::gil_scoped_release released;
  vehicle::VehicleConfig config = opened.config;
  tools::set_map(config.map, map, mode);
  const auto roads = vehicle::load_road_map(config.map);
  PythonReplay replay;
  tools::RunPass pass;
  vehicle::Observer observer = pass.observer();
  observer.nav_state = [&, also = std::move(observer.nav_state)](const FusedState& state) {
    also(state);
    const StateRecord record = record_of(state);
    if (keep_states) replay.states.push_back(record);
    callback.call(record);
  };
  tools::RecordingRunOptions options;
  options.end = end;
  options.sinks = {&pass.hashes};
  options.go_on = [&] { return callback.go_on(); };
  const tools::RecordingRun run =
      tools::run_recording(opened.recording, config, options, std::move(observer), roads);
  tools::ReplayResult result = tools::result_of(pass, run.report);
  result.drive = opened.path.filename().string();
  result.configuration = config.configuration;
  result.lockstep = true;
  tools::score(result, pass, run.recording, run.reference, roads.get());
  replay.json =
      tools::to_json(result).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  replay.verdict = tools::verdict_text(result);
  return replay;
}

py::object replay(const OpenedRecording& recording, const std::filesystem::path& map,
                  const std::optional<std::string>& map_mode, double end, bool keep_states,
                  const py::object& on_state) {
  std::optional<vehicle::MapMode> mode;
  if (map_mode) {
    mode = value_named<vehicle::MapMode>(*map_mode);
    if (!mode)
      throw py::value_error("map_mode is none, loose, tight or hard-reset, not " + *map_mode);
  }
  StateCallback callback(on_state);
  PythonReplay done = run(recording, map, mode, end, keep_states, callback);
  callback.rethrow();
  const py::object figures = py::module_::import("json").attr("loads")(done.json);
  return py::module_::import("types").attr("SimpleNamespace")(
      py::arg("states") = array_of(std::move(done.states)), py::arg("figures") = figures,
      py::arg("verdict") = done.verdict);
}

}  // namespace

void add_replay(py::module_& module) {
  module.def("replay", &replay, py::arg("recording"), py::kw_only(), py::arg("map") = "",
             py::arg("map_mode") = py::none(), py::arg("end") = 0.0, py::arg("keep_states") = true,
             py::arg("on_state") = py::none(),
             R"(Replays a Recording through the vehicle, as `maploop replay --lockstep` does.

map: an OpenStreetMap or network file. map_mode: none, loose, tight or hard-reset.
end: s into the drive; 0: the whole drive.
on_state: called with each state, an element of state_dtype, on another thread while it runs; an
exception ends the replay.
Returns an object with states ((n,) state_dtype, 100 a second, 0.9 kB each; empty without
keep_states), figures (a dict, as --json writes it) and verdict (text). Raises RuntimeError.)");
}

}  // namespace maploop::python
