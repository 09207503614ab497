#!/usr/bin/env python3
"""What tools/fleet makes of catalogues, with a made-up maploop; the parts that need Snakemake are skipped without it.

    fleet_test.py FOLDER_OF_THE_FLEET
"""
import contextlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

FLEET = Path(sys.argv.pop(1)).resolve()
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(FLEET))
sys.dont_write_bytecode = True
try:
    import catalogue
    import results
    from programs import program
except ImportError as error:
    print(f"SKIPPED, NOT TESTED: {error}; tools/install-packages test")
    sys.exit(77)

TEXT = """
[[recording]]
name = "a"
path = "a.csv"
tags = ["short"]

[[recording]]
name = "made"
simulate = "--seed 3"
config = "vehicle.toml"
split = "score"

[[experiment]]
name = "seeds"
recordings = ["a", "made"]
configurations = ["auto", "GNSS"]
seeds = [1, 2, 3]
vary = { scale = [1, 2] }
metrics = ["position_rms", "odom"]
"""


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="fleet-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "a.csv").write_text("1\n")

    def catalogue(self, text=TEXT):
        (self.folder / "c.toml").write_text(text)
        return self.folder / "c.toml"

    def plan(self, text=TEXT):
        return catalogue.make_plan(catalogue.load(self.catalogue(text)), self.folder / "recordings")


class Catalogue(Folder):
    def said(self, old, new):
        self.assertIn(old, TEXT)
        with self.assertRaises(catalogue.Wrong) as caught:
            catalogue.load(self.catalogue(TEXT.replace(old, new)))
        return str(caught.exception).replace(str(self.folder) + "/", "")

    def test_every_combination_is_a_run(self):
        runs = self.plan()["runs"].values()
        self.assertEqual(len(runs), 2 * 2 * 3 * 2)
        self.assertEqual({r["variant"] for r in runs},
                         {"auto, scale=1", "auto, scale=2", "GNSS, scale=1", "GNSS, scale=2"})
        made = next(r for r in runs if r["recording"] == "made" and r["seed"] == 2)
        self.assertIn("--config", made["arguments"])
        self.assertEqual(made["arguments"][made["arguments"].index("--seed") + 1], "2")

    def test_seeds_of_a_made_recording_and_repeats_are_runs_of_one_variant(self):
        text = TEXT.replace('name = "made"\nsimulate = "--seed 3"', 'name = "made-{seed}"\nsimulate = "--seed {seed}"\nseeds = [3, 4]')
        text = text.replace('["a", "made"]', '["made-3", "made-4"]').replace("seeds = [1, 2, 3]", 'command = "ppp"\n'
                            'repeats = [["--start", "0"], ["--start", "60", "--map", "{folder}/map.osm"]]')
        plan = self.plan(text)
        self.assertEqual({n: m["command"] for n, m in plan["made"].items()},
                         {"made-3": ["simulate", "--seed", "3"], "made-4": ["simulate", "--seed", "4"]})
        runs = [r for r in plan["runs"].values() if r["variant"] == "auto, scale=1"]
        self.assertEqual({(r["recording"], r["repeat"], r["command"]) for r in runs},
                         {(n, i, "ppp") for n in ("made-3", "made-4") for i in (0, 1)})
        maps = {r["arguments"][4] for r in runs if r["repeat"] == 1}
        self.assertEqual(maps, {m["folder"] + "/map.osm" for m in plan["made"].values()})

    def test_a_run_has_the_same_name_before_and_after_its_recording_is_made(self):
        text = TEXT.replace("metrics", 'arguments = ["--truth", "{folder}/truth.tum"]\nmetrics').replace('["a", "made"]', '["made"]')
        before = self.plan(text)
        folder = Path(before["made"]["made"]["folder"])
        folder.mkdir(parents=True)
        (folder / "truth.tum").write_text("1\n")
        self.assertEqual(set(before["runs"]), set(self.plan(text)["runs"]))

    def test_the_log_of_a_made_recording_can_take_its_place(self):
        plan = self.plan(TEXT.replace('config = "vehicle.toml"', 'config = "vehicle.toml"\nlog = true'))
        made = plan["made"]["made"]
        self.assertEqual(made["record"][:4], ["replay", ".", "--config", "vehicle.toml"])
        self.assertNotEqual(made["folder"], self.plan()["made"]["made"]["folder"])
        runs = [r for r in plan["runs"].values() if r["recording"] == "made"]
        self.assertEqual({r["arguments"][0] for r in runs}, {made["folder"] + "/odometry.lcmlog"})

    def test_a_run_has_another_name_when_its_recording_or_its_arguments_change(self):
        before = set(self.plan()["runs"])
        self.assertEqual(before, set(self.plan()["runs"]))
        self.assertEqual(len(before & set(self.plan(TEXT.replace("[1, 2, 3]", "[2, 3, 4]"))["runs"])), 16)
        (self.folder / "a.csv").write_text("1\n2\n")
        self.assertEqual(len(before & set(self.plan()["runs"])), 12)

    def test_arguments_have_variants_and_a_value_of_each_recording(self):
        (self.folder / "map.osm").write_text("1\n")
        text = TEXT.replace('tags = ["short"]', 'values = { from = "20" }\narguments = ["--odometry-poses", "$MADE_UP_MAPS/poses"]')
        text = text.replace('split = "score"', 'values = { from = "30" }').replace("[1, 2, 3]", "[1]")
        text = text.replace("metrics", 'arguments = ["--map", "$MADE_UP_MAPS/map.osm"]\n'
                            'variants = { whole = [], out = ["--gnss-outage", "{from}:10"] }\nmetrics')
        os.environ["MADE_UP_MAPS"] = str(self.folder)
        self.addCleanup(os.environ.pop, "MADE_UP_MAPS")
        plan = self.plan(text)["runs"]
        self.assertEqual(len(plan), 2 * 2 * 2 * 2)
        outages = {(r["recording"], r["arguments"][r["arguments"].index("--gnss-outage") + 1])
                   for r in plan.values() if r["variant"] == "auto, out, scale=1"}
        self.assertEqual(outages, {("a", "20:10"), ("made", "30:10")})
        poses = {(r["recording"], str(self.folder / "poses") in r["arguments"]) for r in plan.values()}
        self.assertEqual(poses, {("a", True), ("made", False)})
        (self.folder / "map.osm").write_text("another\n")
        self.assertEqual(set(plan) & set(self.plan(text)["runs"]), set(), "another map makes other runs")
        with self.assertRaisesRegex(catalogue.Wrong, "the recording 'a' has no value 'from'"):
            self.plan(text.replace("from = \"20\"", "to = \"20\""))

    def test_what_is_wrong_is_named_with_file_and_line(self):
        self.assertIn("c.toml:17: experiment[0].seeds: 'x' is not of type 'array'", self.said("[1, 2, 3]", '"x"'))
        self.assertIn("c.toml:15: experiment[0].recordings: no recording has the name or tag 'b'",
                      self.said('["a", "made"]', '["b"]'))
        self.assertIn("there is no metric 'speed'; there are position_rms", self.said('"odom"', '"speed"'))
        self.assertIn("c.toml:8: recording[1].name: 'a' is there twice", self.said('"made"\nsim', '"a"\nsim'))
        self.assertIn("c.toml:4: recording[0].path: there is nothing at", self.said("a.csv", "b.csv"))
        self.assertIn("recording[0].path: the environment does not have MADE_UP_NOWHERE",
                      self.said("a.csv", "$MADE_UP_NOWHERE/a.csv"))
        self.assertIn("c.toml:7: recording[1]: a recording has either 'path' or 'simulate'",
                      self.said('simulate = "--seed 3"', 'simulate = "--seed 3"\npath = "a.csv"'))
        self.assertIn("Additional properties are not allowed ('sed' was unexpected)", self.said("seeds", "sed"))
        self.assertIn("c.toml:", self.said("[[experiment]]", "[[experiment"))

    def test_ten_thousand_runs_are_planned_in_seconds(self):
        seeds = str(list(range(1, 1251)))
        began = time.monotonic()
        self.assertEqual(len(self.plan(TEXT.replace("[1, 2, 3]", seeds))["runs"]), 10000)
        print(f"\n10000 runs planned in {time.monotonic() - began:.1f} s", file=sys.stderr)


