#!/usr/bin/python3
"""Writes the page of a database of runs: one file that needs only a browser.

    page.py DATABASE PAGE
"""
import html
import itertools
import json
import math
import os
import sys
from pathlib import Path

import numpy

import results
from statistics_of_pairs import paired, ratio

HERE = Path(__file__).resolve().parent
SAME = ("recording", "seed", "repeat")


def number(value, digits=3):
    if value is None or not math.isfinite(value):
        return "–"
    return f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:.0f}"


def ratio_cell(old, new, less_is_better):
    r = ratio(old, new)
    if r is None:
        return "<td>–</td>"
    kind = "" if not (r.significant and less_is_better) else ' class="missed"' if r.value > 1.0 else ' class="better"'
    return f'<td{kind} title="{r.low:.3f} to {r.high:.3f} (95 %), {r.pairs} pairs">{r.value:.3f}</td>'


def values_of(runs, metric):
    return [v for r in runs for v in r["parts"].get(metric, [r[metric]]) if v is not None]


def row(metric, unit, name, runs, ratio_to_first):
    values = values_of(runs, metric)
    if not values:
        return ""
    squares = numpy.square(values)
    cells = (numpy.mean(values), numpy.sqrt(numpy.mean(squares)), *numpy.quantile(values, [0.5, 0.95]), max(values))
    return (f'<tr data-metric="{metric}"><td>{metric}, {unit}</td><td>{html.escape(name)}</td><td>{len(values)}</td>' +
            "".join(f"<td>{number(v)}</td>" for v in cells) + ratio_to_first + "</tr>")


def experiment_part(name, experiment, runs, metrics):
    """A table of one row a metric and variant, and each recording or split if `by` asks for it."""
    variants = list(dict.fromkeys(r["variant"] for r in runs))
    by = experiment["rows_by"]
    groups = [("", runs)]
    if by:
        groups += [(g, [r for r in runs if r[by] == g]) for g in dict.fromkeys(r[by] for r in runs)]
    failed = sum(r["status"] != 0 for r in runs)
    rows = []
    for metric, (group, its_runs), variant in itertools.product(experiment["metrics"].split(), groups, variants):
        first, own = ([r for r in its_runs if r["variant"] == v] for v in (variants[0], variant))
        less_is_better = metrics[metric]["less_is_better"]
        cell = "<td>1</td>" if variant == variants[0] else ratio_cell(*paired(first, own, metric, SAME), less_is_better)
        rows.append(row(metric, metrics[metric]["unit"], f"{group}: {variant}" if group else variant, own, cell))
    return f"""<section data-experiment="{name}"><h2>{html.escape(name)}</h2><p>{html.escape(experiment["about"])}
{len(runs)} runs, {failed} of them failed. The values are those of the runs, or of their parts, such as outages. The ratio
of the means of runs is to the first variant, by pairs of one recording, seed and repeat; it is coloured where its bounds of 95 %
(bootstrap over five or more pairs) leave out 1.</p>
<table><thead><tr><th>metric</th><th>variant</th><th>values</th><th>mean</th><th>rms</th><th>median</th><th>95 %</th>
<th>largest</th><th>ratio</th></tr></thead><tbody>{"".join(rows)}</tbody></table>
{"".join(grid_part(grid, runs, variants, metrics) for grid in json.loads(experiment["grids"]))}
{quoted_part(json.loads(experiment["quoted"]))}
<div class="plots"></div></section>"""


def grid_part(grid, runs, variants, metrics):
    """A table of drives by variants; the last row pools all drives that have every variant."""
    metric, inputs, unit = grid["metric"], grid.get("inputs", []), metrics[grid["metric"]]["unit"]
    drives = list(dict.fromkeys(r["recording"] for r in runs))
    of = {(d, v): [] for d in drives for v in variants}
    for run in runs:
        of[run["recording"], run["variant"]] += values_of([run], metric)
    mean = {at: numpy.mean(values) if values else None for at, values in of.items()}
    whole = [d for d in drives if all(mean[d, v] is not None for v in variants)]
    for v in variants:
        mean["all", v] = numpy.sqrt(numpy.mean([mean[d, v] ** 2 for d in whole])) if whole else None

    def cell(drive, variant):
        value = mean[drive, variant]
        base = min((mean[drive, i] for i in inputs if mean.get((drive, i)) is not None), default=None) if inputs else 1.0
        if value is None or not base:
            return "<td>–</td>"
        kind = ' class="missed"' if value / base > grid["limit"] else ""
        return f'<td{kind} title="{number(value)} {unit}">{value / base:.2f}</td>'

    rows = "".join(f"<tr><td>{html.escape(d)}</td>" + "".join(cell(d, v) for v in variants) + "</tr>" for d in [*drives, "all"])
    what = f"over that of the best of {html.escape(', '.join(inputs))}" if inputs else f"({unit})"
    return f"""<h3>{metric} of each drive</h3><p>{html.escape(metrics[metric]["about"])} A cell is the value {what}, and marked above
{grid["limit"]}; the last row has the root mean square of the {len(whole)} drives that have all.</p>
<div class="wide"><table data-grid="{metric}"><thead><tr><th>drive</th>{"".join(f"<th>{html.escape(v)}</th>" for v in variants)}</tr></thead>
<tbody>{rows}</tbody></table></div>"""


