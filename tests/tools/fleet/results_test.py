#!/usr/bin/env python3
"""What tools/fleet makes of results: metrics, comparisons by pairs, tables of the page.

    results_test.py FOLDER_OF_THE_FLEET
"""
import json
import re
import shutil
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

FLEET = Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(FLEET))
sys.dont_write_bytecode = True
try:
    import page
    import results
    from metrics import METRICS, value, values
    from programs import program
    from statistics_of_pairs import paired, ratio
except ImportError as error:
    print(f"SKIPPED, NOT TESTED: {error}; tools/install-packages test")
    sys.exit(77)


class Metrics(unittest.TestCase):
    def test_a_run_without_what_a_metric_needs_has_none(self):
        self.assertIsNone(value("position_rms", {"navigation": None}))
        self.assertIsNone(value("odom_to_best", {}))
        self.assertIsNone(value("named_after", {"faults": [], "named": []}))
        part = {"common_rotation_removed": {"segment_100m_percent": 0.5}}
        self.assertEqual(value("odom_to_best", {"odom": part, "vo": part}), 1.0)

    def test_outages_are_parts_of_a_run_where_the_reference_covers_them(self):
        outages = [{"drift_percent": d, "covered": c} for d, c in ((1.0, 1.0), (9.0, 0.5), (3.0, 0.98))]
        output = {"navigation": {"outages": outages, "drift_percent": 0.5}}
        self.assertEqual(values("outage_drift", output), [1.0, 3.0])
        self.assertEqual(value("outage_drift", output), 2.0)
        self.assertEqual(values("drift", output), [0.5])
        self.assertEqual(values("outage_azimuth_end", output), [])

    def test_every_metric_says_what_it_is(self):
        for name, metric in METRICS.items():
            self.assertTrue(metric.unit and metric.about, name)


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="fleet-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def test_a_table_pools_the_outages_of_all_runs_and_of_each_recording(self):
        experiment = {"metrics": ["outage_drift"], "by": "recording"}
        plan = {"experiments": {"e": experiment}, "results": str(self.folder), "runs": {"a": {"split": "score"}, "b": {}}, "examined": {}}
        for key, drifts in (("a", [1.0, 2.0]), ("b", [9.0])):
            outages = [{"drift_percent": d, "covered": 1.0} for d in drifts]
            record = {**dict.fromkeys(results.TEXTS, ""), "key": key, "experiment": "e", "recording": "drive-" + key,
                      "tags": [], "set": {}, "seed": 1, "repeat": 0, "status": 0, "wall_s": 1.0, "variant": "x",
                      "output": {"navigation": {"outages": outages}}}
            (self.folder / f"{key}.json").write_text(json.dumps(record))
        results.collect(plan, self.folder / "runs.sqlite")
        runs, experiments, metrics = results.read(self.folder / "runs.sqlite")
        self.assertEqual([r["outage_drift"] for r in runs], [1.5, 9.0])
        self.assertEqual([r["split"] for r in runs], ["score", ""], "as the catalogue says now")
        rows = re.findall(r"<tr data.*?</tr>", page.experiment_part("e", experiments["e"], runs, metrics))
        cells = [re.findall(r"<td>(.*?)</td>", row)[1:] for row in rows]
        self.assertEqual(cells[0][:5], ["x", "3", "4", "5.35", "2"], "name, values, mean, rms, median")
        self.assertEqual([row[:3] for row in cells[1:]], [["drive-a: x", "2", "1.5"], ["drive-b: x", "1", "9"]])

    def test_a_grid_marks_what_is_worse_than_the_best_input(self):
        runs = [{"recording": d, "variant": v, "m": m, "parts": {}} for d, v, m in
                (("a", "one", 2.0), ("a", "other", 1.0), ("a", "both", 1.5), ("b", "one", 3.0), ("b", "other", None),
                 ("b", "both", 3.0))]
        metrics = {"m": {"unit": "m", "about": "An error."}}
        grid = {"metric": "m", "inputs": ["one", "other"], "limit": 1.1}
        text = page.grid_part(grid, runs, ["one", "other", "both"], metrics)
        rows = [re.findall(r'<td( class="missed")?[^>]*>(.*?)</td>', row) for row in re.findall(r"<tr><td>.*?</tr>", text)]
        self.assertEqual([c[1] for c in rows[0]], ["a", "2.00", "1.00", "1.50"])
        self.assertEqual([bool(c[0]) for c in rows[0]], [False, True, False, True])
        self.assertEqual([c[1] for c in rows[1]], ["b", "1.00", "–", "1.00"])
        self.assertEqual([c[1] for c in rows[2]], ["all", "2.00", "1.00", "1.50"], "of drive a, which has all three")


    def test_quoted_figures_stand_apart(self):
        quoted = [{"name": "another", "what": "errors <of> it", "value": "1 %", "source": "its page"}]
        text = page.quoted_part(quoted)
        self.assertIn("Quoted, not run here", text)
        self.assertIn("<td>errors &lt;of&gt; it</td><td>1 %</td><td>its page</td>", text)
        self.assertEqual(page.quoted_part([]), "")


