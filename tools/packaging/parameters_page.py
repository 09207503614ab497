#!/usr/bin/env python3
"""Writes PARAMETERS.md: every parameter whose value was chosen on data, and which figures therefore are not unseen.

    parameters_page.py ROOT            writes ROOT/tools/PARAMETERS.md
    parameters_page.py ROOT --check    status 1 where that would change anything

The list CHOSEN below is the one place where such a choice is written down. Values are read from where the program
has them, so that the page cannot be stale.
"""
import os
import re
import sys

from configuration_page import tables

HEAD = """# Parameters whose value data chose

A figure says something about other drives only where the drive that it is scored on has chosen none of the parameters.
This page names every parameter whose value was chosen, measured or adjusted on recorded or simulated data, and the published
figures that therefore do not count as unseen. All other parameters come from physics, from a sensor's specification or from the
literature, as their comments say. Keys of `[tables]` are those of [the configuration](../runtime/vehicle/CONFIGURATION.md).

Made from the list in `tools/packaging/parameters_page.py`; to make it anew: `tools/packaging/parameters_page.py .`

| parameter | value | chosen on | how | figures that are not unseen |
|---|---|---|---|---|
"""

# (where the value stands, data, how it was chosen, figures that are not unseen). The first is a key of maploop.toml
# as table.key, or "FILE NAME" of a line "NAME = value" or ".NAME = value" in a source file.
CHOSEN = [
    ("replay.imu_delay", "KITTI odometry sequences, all eight", "measured without a position's truth, 53 to 67 ms",
     "fusion on KITTI"),
    ("fusion.speed_scale_sigma", "visual odometry of six KITTI drives", "1.2 % rms against the truth's length",
     "fusion on KITTI with `VO`"),
    ("fusion.repeat_speed", "three drives of the car in Oakville",
     "longest repetition of its inertial samples, rounded to coarse steps, by speed", "none is published"),
    ("guard.overconfidence", "KITTI odometry sequences, 60 s without GNSS", "mean NEES of 2.9 to 4 where 2 is expected",
     "the map in the loop, also on wrong maps, on KITTI"),
    ("feedback.lane_share", "KITTI odometry sequences, 34 two-way roads", "mean offset of the truth from the line",
     "the map in the loop on KITTI; the road in PPP on KITTI's map. Not Riverside, nor simulated towns"),
    ("mapmatch.trust", "KITTI 01, 06 and 10", "what is said where the map lacks the road",
     "matching on 01, 06, 10, and their part of the reliability diagram"),
    ("mapmatch.trust_slope", "KITTI 01, 06 and 10", "as `trust`", "as `trust`"),
    ("mapmatch.doubt_slope", "KITTI odometry sequences, all eight", "the reliability diagram", "the reliability diagram"),
    ("sensors/replay/kitti_calibration.cpp calibration.rear_axle_distance", "five KITTI odometry sequences",
     "sideways velocity over yaw rate, 0.23 to 0.29 m", "fusion on KITTI"),
    ("sensors/replay/kitti_calibration.cpp calibration.climb_offset", "eight KITTI odometry sequences",
     "mean direction of travel above the inertial unit's x axis", "fusion on KITTI"),
    ("sensors/replay/kitti_calibration.cpp calibration.beam_elevation", "KITTI's scanner (IMLS-SLAM, CT-ICP and KISS-ICP "
     "use the same)", "taken from the literature, which chose it on KITTI odometry", "LiDAR odometry on KITTI"),
    ("fusion.lidar_scale_sigma", "KITTI drive 0013", "the data sheet's 2 cm at 10 m; the drive shows as much (0.19 %)",
     "normalized errors of the vehicle on 0013"),
    ("fusion.lidar_turn_sigma", "KITTI drive 0013", "what the scans' yaw drifts by there, 0.2 deg in 100 m",
     "normalized errors and azimuth of the vehicle on 0013"),
    ("lidar.correlated_points", "KITTI drive 0013", "odometries from disjoint halves of the points; no truth",
     "normalized errors of LiDAR odometry on 0013"),
    ("ppp.code_sigma", "ESBC station and Kamakura car", "among a handful of values with the scores in sight",
     "PPP of ESBC and of Kamakura"),
    ("ppp.phase_sigma", "ESBC station and Kamakura car", "as `code_sigma`", "PPP of ESBC and of Kamakura"),
    ("ppp.code_correlation", "ESBC station and Kamakura car", "from post-fit residuals of the days that are scored",
     "PPP of ESBC and of Kamakura"),
    ("ppp.code_correlation_distance", "Kamakura car", "as `code_correlation`", "PPP of Kamakura"),
    ("ppp.glonass_code_correlation", "ESBC station", "as `code_correlation`", "PPP of ESBC with GLONASS"),
    ("ppp.ambiguity_walk", "ESBC station", "from changes of post-fit phase residuals over 10 minutes",
     "PPP of ESBC"),
    ("ppp.full_cn0", "receivers of ESBC, Kamakura and Riverside", "the weakest 5 % of signals under open sky",
     "PPP of ESBC, Kamakura and Riverside"),
    ("ppp.full_cn0_drop", "receivers of ESBC, Kamakura and Riverside", "as `full_cn0`", "as `full_cn0`"),
    ("ppp.full_cn0_margin", "simulated canyons, seeds 1 to 20, and the three receivers",
     "among 3 to 6 dB with the scores in sight", "PPP between houses, seeds 1 to 20; PPP of the three receivers"),
    ("ppp.reflection_time", "simulated canyons, seeds 1 to 6", "by the scores",
     "PPP between houses, seeds 1 to 6"),
]


def value_of(root, values, where):
    if where in values:
        return values[where]
    file, _, name = where.partition(" ")
    path = os.path.join(root, file)
    if name and os.path.isfile(path):
        with open(path, encoding="utf-8") as source:
            found = re.search(rf"\b{name} = ([-+0-9.e']+)", source.read())
        if found:
            return found.group(1)
    sys.exit(f"parameters_page.py: {where}: there is no such parameter; correct the list CHOSEN")


def page(root):
    with open(os.path.join(root, "runtime/vehicle/maploop.toml"), encoding="utf-8") as file:
        values = {f"{table}.{key}" if table else key: value
                  for table, _, keys in tables(file.read()) for key, value, _ in keys}
    rows = []
    for where, *said in CHOSEN:
        shown = f"`{where}`" if where in values else "`{1}` ([{0}](../{0}))".format(*where.split(" "))
        rows.append("| " + " | ".join([shown, value_of(root, values, where), *said]) + " |\n")
    return HEAD + "".join(rows)


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--check"]):
        sys.exit(__doc__)
    path = os.path.join(sys.argv[1], "tools", "PARAMETERS.md")
    new = page(sys.argv[1])
    if sys.argv[2:]:
        with open(path, encoding="utf-8") as file:
            if file.read() != new:
                sys.exit("tools/PARAMETERS.md is stale; run\n  tools/packaging/parameters_page.py .")
        return
    with open(path, "w", encoding="utf-8") as file:
        file.write(new)


if __name__ == "__main__":
    main()
