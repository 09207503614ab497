"""What the tests of the Python module have in common."""
import json
import os
import subprocess
from pathlib import Path

import maploop
import pytest


@pytest.fixture(scope="session")
def data():
    folder = Path(os.environ.get("MAPLOOP_DATA", "/nowhere"))
    if not folder.exists():
        pytest.skip("MAPLOOP_DATA names no folder")
    return folder


@pytest.fixture(scope="session")
def drive():
    """KITTI's drive 0013, as tools/restore-drive has unpacked it."""
    folder = Path(os.environ.get("MAPLOOP_CACHE", "/nowhere")) / "2011_09_26/2011_09_26_drive_0013_sync"
    if not folder.exists():
        pytest.skip(f"there is no {folder}")
    return folder


@pytest.fixture(scope="session")
def command():
    """Runs the maploop command."""
    def run(*arguments):
        done = subprocess.run([os.environ["MAPLOOP"], *map(str, arguments)], capture_output=True, text=True, timeout=250)
        assert done.returncode == 0, done.stderr
        return done
    return run


@pytest.fixture(scope="session")
def three_seconds(drive, command, tmp_path_factory):
    """The figures and the log of the first 3.1 s (30 images) of the drive, by the command."""
    folder = tmp_path_factory.mktemp("three_seconds")
    command("replay", drive, "--lockstep", "--no-lcm", "--end", 3.1, "--json", folder / "figures.json", "--record",
            folder / "run.lcmlog", "--csv", folder / "states.csv")
    return folder, json.loads((folder / "figures.json").read_text())


@pytest.fixture(scope="session")
def motions(three_seconds):
    """The motions of that log: visual ones, and those of LiDAR."""
    samples = list(maploop.Recording(three_seconds[0] / "run.lcmlog"))
    lidar = [m for m in samples if isinstance(m, maploop.LidarMotion)]
    visual = {}
    for m in samples:  # what the fusion has used comes later
        if type(m) is maploop.RelativeMotion:
            visual.setdefault(m.stamp, m)
    return list(visual.values()), lidar
