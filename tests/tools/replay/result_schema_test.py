#!/usr/bin/env python3
"""What `maploop replay --json` writes is what its schema says, key by key.

    result_schema_test.py MAPLOOP SCHEMA

It replays drives of MAPLOOP_DATA; without them it is skipped.
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import jsonschema
except ImportError as error:
    print(f"SKIPPED, NOT TESTED: {error}; tools/install-packages test")
    sys.exit(77)

maploop, schema = sys.argv[1:]
data = Path(os.environ.get("MAPLOOP_DATA", "/nowhere"))
if not data.exists():
    print("SKIPPED, NOT TESTED: MAPLOOP_DATA names no folder")
    sys.exit(77)
runs = [[data / "kitti_odometry/oxts/06.csv.gz", "--end", "60", "--gnss-outage", "20:20", "--map-mode", "tight",
         "--map", data / "maps/karlsruhe_2012-04.osm.pbf", "--fault", "lost@imu:5:1"],
        [data / "kitti_odometry/oxts/06.csv.gz", "--end", "60", "--gnss-outage", "20:20", "--map-mode", "tight",
         "--map", data / "maps/karlsruhe_2012-04.osm.pbf", "--map-fault", "missing", "--misdescribe", "everything",
         "--score-from", "20"],
        [data / "cars/oakville/urban-short-turn-loop-nominal-001", "--gnss-outage", "repeated:60:30"],
        [data / "gnss/riverside_drive", "--end", "60"],
        [data / "kitti_odometry/oxts/06.csv.gz", "--end", "5", "--fault", "lost@gnss:0:end"]]
validator = jsonschema.Draft7Validator(json.loads(Path(schema).read_text()))
seen, wrong = set(), []
with tempfile.TemporaryDirectory() as folder:
    for run in runs:
        output = Path(folder) / "output.json"
        output.unlink(missing_ok=True)
        done = subprocess.run([maploop, "replay", *run, "--lockstep", "--no-lcm", "--json", output], capture_output=True,
                              text=True, timeout=250)
        if not output.exists():
            wrong.append(f"{run[0]}: nothing was written: {done.stderr}")
            continue
        result = json.loads(output.read_text())
        seen |= {key for key, value in result.items() if value}
        for error in validator.iter_errors(result):
            wrong.append(f"{run[0]}: {'.'.join(map(str, error.absolute_path))}: {error.message[:300]}")
if not {"navigation", "ppp", "links", "calibration", "empty", "map_feedback", "outage_ends"} <= seen:
    wrong.append(f"the drives do not show everything: {sorted(seen)}")
print("\n".join(wrong) or f"{len(runs)} results are as the schema says")
sys.exit(bool(wrong))
