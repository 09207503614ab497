#!/usr/bin/python3
"""Stands for maploop where tests are about the fleet: its errors follow from its arguments.

MADE_UP_FOLDER keeps a line a call. `--fault lost` fails, `--fault killed` is killed each time, `--fault killed-once` the
first time.
"""
import json
import os
import signal
import sys
import time
from pathlib import Path

arguments = sys.argv[1:]
folder = Path(os.environ["MADE_UP_FOLDER"])


def option(name, default=""):
    return arguments[arguments.index(name) + 1] if name in arguments else default


def note(text):
    with open(folder / "calls", "a") as calls:
        calls.write(text + "\n")


if arguments[0] == "simulate":
    note("simulate " + option("--seed"))
    Path(option("--out")).mkdir(parents=True)
    (Path(option("--out")) / "vehicle.toml").write_text("")
    sys.exit()
if arguments[0] == "doctor":
    Path(option("--html")).write_text("what was found")
    sensor = {"sensor": "imu", "rate_hz": 100.0, "longest_gap_s": 0.5, "left_out": 3, "finding": "it was silent"}
    Path(option("--json")).write_text(json.dumps({"sensors": [sensor], "sentences": ["All is well."]}))
    sys.exit()
fault, seed = option("--fault"), int(option("--seed", "1"))
note(f"replay {Path(arguments[5]).name} {fault} {seed}")
time.sleep(float(os.environ.get("MADE_UP_SECONDS", "0")))
if fault == "lost":
    sys.exit("maploop: there is no position")
if fault == "killed" or (fault == "killed-once" and not (folder / fault).exists()):
    (folder / fault).touch()
    os.kill(os.getpid(), signal.SIGKILL)
if option("--report"):
    Path(option("--report")).write_text("a page")
scale = float(option("--set", "scale=1").partition("=")[2])
percent = {"common_rotation_removed": {"segment_100m_percent": 0.5}}
Path(option("--json")).write_text(json.dumps({
    "channels": {"NAV_STATE": {"hash": f"{seed}/{scale}"}}, "odom": percent, "vo": percent,
    "navigation": {"rmse_m": scale * (1.0 + 0.1 * seed), "nees_mean": 2.0}}))
