#!/usr/bin/env python3
"""What Python adds to the odometries, against the command, turn and turn about in one run.

    PYTHONPATH=build/release/python /usr/bin/python3 tests/benchmarks/python_overhead.py build/release/bin/maploop DRIVE

Milliseconds of processor time, medians over images and scans. "refused" is a call whose stamp is not later than the
one before: all that Python does, without an estimate.
"""
import csv
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import maploop

ROUNDS = 3
command, drive = sys.argv[1:]


def by_command(*options):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "motions.csv"
        subprocess.run([command, "odometry", drive, *options, "--csv", file], check=True, capture_output=True)
        return [float(row["milliseconds"]) for row in csv.DictReader(file.open()) if row["milliseconds"]]


def timed(function, *arguments, **named):
    begin = time.thread_time_ns()
    result = function(*arguments, **named)
    return 1e-6 * (time.thread_time_ns() - begin), result


def by_python(recording, lidar):
    """Milliseconds of each image, of each scan, and of refused ones."""
    stereo, odometry = (maploop.StereoOdometry(recording.stereo, recording.config),
                        maploop.LidarOdometry(recording.T_body_velo, recording.config))
    images, clouds, refused_images, refused_clouds, scans, scan = [], [], [], [], recording.scans(), None
    for pair in recording.images():
        spent, motion = timed(stereo.process, pair.left, pair.right, pair.stamp)
        images.append(spent)
        refused_images.append(timed(stereo.process, pair.left, pair.right, pair.stamp)[0])
        if not lidar:
            continue
        while scan is None or scan.end <= pair.stamp:
            scan = next(scans, None)
            if scan is None:
                return images, clouds, refused_images, refused_clouds
        if scan.start <= pair.stamp:
            turn = dict(start=scan.start, end=scan.end, visual=motion)
            clouds.append(timed(odometry.process, scan.points, scan.stamp, **turn)[0])
            refused_clouds.append(timed(odometry.process, scan.points, scan.stamp, **turn)[0])
    return images, clouds, refused_images, refused_clouds


recording = maploop.Recording(drive)
theirs_images, theirs_scans, images, scans, refused_images, refused_scans = ([] for _ in range(6))
for _ in range(ROUNDS):
    theirs_images += by_command()
    for all_of, part in zip((images, [], refused_images, []), by_python(recording, lidar=False)):
        all_of += part
    theirs_scans += by_command("--lidar")
    for all_of, part in zip(([], scans, [], refused_scans), by_python(recording, lidar=True)):
        all_of += part
for what, cpp, python, refused in (("image pair", theirs_images, images, refused_images),
                                   ("scan", theirs_scans, scans, refused_scans)):
    a, b = median(cpp), median(python)
    print(f"{what}: C++ {a:.2f} ms, Python {b:.2f} ms ({100 * (b / a - 1):+.1f} %), refused "
          f"{1e3 * median(refused):.1f} us ({100 * median(refused) / a:.3f} %), {len(cpp)} and {len(python)} calls")
