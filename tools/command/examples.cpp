#include "tools/command/examples.h"

#include <array>
#include <vector>

namespace maploop::tools {
namespace {

struct Examples {
  std::string_view command;
  std::vector<std::string_view> lines;  // what follows the program's name
};

const std::array all{
    Examples{"",
             {"replay DRIVE --report drive.html", "match town.osm.pbf track.gpx --html match.html",
              "ppp drive.21o.gz brdc.21n.gz --pos drive.pos", "live car.toml --record run.lcmlog",
              "replay DRIVE --lockstep --json drive.json"}},
    Examples{"analyze", {"analyze run.lcmlog", "analyze run.lcmlog --cpus 4 --margin 1.5"}},
    Examples{"calibrate",
             {"calibrate PICTURES --board 9x6 --square 0.04 --html calibration.html",
              "calibrate 'left*.png' 'right*.png' --board 9x6 --square 0.04",
              "calibrate extrinsics DRIVE --toml vehicle.toml"}},
    Examples{"calibrate extrinsics",
             {"calibrate extrinsics DRIVE",
              "calibrate extrinsics DRIVE --config vehicle.toml --end 120"}},
    Examples{"dashboard", {"dashboard", "dashboard --port 8080 --map town.net"}},
    Examples{"doctor",
             {"doctor DRIVE --html drive.html", "doctor --realtime",
              "doctor drive.bag --topic camera.left=/left/image_raw"}},
    Examples{"evaluate",
             {"evaluate est.txt truth.txt --lengths 100",
              "evaluate a.tum b.tum --truth truth.tum --align se3 --html both.html",
              "evaluate rtk.pos ppp.pos --truth truth.pos --align none --table markdown"}},
    Examples{"evaluate match", {"evaluate match matched.csv labels.csv"}},
    Examples{"experiment", {"experiment match town.osm.pbf DATA --sequences 01,06"}},
    Examples{"experiment map-faults",
             {"experiment map-faults town.osm.pbf DATA --sequences 06 --seeds 5"}},
    Examples{"experiment match",
             {"experiment match town.osm.pbf DATA --sequences 01,06 --json match.json"}},
    Examples{"experiment rules",
             {"experiment rules town.osm.pbf DATA --sequences 00,02,03,04 --learn RULES"}},
    Examples{"gnss", {"gnss info drive.21o.gz brdc.21n.gz"}},
    Examples{"gnss info", {"gnss info drive.21o.gz brdc.21n.gz", "gnss info *"}},
    Examples{"live",
             {"live car.toml --record run.lcmlog", "live car.toml --map town.net --black-box box",
              "live car.toml --seconds 60 --report run.html"}},
    Examples{"log",
             {"log info run.lcmlog", "log convert run.lcmlog -o run.mcap",
              "log split run.lcmlog --start 10 --end 20 -o part.lcmlog"}},
    Examples{"log info", {"log info run.lcmlog", "log info run.mcap --json run.json"}},
    Examples{"log verify", {"log verify run.lcmlog"}},
    Examples{"log split",
             {"log split run.lcmlog --start 10 --end 20 -o part.lcmlog",
              "log split run.lcmlog --channels 'NAV_STATE|TRUTH' -o states.lcmlog"}},
    Examples{"log merge", {"log merge front.lcmlog rear.lcmlog -o both.lcmlog"}},
    Examples{"log convert",
             {"log convert run.lcmlog -o run.mcap", "log convert run.lcmlog -o run.bag"}},
    Examples{"log recover", {"log recover broken.lcmlog -o whole.lcmlog"}},
    Examples{"log blackbox", {"log blackbox BOX -o run.lcmlog", "log blackbox BOX --freeze"}},
    Examples{"log diff", {"log diff before.lcmlog after.lcmlog --channels NAV_STATE"}},
    Examples{"map",
             {"map build town.osm.pbf town.net", "map info town.net",
              "map doubts town.net tracks/*.gpx -o doubts.geojson"}},
    Examples{"map build",
             {"map build town.osm.pbf town.net",
              "map build country.osm.pbf town.net --box 8.3,48.9,8.6,49.1"}},
    Examples{"map doubts", {"map doubts town.net tracks/*.gpx -o doubts.geojson"}},
    Examples{"map info", {"map info town.net", "map info town.osm.pbf --json town.json"}},
    Examples{"match",
             {"match town.osm.pbf track.gpx --html match.html",
              "match town.net run.lcmlog --csv matched.csv",
              "match town.net tracks/*.gpx --whole --csv matched"}},
    Examples{"odometry",
             {"odometry DRIVE --poses est.txt", "odometry DRIVE --lidar --cloud street.ply",
              "odometry SCANS --lidar --save-map map.pcd"}},
    Examples{"ppp",
             {"ppp drive.21o.gz brdc.21n.gz --html drive.html",
              "ppp drive.21o.gz *.SP3.gz *.CLK.gz *.atx.gz --pos out.pos",
              "ppp drive.21o.gz brdc.21n.gz --direction smoothed --kml drive.kml"}},
    Examples{"profile",
             {"profile run.lcmlog --html times.html", "profile new.lcmlog --compare old.lcmlog",
              "profile --live --seconds 60"}},
    Examples{"replay",
             {"replay 2011_09_26/2011_09_26_drive_0013_sync --report drive.html",
              "replay DRIVE --lockstep --json drive.json",
              "replay DRIVE --map town.net --record run.lcmlog"}},
    Examples{"send", {"send DRIVE --velodyne udp://:2368 --imu udp://:3000 --gnss udp://:4000"}},
    Examples{"sensors", {"sensors car.toml --seconds 10", "sensors pcap scans.pcap --scans SCANS"}},
    Examples{"sensors pcap", {"sensors pcap scans.pcap --model VLP-16 --scans SCANS"}},
    Examples{"sensors listen", {"sensors listen --velodyne udp://:2368 --seconds 10"}},
    Examples{"simulate",
             {"simulate --seconds 60 --out TOWN",
              "simulate --environment urban --sensors gnss --seed 2 --out TOWN",
              "simulate --car drawn --scanner vlp-16 --compact --out TOWN"}},
    Examples{"spy", {"spy", "spy run.lcmlog", "spy --filter NAV_STATE --once"}},
    Examples{"vehicle",
             {"vehicle new car.toml", "vehicle check car.toml", "vehicle draw car.toml car.svg"}},
    Examples{"vehicle new", {"vehicle new car.toml"}},
    Examples{"vehicle check", {"vehicle check car.toml"}},
    Examples{"vehicle draw", {"vehicle draw car.toml car.svg"}},
    Examples{"vehicle convert", {"vehicle convert kitti 2011_09_26 car.toml"}},
};

}  // namespace

std::vector<std::string_view> examples(std::string_view command) {
  for (const Examples& each : all)
    if (each.command == command) return each.lines;
  return {};
}

}  // namespace maploop::tools
