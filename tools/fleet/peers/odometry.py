#!/usr/bin/python3
"""Visual or LiDAR odometry on a recording's frames, by maploop or by others.

    odometry.py --program NAME --truth FILE RECORDING [--config FILE]

maploop-stereo and maploop-lidar are `maploop odometry`, as are the methods of PCL (pcl-gicp, pcl-ndt, pcl-icp), which
register the same samples of scans with the same kind of local map. opencv and open3d are programs beside this one.
"""
import os
import sys
from pathlib import Path

import contender

HERE = Path(__file__).resolve().parent
OURS = {"maploop-stereo": [], "maploop-lidar": ["--lidar"],
        **{name: ["--lidar", "--method", name] for name in ("pcl-gicp", "pcl-ndt", "pcl-icp")}}
OTHERS = {"opencv": "stereo_opencv.py", "open3d": "lidar_open3d.py"}


def main():
    parser = contender.options("Odometry by one of these programs.", [*OURS, *OTHERS])
    parser.add_argument("--config", default="", help="the vehicle's")
    o = parser.parse_args()
    o.raw = o.raw.resolve()
    recording, poses = Path(o.recording).resolve(), o.raw / "poses.tum"
    config = [Path(o.config).resolve()] if o.config else []
    if o.program in OURS:
        job = contender.run([o.maploop, "odometry", recording, *OURS[o.program], "--tum", poses,
                             *(["--config", *config] if config else [])], o.raw)
    else:
        module = Path(o.maploop).resolve().parents[1] / "python"  # it reads the recording for them
        job = contender.run([sys.executable, HERE / OTHERS[o.program], recording, poses, *config], o.raw,
                            PYTHONPATH=os.pathsep.join([str(module), os.environ.get("PYTHONPATH", "")]))
    contender.score(o, poses, job, o.truth, "--max-difference", "0.05")


if __name__ == "__main__":
    sys.exit(main())
