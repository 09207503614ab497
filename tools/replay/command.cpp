// maploop replay: a recorded drive through the whole graph.
#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>

#include "estimators/fusion/configuration.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "runtime/vehicle/faults/fault_rules.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/output_check.h"
#include "tools/replay/replay_run.h"

namespace maploop::tools {

namespace {

SnapshotRequest parse_snapshot(const std::string& text) {
  const std::size_t colon = text.find(':');
  SnapshotRequest request{-1.0, colon == std::string::npos ? "" : text.substr(colon + 1)};
  const char* end = text.data() + std::min(colon, text.size());
  const auto [stopped, error] = std::from_chars(text.data(), end, request.seconds);
  if (error != std::errc{} || stopped != end || !(request.seconds > 0.0 && request.seconds < 1e6) ||
      request.file.empty()) {
    throw std::invalid_argument("'" + text +
                                "' is not SECONDS:FILE, seconds above 0, such as 8:drive.snapshot");
  }
  return request;
}

}  // namespace

void add_replay(CLI::App& app, Command& command, WritePage* write_page) {
  const auto [sub, options] = add_command(
      app, command, "replay",
      "Replay a KITTI raw drive, a KITTI odometry sequence, KITTI-360, EuRoC, a folder of images, "
      "clouds or tables, a GNSS receiver's observations, a ROS bag, an MCAP file, a capture of a "
      "Velodyne scanner or a log of our own through the graph",
      replay);
  sub->add_option(
         "DRIVE", options.drive,
         "Folder such as 2011_09_26/2011_09_26_drive_0013_sync, a table of OXTS rows such as "
         "kitti_odometry/oxts/06.csv.gz, RINEX observations with their products beside "
         "them (or a folder of both; [ppp] products), a ROS 1 bag, a rosbag2 folder or an MCAP "
         "file, a folder with gnss.csv or maploop.tables.toml, a capture (.pcap), or a log "
         "(--record); one "
         "without images is replayed from its odometry (sensors/FORMATS.md)")
      ->required();
  auto* speed = sub->add_option("--speed", options.speed, "Times real time")
                    ->check(positive_number())
                    ->capture_default_str();
  auto* lockstep =
      sub->add_flag("--lockstep", options.lockstep,
                    "On virtual time: no sleeping, no dropping, as fast as the graph goes")
          ->excludes(speed);
  sub->add_option("--start", options.start, "Go through the first seconds as fast as the graph can")
      ->check(number_from_zero())
      ->excludes(lockstep);
  sub->add_option("--end", options.end, "End this many seconds into the drive")
      ->check(positive_number());
  sub->add_flag("--paused", options.playback.paused, "Wait for the space bar at the start")
      ->excludes(lockstep);
  sub->add_flag("--until-miss", options.playback.until_miss, "Pause at the first missed deadline")
      ->excludes(lockstep);
  sub->add_option("--loop", options.loop,
                  "Play so many times, 0: until it is stopped; results and --record are of the "
                  "last time")
      ->check(whole_number())
      ->capture_default_str();
  add_run_options(sub, options, write_page);
  add_config(sub, options.config);
  sub->add_option_function<std::string>(
         "--snapshot",
         [&snapshot = options.snapshot](const std::string& text) {
           snapshot = parse_snapshot(text);
         },
         "SECONDS:FILE: save everything at this moment of the drive, and go on")
      ->check(parsed_by(parse_snapshot, "SECONDS:FILE"))
      ->check(output_place(OutputName::after_colon));
  sub->add_option("--resume", options.resume,
                  "Go on from a snapshot of the same drive, with the same bits")
      ->check(existing_file());
  sub->add_option(
         "--configuration", options.configuration,
         "What joins the inertial sensors: auto (all that is there), VO-RI, VO-L-RI, RISS, "
         "RISS-VO or RI; GNSS+ before it: fixes are used after the start too; GNSS: fixes "
         "alone. Without it, --speed-scale means RISS, and --gnss-outage adds GNSS+")
      ->check(parsed_by(fusion::configuration, "NAME"));
  sub->add_option("--gnss-outage", options.gnss_outage,
                  "START:LENGTH[,...] in seconds into the drive, LENGTH may be end; "
                  "repeated:START:LENGTH for one after another, with a minute between; "
                  "random:COUNT:LENGTH for some that the seed draws")
      ->check(vehicle::check_outages, "OUTAGES");
  sub->add_option("--odometry-poses", options.odometry_poses,
                  "Another system's trajectory of a KITTI odometry sequence (the left camera's "
                  "poses, 12 numbers a line) in place of visual odometry")
      ->check(existing_file());
  add_topics(sub, options.topics);
  sub->add_option("--imu", options.imu,
                  "The inertial sensors as recorded, or with the noise of a MEMS unit added")
      ->check(CLI::IsMember({"recorded", "mems"}));
  sub->add_option("--speed-scale", options.speed_scale,
                  "Scale of the wheels' speed, 1.01: 1 % too much")
      ->check(number_in(0.5, 1.5));
  sub->add_flag("--start-from-reference", options.start_from_reference,
                "Start from the reference's first pose instead of a fix: dead reckoning alone is "
                "scored");
  sub->add_option("--seed", options.seed,
                  "Seed of all simulated noise: GNSS, wheels, inertial sensors, random outages");
  sub->add_option_function<std::vector<std::string>>(
         "--fault",
         [&faults = options.faults](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) faults.push_back(vehicle::parse_fault(text));
         },
         "Inject KIND@TARGET[:START[:LENGTH]][,key=value...]; more than once for more faults. "
         "Kinds: " +
             vehicle::fault_kinds() + " (runtime/vehicle/FAULTS.md)")
      ->allow_extra_args(false)
      ->check(parsed_by(vehicle::parse_fault, "FAULT"));
  sub->add_option("--truth", options.truth,
                  "Score odometry and both outputs, as ways of the left camera, against this truth "
                  "with stamps (TUM, *.truth.csv) in place of the recording's reference")
      ->check(CLI::ExistingFile);
  sub->add_option("--score-from", options.score_from,
                  "Score the drive from so many seconds into it; outages are scored as they are")
      ->check(number_from_zero());
  add_choice(sub, "--map-fault", options.map_fault,
             "A map that is wrong: the way driven longest is missing, all is shifted to the east, "
             "one-way streets are reversed, or each road driven has a second one to its right");
  sub->add_option_function<std::string>(
         "--misdescribe",
         [&wrong = options.misdescribed](const std::string& name) { wrong = property_named(name); },
         "Describe the car wrongly, by 0.5 m, 1 degree or 30 ms, to a side that --seed draws: "
         "antenna, inertial-mount, camera, rear-axle, inertial-stamps, gnss-stamps, "
         "camera-stamps or everything; nothing: rightly, with places that are as certain")
      ->check(parsed_by(property_named, "PROPERTY"));
}

}  // namespace maploop::tools