@unittest.skipUnless(shutil.which("snakemake"), "SKIPPED, NOT TESTED: no Snakemake; tools/install-packages fleet")
class Fleet(Folder):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "MADE_UP_FOLDER": str(self.folder)}

    def command(self, text, *more):
        return [FLEET / "run", self.catalogue(text), "--out", self.folder / "out", "--binary",
                HERE / "made_up_maploop.py", "--code", "new", "--cores", "2", *more]

    def run_fleet(self, text=TEXT, *more, **environment):
        return subprocess.run(self.command(text, *more), capture_output=True, text=True, timeout=250,
                              env={**self.environment, **environment})

    def calls(self):
        file = self.folder / "calls"
        return file.read_text().splitlines() if file.exists() else []

    def replays(self):
        return sum(call.startswith("replay") for call in self.calls())

    def rows(self, code="new"):
        return results.read(self.folder / "out" / code / "c/runs.sqlite")[0]

    def test_a_page_is_made_and_what_is_there_is_not_made_again(self):
        done = self.run_fleet(TEXT.replace("metrics", "report = true\nmetrics"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("24 runs, 0 of them are there", done.stdout)
        self.assertEqual(len(self.calls()), 25, "24 runs and one recording")
        page = (self.folder / "out/new/c/page.html").read_text()
        self.assertNotIn("<!--", page)
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.DOTALL)[1])
        self.assertEqual(len(data["rows"]), 24)
        report = data["rows"][0][data["texts"].index("report")]
        self.assertEqual((self.folder / "out/new/c" / report).read_text(), "a page")
        self.assertRegex(page, r'<a href="../doctor/a-\w+.json.html">a</a></td><td></td><td>imu 100 Hz</td><td>0.5 s, imu</td>')
        self.assertIn("3 of imu: it was silent", page)
        twice = next(row for row in page.splitlines() if "scale=2" in row)
        self.assertRegex(twice, r'class="missed" title="2.000 to 2.000 \(95 %\), 6 pairs">2.000')
        self.assertEqual(self.run_fleet().returncode, 0)
        self.assertEqual(len(self.calls()), 25)
        self.run_fleet(TEXT.replace("[1, 2, 3]", "[1, 2, 3, 4]"))
        self.assertEqual(len(self.calls()), 33, "eight runs more")

    def test_a_run_that_fails_is_a_result_and_one_that_is_killed_is_tried_again(self):
        text = TEXT.replace("vary = { scale = [1, 2] }", 'faults = ["", "lost", "killed", "killed-once"]')
        for old, new in (("seeds = [1, 2, 3]", "seeds = [1]"), (', "GNSS"', ""), ('["a", "made"]', '["a"]')):
            text = text.replace(old, new)
        done = self.run_fleet(text)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {r["fault"]: r for r in self.rows()}
        self.assertEqual({f: r["status"] for f, r in rows.items()}, {"": 0, "lost": 1, "killed": -9, "killed-once": 0})
        self.assertEqual(rows["lost"]["error"], "maploop: there is no position")
        self.assertRegex(done.stderr, "fleet: 2 runs ended with an error, the first of a .*: maploop: there is no position")
        self.assertIsNone(rows["lost"]["position_rms"])
        self.assertAlmostEqual(rows["killed-once"]["position_rms"], 1.1)
        self.assertEqual(sum("killed " in call for call in self.calls()), 3)
        self.assertEqual(sum("killed-once" in call for call in self.calls()), 2)

    def test_it_goes_on_after_it_was_killed(self):
        workflow = subprocess.Popen(self.command(TEXT), env={**self.environment, "MADE_UP_SECONDS": "0.3"},
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        results_folder = self.folder / "out/new/results"
        for _ in range(600):
            if len(list(results_folder.glob("*.json"))) >= 4:
                break
            time.sleep(0.1)
        os.killpg(workflow.pid, signal.SIGKILL)
        workflow.wait()
        there = len(list(results_folder.glob("*.json")))
        self.assertTrue(4 <= there < 24, there)
        before = self.replays()
        done = self.run_fleet()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(self.replays() - before, 24 - there + 2, "at most the two running ones are lost")
        self.assertEqual(len(self.rows()), 24)

    def test_a_change_that_makes_it_worse_is_told(self):
        self.run_fleet(TEXT, "--experiment", "seeds")
        (self.folder / "out/new").rename(self.folder / "out/old")
        worse = TEXT.replace('vary = { scale = [1, 2] }', 'arguments = ["--set", "scale=1.5"]')
        self.run_fleet(worse)
        rows = self.rows("old")
        self.assertEqual(len(rows), 24)
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            status = program(FLEET / "compare").main([str(self.folder / "out/old/c"), str(self.folder / "out/old/c")])
        self.assertEqual(status, 0)
        self.assertIn("seeds: 24 runs in both, 24 with the same bits", text.getvalue())
        module = program(FLEET / "compare")
        old = [r for r in rows if r["variant"].endswith("scale=1")]
        new = [{**r, "variant": r["variant"] + ", scale=1"} for r in self.rows()]
        _, experiments, metrics = results.read(self.folder / "out/new/c/runs.sqlite")
        lines, is_worse = module.lines_of(old, new, experiments, metrics)
        self.assertTrue(is_worse)
        self.assertRegex("\n".join(lines), r"position_rms +1\.2 -> +1\.8 m +x 1\.500 .*12 pairs: worse")
        self.assertRegex("\n".join(lines), r"odom +0\.5 -> +0\.5 % .*no significant change")
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.assertEqual(module.main(["nowhere", "nowhere"]), 2)
        self.assertIn("there is no database at nowhere", said.getvalue())

    def test_what_cannot_run_is_said_before_anything_runs(self):
        for arguments, what in ((["--experiment", "none"], "there is no experiment 'none'"),
                                (["--binary", "/nowhere/maploop"], "there is no maploop at /nowhere/maploop")):
            done = self.run_fleet(TEXT, *arguments)
            self.assertEqual(done.returncode, 1)
            self.assertIn(what, done.stderr)
        self.assertEqual(self.calls(), [])


if __name__ == "__main__":
    outcome = unittest.main(exit=False).result
    sys.exit(not outcome.wasSuccessful())