class Figures(unittest.TestCase):
    RUNS = [{"experiment": "e", "variant": v, "recording": d, "m": m, "parts": {}} for v, d, m in
            (("old", "a", 1.0), ("old", "b", 2.0), ("new", "a", 3.0), ("new", "b", None), ("odd", "c", 9.0))]

    def setUp(self):
        self.figures = program(FLEET / "figures")

    def test_a_table_pools_the_runs_of_its_rows_as_its_columns_say(self):
        columns = {"mean": "m", "of a": "m; largest; recording=a", "values": "m; values", "loss, %": "m; loss; variant=old"}
        spec = {"rows": ["variant"], "where": {"variant": ["old", "new"]}, "names": {"old": "before"}, "columns": columns}
        self.assertEqual(self.figures.table_of(spec, self.RUNS), [
            "|  | mean | of a | values | loss, % |", "|---|---|---|---|---|",
            "| before | 1.5 | 1 | 2 | 0 |", "| new | 3 | 3 | 1 | 100 |"])

    def test_the_tables_of_our_pages_name_what_there_is(self):
        tables = 0
        for side in FLEET.parents[1].glob("*/**/FIGURES.md"):
            for block in self.figures.BLOCK.finditer(side.read_text() if "build" not in side.parts else ""):
                spec = tomllib.loads(block[2])
                made = tomllib.loads((FLEET / f"catalogues/{spec['catalogue']}.toml").read_text())
                experiments = {e["name"]: e for e in made["experiment"]}
                asked = [column.split(";")[0].strip() for column in spec["columns"].values()]
                for name in spec.get("experiments", experiments):
                    self.assertIn(name, experiments, side)
                metrics = {m for name in spec.get("experiments", experiments) for m in experiments[name]["metrics"]}
                self.assertEqual([metric for metric in asked if metric not in metrics], [], side)
                self.assertIn("| ", block[0], f"{side}: a table is empty")
                tables += 1
        self.assertGreater(tables, 15)

    def test_a_table_that_cannot_be_read_is_named_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            side = Path(folder) / "FIGURES.md"
            side.write_text("# Figures\n\n<!-- fleet\nrows = [\n-->\n<!-- /fleet -->\n")
            with self.assertRaisesRegex(SystemExit, r"FIGURES.md, the table of line 3: "):
                self.figures.main(["--no-run", str(side)])
            side.write_text("# Figures\n")
            with self.assertRaisesRegex(SystemExit, "there is no table of the fleet in"):
                self.figures.main(["--no-run", str(side)])


class Pairs(unittest.TestCase):
    def test_a_change_in_each_pair_is_significant_and_noise_is_not(self):
        old = [1.0 + 0.1 * i for i in range(20)]
        doubled = ratio(old, [2.0 * x for x in old])
        self.assertAlmostEqual(doubled.value, 2.0)
        self.assertTrue(doubled.significant)
        noisy = ratio(old, [x + (0.2 if i % 2 else -0.2) for i, x in enumerate(old)])
        self.assertAlmostEqual(noisy.value, 1.0)
        self.assertFalse(noisy.significant)

    def test_one_pair_says_nothing(self):
        self.assertIsNone(ratio([1.0], [2.0]))
        self.assertIsNone(ratio([1.0, None], [2.0, 3.0]))
        self.assertIsNone(ratio([0.0, 0.0], [1.0, 1.0]))

    def test_only_runs_of_both_are_compared(self):
        old = [{"seed": 1, "m": 1.0}, {"seed": 2, "m": 2.0}]
        new = [{"seed": 2, "m": 4.0}, {"seed": 3, "m": 5.0}]
        self.assertEqual(paired(old, new, "m", ["seed"]), ([2.0], [4.0]))


if __name__ == "__main__":
    unittest.main()
