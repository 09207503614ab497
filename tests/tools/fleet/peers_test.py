#!/usr/bin/env python3
"""Programs beside maploop are run, measured and scored as a catalogue asks.

    peers_test.py FOLDER_OF_THE_FLEET MAPLOOP
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FLEET, MAPLOOP = (Path(each).resolve() for each in sys.argv[1:3])
del sys.argv[1:3]
sys.path.insert(0, str(FLEET / "peers"))
sys.dont_write_bytecode = True
import positioning  # noqa: E402

DATA = Path(os.environ.get("MAPLOOP_DATA", "/nowhere")) / "gnss"
CAR = DATA / "kamakura_kinematic"
FILES = [CAR / "SEPT265G.21O.gz", CAR / "SEPT2650.21P.gz", CAR / "COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz",
         CAR / "COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz", DATA / "models/igs14_rebuilt_GE.atx.gz"]


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="peers-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_program(self, program, *files):
        return subprocess.run([FLEET / "peers/positioning.py", "--maploop", MAPLOOP, "--json", self.folder / "result.json",
                               "--raw", self.folder, *files, "--program", program, "--systems", "GE",
                               "--truth", CAR / "rtk_reference.pos.gz"], capture_output=True, text=True, timeout=120,
                              env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})


class Orbits(Folder):
    def test_satellites_of_other_systems_are_left_out(self):
        names = [f"G{i:02}" for i in range(1, 33)] + [f"R{i:02}" for i in range(1, 25)] + [f"E{i:02}" for i in range(1, 31)]
        heads = [f"+  {len(names) if not i else '':>3}   " + "".join(f"{n:>3}" for n in names[i:i + 17]) for i in range(0, 86, 17)]
        text = "\n".join(["#dP2021", "## 2176", *heads, "++ of accuracies", "%c M", "*  2021", *(f"P{n} 1.0" for n in names), "EOF"])
        lines = positioning.orbits_of(text, "GE").splitlines()
        self.assertEqual(lines[2][:15], "+   62   G01G02")
        self.assertEqual(lines[5][9:60], "".join(f"E{i:02}" for i in range(20, 31)) + "  0" * 6)
        self.assertEqual(sum(line.startswith("P") for line in lines), 62)
        self.assertEqual((lines[-1], "%c M" in lines, "*  2021" in lines), ("EOF", True, True))
        with self.assertRaisesRegex(ValueError, "are more than RTKLIB reads"):
            positioning.orbits_of("#d\n##\n" + "+        " + "G01" * 17 + "\n" + "\n".join(["+        " + "G01" * 17] * 5), "G")


@unittest.skipUnless(CAR.is_dir(), "SKIPPED, NOT TESTED: MAPLOOP_DATA has no Kamakura drive")
class Positions(Folder):
    def scores(self, program):
        done = self.run_program(program, *FILES)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads((self.folder / "result.json").read_text())
        self.assertGreater(result["job"]["cpu_s"], 0.0)
        self.assertGreater(result["job"]["peak_mb"], 5.0)
        self.assertTrue((self.folder / "positions.pos").stat().st_size > 10000, "the raw output is kept")
        return result["score"]["runs"][0]

    def test_maploop_is_scored(self):
        run = self.scores("maploop")
        self.assertEqual((run["frames"], run["unmatched"]["truth"]), (360, 0))
        self.assertLess(run["horizontal_m"]["rmse"], 0.5)

    @unittest.skipUnless(shutil.which("rnx2rtkp"), "SKIPPED, NOT TESTED: no RTKLIB; tools/install-packages peers")
    def test_rtklib_is_scored_in_the_same_way(self):
        run = self.scores("rtklib-ppp")
        self.assertGreater(run["frames"], 340)
        self.assertLess(run["horizontal_m"]["rmse"], 1.0)

    def test_a_contender_that_fails_is_an_error_with_what_it_said(self):
        done = self.run_program("maploop", CAR / "missing.21O")
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stderr, "maploop ended with status 1: .*missing.21O")
        self.assertFalse((self.folder / "result.json").exists())


if __name__ == "__main__":
    unittest.main()