def quoted_part(quoted):
    """A table of others' own figures, which no run here has made."""
    if not quoted:
        return ""
    rows = "".join("<tr>" + "".join(f"<td>{html.escape(each[k])}</td>" for k in ("name", "what", "value", "source")) + "</tr>"
                   for each in quoted)
    return f"""<h3>Quoted, not run here</h3><div class="wide"><table><thead><tr><th>program</th><th>what</th><th>value</th>
<th>source</th></tr></thead><tbody>{rows}</tbody></table></div>"""


def recordings_part(recordings):
    """A table of what `maploop doctor` found in each recording."""
    if not recordings:
        return ""

    def row_of(r):
        name = f'<a href="{html.escape(r["page"])}">{html.escape(r["name"])}</a>' if r["page"] else html.escape(r["name"])
        sensors = json.loads(r["sensors"])
        what = ", ".join(f"{s['sensor']} {number(s['rate_hz'])} Hz" for s in sensors)
        gap = max(sensors, key=lambda s: (s["longest_gap_s"] or 0.0) * (s["rate_hz"] or 0.0), default=None)
        longest = f"{number(gap['longest_gap_s'])} s, {gap['sensor']}" if gap else "–"
        said = r["error"] or "; ".join(f"{s['left_out']} of {s['sensor']}: {s['finding']}" for s in sensors if s["left_out"])
        return f"<tr><td>{name}</td><td>{r['split']}</td><td>{what}</td><td>{longest}</td><td>{html.escape(said)}</td></tr>"

    return f"""<section><h2>Recordings</h2><p>What <code>maploop doctor</code> finds in each; the gap is the longest by the sensor's own rate.</p>
<div class="wide"><table class="recordings"><thead><tr><th>recording</th><th>split</th><th>sensors</th><th>longest gap</th>
<th>left out</th></tr></thead><tbody>{"".join(map(row_of, recordings))}</tbody></table></div></section>"""


def write(database, page):
    runs, experiments, metrics = results.read(database)
    shown = [n for n in metrics if any(r[n] is not None for r in runs)]
    parts = [experiment_part(n, e, [r for r in runs if r["experiment"] == n], metrics) for n, e in experiments.items()
             if any(r["experiment"] == n for r in runs)]
    texts = ("experiment", "recording", "split", "variant", "error", "report")
    data = {"metrics": [{"name": n, **{k: metrics[n][k] for k in ("unit", "about")}} for n in shown],
            "texts": texts,
            "of": {n: e["metrics"].split() for n, e in experiments.items()},
            "rows": [[*(r[t] for t in texts), int(r["seed"]),
                      *(None if r[n] is None else float(f"{r[n]:.5g}") for n in shown)] for r in runs]}
    failed = sum(r["status"] != 0 for r in runs)
    text = (HERE / "page.html").read_text()
    for place, what in (("STYLE", "".join((HERE.parent / "web/design" / f"{sheet}.css").read_text() for sheet in ("tokens", "base"))),
                        ("SUMMARY", f"{len(runs)} runs of {len({r['recording'] for r in runs})} recordings by the "
                                    f"binary {html.escape(runs[0]['code'])}; {failed} failed."),
                        ("PARTS", "\n".join([*parts, recordings_part(results.table(database, "recordings"))])),
                        ("DATA", json.dumps(data, separators=(",", ":")).replace("</", "<\\/"))):
        text = text.replace(f"<!--{place}-->", what)
    partial = Path(str(page) + ".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, page)


if __name__ == "__main__":
    write(sys.argv[1], sys.argv[2])
