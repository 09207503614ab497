#!/usr/bin/python3
"""Collects the results of a plan in one SQLite file, a row a run; a spreadsheet, DuckDB or pandas opens it.

    results.py PLAN DATABASE
"""
import json
import os
import sqlite3
import sys
from pathlib import Path

from metrics import METRICS, value, values

TEXTS = ("key", "experiment", "recording", "split", "tags", "variant", "configuration", "named", "fault", "settings", "error",
         "code", "hash", "report")
NUMBERS = ("seed", "repeat", "status", "wall_s")


def row_of(record):
    output = record["output"] or {}
    texts = {**record, "tags": " ".join(record["tags"]), "settings": json.dumps(record["set"]),
             "hash": output.get("channels", {}).get("NAV_STATE", {}).get("hash", "")}
    return ([texts[name] for name in TEXTS] + [record[name] for name in NUMBERS] +
            [value(name, output) for name in METRICS])


def collect(plan, database):
    partial = Path(str(database) + ".partial")
    partial.unlink(missing_ok=True)
    db = sqlite3.connect(partial)
    columns = [f"{n} TEXT" for n in TEXTS] + [f"{n} REAL" for n in (*NUMBERS, *METRICS)]
    db.execute(f"CREATE TABLE runs ({', '.join(columns)}, PRIMARY KEY (key))")
    db.execute("CREATE TABLE parts (key TEXT, metric TEXT, value REAL)")  # of metrics that are of parts of a run
    db.execute("CREATE TABLE experiments (name TEXT PRIMARY KEY, about TEXT, metrics TEXT, rows_by TEXT, grids TEXT, quoted TEXT)")
    db.execute("CREATE TABLE metrics (name TEXT PRIMARY KEY, unit TEXT, about TEXT, less_is_better INTEGER)")
    for name, e in plan["experiments"].items():
        db.execute("INSERT INTO experiments VALUES (?, ?, ?, ?, ?, ?)",
                   (name, e.get("about", ""), " ".join(e["metrics"]), e.get("by", ""), json.dumps(e.get("grid", [])),
                    json.dumps(e.get("quoted", []))))
    db.executemany("INSERT INTO metrics VALUES (?, ?, ?, ?)",
                   ((n, m.unit, m.about, m.less_is_better) for n, m in METRICS.items()))
    db.execute("CREATE TABLE recordings (name TEXT, split TEXT, error TEXT, sensors TEXT, sentences TEXT, page TEXT)")
    for name in plan["examined"]:
        found = json.loads((Path(plan["doctor"]) / f"{name}.json").read_text())
        db.execute("INSERT INTO recordings VALUES (?, ?, ?, ?, ?, ?)",
                   (found["recording"], found["split"], found["error"], json.dumps(found["sensors"]),
                    "\n".join(found["sentences"]), found["page"]))
    marks = ", ".join("?" * len(columns))
    for key, setup in plan["runs"].items():
        record = json.loads((Path(plan["results"]) / f"{key}.json").read_text())
        # The catalogue may have said something else when the run was made.
        record.update({name: setup[name] for name in ("split", "tags") if name in setup})
        db.execute(f"INSERT INTO runs VALUES ({marks})", row_of(record))
        for name in plan["experiments"][record["experiment"]]["metrics"]:
            parts = values(name, record["output"] or {})
            if len(parts) > 1:
                db.executemany("INSERT INTO parts VALUES (?, ?, ?)", ((key, name, part) for part in parts))
    db.commit()
    db.close()
    os.replace(partial, database)


def table(database, name):
    """The rows of a table as dictionaries."""
    if not os.path.exists(database):
        raise FileNotFoundError(f"there is no database at {database}: tools/fleet/run makes one")
    db = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    db.row_factory = sqlite3.Row
    return [dict(row) for row in db.execute(f"SELECT * FROM {name}")]


def read(database):
    """The runs of a database, with the tables of experiments and metrics by name.

    `parts` of a run has the values of each metric that is of several parts of it.
    """
    runs = {r["key"]: {**r, "parts": {}} for r in table(database, "runs")}
    for part in table(database, "parts"):
        runs[part["key"]]["parts"].setdefault(part["metric"], []).append(part["value"])
    return list(runs.values()), *({row["name"]: row for row in table(database, name)} for name in ("experiments", "metrics"))


if __name__ == "__main__":
    collect(json.loads(Path(sys.argv[1]).read_text()), sys.argv[2])
