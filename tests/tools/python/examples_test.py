"""Each example makes its picture in at most 15 lines."""
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("matplotlib", reason="SKIPPED, NOT TESTED: no matplotlib; tools/install-packages python-examples")
EXAMPLES = Path(os.environ["MAPLOOP_SOURCE"]) / "tools/python/examples"


def made(example, *arguments, picture):
    done = subprocess.run([sys.executable, "-B", EXAMPLES / example, *arguments], capture_output=True, text=True,
                          env={**os.environ, "MPLBACKEND": "Agg"}, timeout=250)
    assert done.returncode == 0, done.stderr
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 5000
    return True


def test_each_has_at_most_15_lines():
    for example in EXAMPLES.glob("*.py"):
        assert len(example.read_text().splitlines()) <= 15, example


def test_a_drive(data, tmp_path):
    assert made("drive.py", data / "kitti_odometry/oxts/04.csv.gz", tmp_path / "drive.png", picture=tmp_path / "drive.png")


def test_a_matched_track(data, tmp_path):
    assert made("match.py", data / "maps/karlsruhe_2012-04.osm.pbf", data / "kitti_odometry/oxts/06.csv.gz",
                tmp_path / "match.png", picture=tmp_path / "match.png")


def test_a_ppp_run(data, tmp_path):
    folder = data / "gnss/kamakura_kinematic"
    assert made("ppp.py", tmp_path / "ppp.png", folder / "SEPT265G.21O.gz", folder / "SEPT2650.21P.gz",
                folder / "COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz", picture=tmp_path / "ppp.png")
