// maploop doctor: how ready this machine is for real time, or how sound a recording is.
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/core/realtime.h"
#include "runtime/core/thread.h"
#include "runtime/core/utc_discipline.h"
#include "runtime/vehicle/config/scheduling_config.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/command/terminal.h"
#include "tools/doctor/memory_report.h"
#include "tools/doctor/recording_health.h"
#include "tools/doctor/recording_report.h"
#include "tools/doctor/saturation.h"
#include "tools/doctor/time_offsets.h"
#include "tools/evaluate/text_file.h"
#include "tools/replay/figures.h"

namespace maploop::tools {
namespace {

struct DoctorOptions {
  std::filesystem::path config;
  std::filesystem::path json, html;
  std::string lcm_url;
  std::filesystem::path recording;  // empty: the machine is examined
  std::vector<std::string> settings, topics;
};

// Asks the kernel for each thread of the graph as a paced replay would.
void ask_for_threads(const vehicle::VehicleConfig& config, runtime::RealtimeReport& report) {
  for (const vehicle::ScheduledThread& asked : vehicle::scheduled_threads()) {
    const runtime::Thread thread(
        asked.key, config.scheduling.*asked.scheduling, {}, [](const std::stop_token&) {}, [] {});
    runtime::append(report, thread.settings());
  }
}

std::vector<RealtimeSetting> ask_for_bus(const std::string& url) {
  try {
    return vehicle::LcmBus(url).settings();
  } catch (const std::runtime_error& e) {
    return {{"LCM: bus", url, "none", Verdict::refused, e.what(),
             "correct --lcm-url or the route, or run maploop replay --no-lcm"}};
  }
}

void append(std::vector<std::string>& sentences, std::vector<std::string> more) {
  for (std::string& sentence : more) sentences.push_back(std::move(sentence));
}

// Adds what is measured over 20 s, and what stands in the way of it.
std::vector<TimeOffset> compare_stamps(const vehicle::Recording& recording,
                                       const vehicle::VehicleConfig& config,
                                       const std::string& path,
                                       std::vector<std::string>& sentences) {
  append(sentences, cut_off_axes(recording));
  try {
    const extrinsics::Stretch stretch = turning_stretch(recording);
    append(sentences, cut_off_images(recording, stretch));
    Progress progress("s of data whose stamps are compared");
    std::vector<TimeOffset> offsets = time_offsets(recording, config, stretch, [&](Time at) {
      progress.at(to_seconds(at - stretch.from), to_seconds(stretch.to - stretch.from));
    });
    append(sentences, advice(offsets, path));
    return offsets;
  } catch (const std::invalid_argument& e) {
    sentences.push_back(std::string("Stamps are not compared: ") + e.what() + '.');
    return {};
  }
}

double seconds_of(const vehicle::Recording& recording) {
  return to_seconds(recording.last_stamp - recording.first_stamp);
}

std::vector<SensorHealth> examined(const vehicle::Recording& recording) {
  std::optional<Progress> progress;
  std::string_view read;  // the sensor whose progress it is
  return examine(recording, [&](const char* sensor, Time at) {
    if (read != sensor) progress.emplace(std::string("s of ") + sensor);
    read = sensor;
    progress->at(to_seconds(at - recording.first_stamp), seconds_of(recording));
  });
}

void examine_recording(const DoctorOptions& options, vehicle::VehicleConfig config) {
  const vehicle::KnownContents contents = vehicle::fit_to_recording(config, options.recording);
  const vehicle::Recording recording = vehicle::open_recording(options.recording, config, contents);
  RecordingReport report{options.recording.string(), recording.first_stamp, recording.last_stamp};
  report.sensors = examined(recording);
  report.sentences = recording.notes;
  append(report.sentences, advice(report.sensors, report.name));
  report.offsets = compare_stamps(recording, config, report.name, report.sentences);
  std::cout << to_text(report);
  if (!options.json.empty()) write_json_file(options.json, to_json(report));
  if (!options.html.empty()) evaluation::write_text(options.html, to_html(report));
}

int doctor(const DoctorOptions& options) {
  vehicle::VehicleConfig config =
      vehicle::load_vehicle_config(options.config, options.settings, options.topics);
  if (!options.recording.empty()) {
    examine_recording(options, std::move(config));
    return 0;
  }
  runtime::RealtimeReport report = runtime::prepare_process(config.memory);
  runtime::append(report, {runtime::assess_utc()});
  ask_for_threads(config, report);
  runtime::append(report, ask_for_bus(vehicle::bus_url(options.lcm_url, config.lcm_url)));
  const MemoryReport memory = memory_report(config);
  std::cout << in_colour(STDOUT_FILENO, runtime::to_text(report)) << to_text(memory);
  if (!options.json.empty()) {
    write_json_file(options.json, {{"all_granted", report.all_granted()},
                                   {"memory", to_json(memory)},
                                   {"settings", web::list(setting_columns, report.settings)}});
  }
  return 0;
}

}  // namespace

void add_doctor(CLI::App& app, Command& command) {
  const auto [sub, options] =
      add_command(app, command, "doctor",
                  "Say what a recording contains and how sound it is; or ask this machine for all "
                  "that a replay in real time asks for, and say what it grants, what not, and why",
                  doctor);
  CLI::Option* recording =
      sub->add_option("RECORDING", options.recording,
                      "Whatever maploop replay takes. Without it, the machine is examined");
  sub->add_flag("--realtime")
      ->description("Examine the machine, as without RECORDING")
      ->excludes(recording);
  add_topics(sub, options.topics);
  add_config(sub, options.config);
  add_settings(sub, options.settings);
  add_lcm_url(sub, options.lcm_url);
  add_output(sub, "--json", options.json, "Write the report to this file as JSON");
  add_output(sub, "--html", options.html,
             "Write a page with the time lines of the recording's sensors to this file")
      ->needs(recording);
}

}  // namespace maploop::tools
