"""Reads a catalogue and makes the list of its runs (README.md describes both)."""
import hashlib
import itertools
import json
import os
import re
import shlex
import tomllib
from functools import lru_cache
from pathlib import Path

import jsonschema

from metrics import METRICS

HERE = Path(__file__).parent
LOG = "odometry.lcmlog"  # in the folder of a made recording
MEGABYTES, MEGABYTES_A_SECOND = 400.0, 0.2  # of one run, by its recording's length; one that is killed is repeated with twice as much


class Wrong(Exception):
    """What is wrong with a catalogue, with file and line."""


def line_of(text, where):
    """The line of ("experiment", 1, "seeds") in a TOML text: that of the key, or else that of its table."""
    line, lines = 0, text.splitlines()
    if len(where) >= 2:
        heads = [i for i, each in enumerate(lines) if each.strip() == f"[[{where[0]}]]"]
        line = heads[where[1]] if where[1] < len(heads) else 0
    for key in (step for step in where[2:] if isinstance(step, str)):
        for i in range(line + 1, len(lines)):
            if lines[i].startswith("[["):
                break
            if re.match(rf'\s*"?{re.escape(key)}"?\s*=', lines[i]):
                line = i
                break
    return line + 1


def load(path):
    text = Path(path).read_text(encoding="utf-8")
    try:
        catalogue = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong(f"{path}: {error}") from None
    schema = json.loads((HERE / "catalogue.schema.json").read_text())

    def fail(where, what):
        name = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in where).lstrip(".")
        raise Wrong(f"{path}:{line_of(text, where)}: {name}: {what}")

    for error in jsonschema.Draft7Validator(schema).iter_errors(catalogue):
        what = error.message if error.validator != "oneOf" else "a recording has either 'path' or 'simulate'"
        fail(list(error.absolute_path), what)
    for kind in ("recording", "experiment"):
        names = set()
        for i, each in enumerate(catalogue[kind]):
            own = [of_seed["name"] for of_seed in of_each_seed(each)] if kind == "recording" else [each["name"]]
            for name in own:
                if name in names:
                    fail([kind, i, "name"], f"'{name}' is there twice")
                names.add(name)
    everything = [each for r in catalogue["recording"] for each in of_each_seed(r)]
    known = {r["name"] for r in everything} | {t for r in everything for t in r.get("tags", [])}
    for i, experiment in enumerate(catalogue["experiment"]):
        for name in experiment["recordings"]:
            if name not in known:
                fail(["experiment", i, "recordings"], f"no recording has the name or tag '{name}'")
        for name in experiment["metrics"]:
            if name not in METRICS:
                fail(["experiment", i, "metrics"], f"there is no metric '{name}'; there are {', '.join(METRICS)}")
        for j, grid in enumerate(experiment.get("grid", [])):
            if grid["metric"] not in experiment["metrics"]:
                fail(["experiment", i, "grid", j, "metric"], f"'{grid['metric']}' is not one of the experiment's metrics")
        for recording in chosen_of(everything, experiment):
            has = {*recording.get("values", {}), *(["folder"] if "simulate" in recording else [])}
            for word in sorted(words(experiment) - has):
                fail(["experiment", i, "arguments"], f"the recording '{recording['name']}' has no value '{word}'")

    def expanded(text, where):
        missing = [v for v in re.findall(r"\$(\w+)", text) if v not in os.environ]
        if missing:
            fail(where, f"the environment does not have {missing[0]}")
        return os.path.expandvars(text)

    for i, recording in enumerate(catalogue["recording"]):
        if "path" in recording:
            recording["path"] = str(Path(path).parent.resolve() / expanded(recording["path"], ["recording", i, "path"]))
            if not os.path.exists(recording["path"]):
                fail(["recording", i, "path"], f"there is nothing at {recording['path']}")
        recording["arguments"] = [expanded(a, ["recording", i, "arguments"]) for a in recording.get("arguments", [])]
        for name, value in recording.get("values", {}).items():
            recording["values"][name] = expanded(value, ["recording", i, "values"])
    for i, experiment in enumerate(catalogue["experiment"]):
        experiment["arguments"] = [expanded(a, ["experiment", i, "arguments"]) for a in experiment.get("arguments", [])]
        experiment.setdefault("variants", {"": []})
        if "program" in experiment:
            experiment["program"] = str((Path(path).parent / experiment["program"]).resolve())
            if not os.access(experiment["program"], os.X_OK):
                fail(["experiment", i, "program"], f"there is no program at {experiment['program']}")
    catalogue["recording"] = [each for r in catalogue["recording"] for each in of_each_seed(r)]
    return catalogue


def of_each_seed(recording):
    """A made recording that has seeds, once for each: {seed} stands for it in name and options."""
    keys = ("name", "simulate")
    return [{**recording, **{k: recording[k].replace("{seed}", str(seed)) for k in keys if k in recording}}
            for seed in recording.get("seeds", [0])]


def chosen_of(recordings, experiment):
    return [r for r in recordings if {r["name"], *r.get("tags", [])} & set(experiment["recordings"])]


def words(experiment):
    """The {words} of its arguments, for which each recording has a value."""
    groups = [experiment.get("arguments", []), *experiment.get("variants", {}).values(), *experiment.get("repeats", [])]
    return {word for arguments in groups for each in arguments for word in re.findall(r"\{(\w+)\}", each)}


def with_values(arguments, recording):
    of = {"folder": recording.get("folder"), **recording.get("values", {})}
    return [re.sub(r"\{(\w+)\}", lambda word: of[word[1]], each) for each in arguments]


@lru_cache(maxsize=None)
def fingerprint(path):
    """Names, sizes and times of a recording's files: what changes when it is another one."""
    root = Path(path)
    files = [root] if root.is_file() else sorted(p for p in root.rglob("*") if p.is_file())
    return [(str(p.relative_to(root)), s.st_size, s.st_mtime_ns) for p in files for s in [p.stat()]]


def digest(*what):
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()[:16]


def file_hash(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:16]


def varied(vary):
    """Every combination of the values of the varied parameters."""
    keys = list(vary)
    return [dict(zip(keys, values)) for values in itertools.product(*(vary[k] for k in keys))]


def text_of(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def variant_of(run):
    parts = [run["configuration"], run["named"], run["fault"], *(f"{k}={text_of(v)}" for k, v in run["set"].items())]
    return ", ".join(p for p in parts if p) or "default"


def make_plan(catalogue, made, only=()):
    """The runs of a catalogue. `made` is the folder of made recordings; `only` names experiments, all without any."""
    fingerprint.cache_clear()
    recordings = {r["name"]: dict(r) for r in catalogue["recording"]}
    for r in recordings.values():
        if "simulate" in r:
            r["make"] = ["simulate", *shlex.split(r["simulate"])]
            r["identity"] = r["make"]
            if r.get("log"):
                config = ["--config", r["config"]] if "config" in r else []
                r["record"] = ["replay", r.get("open", "."), *config, "--lockstep", "--no-lcm", "--record", LOG]
                r["identity"] = [*r["make"], *r["record"]]
            r["folder"] = str(Path(made) / (r["name"] + "-" + digest(r["identity"])))
            r["path"] = str(Path(r["folder"]) / (LOG if r.get("log") else r.get("open", "")))
            if "config" in r:
                r["config"] = str(Path(r["folder"]) / r["config"])
        else:
            r["identity"] = list(fingerprint(r["path"]))
            if "config" in r:
                r["identity"].append(file_hash(r["config"]))
    runs = {}
    for experiment in catalogue["experiment"]:
        if only and experiment["name"] not in only:
            continue
        repeats = experiment.get("repeats", [[]])
        program = experiment.get("program", "")
        program_files = [file_hash(f) for f in sorted(Path(program).parent.iterdir()) if f.is_file()] if program else []
        for r, configuration, named, seed, fault, setting, repeat in itertools.product(
                chosen_of(recordings.values(), experiment), experiment.get("configurations", [""]),
                experiment["variants"], experiment.get("seeds", [0]), experiment.get("faults", [""]),
                varied(experiment.get("vary", {})), range(len(repeats))):
            own = with_values([*experiment["arguments"], *experiment["variants"][named], *repeats[repeat]], r)
            arguments = [*r["arguments"], *own]
            if configuration:
                arguments += ["--configuration", configuration]
            if seed:
                arguments += ["--seed", str(seed)]
            if fault:
                arguments += ["--fault", fault]
            for key, value in setting.items():
                arguments += ["--set", f"{key}={text_of(value)}"]
            if "config" in r:
                arguments += ["--config", r["config"]]
            run = {"experiment": experiment["name"], "recording": r["name"], "split": r.get("split", ""),
                   "command": experiment.get("command", "replay"), "program": program,
                   "tags": r.get("tags", []), "configuration": configuration, "named": named, "seed": seed,
                   "repeat": repeat, "fault": fault, "set": setting, "arguments": [r["path"], *arguments], "report": experiment.get("report", False),
                   "seconds": r.get("seconds", 600.0)}
            run["megabytes"] = int(MEGABYTES + MEGABYTES_A_SECOND * run["seconds"])
            run["variant"] = variant_of(run)
            # Such as a map; what is in a made folder follows from how that is made, and is perhaps not there yet.
            files = [fingerprint(a) for a in own if os.path.isfile(a) and not a.startswith(r.get("folder", "\0"))]
            runs[digest(experiment["name"], run["arguments"], r["identity"], *files, *program_files)] = run
    used = {run["recording"] for run in runs.values()}
    made_of = {n: {"folder": r["folder"], "command": r["make"], "record": r.get("record", [])}
               for n, r in recordings.items() if "make" in r and n in used}
    replayed = {run["recording"] for run in runs.values() if run["command"] == "replay" and not run["program"]}
    examined = {f"{n}-{digest(r['identity'])}": {"recording": n, "split": r.get("split", ""), "path": r["path"],
                                                 "arguments": ["--config", r["config"]] if "config" in r else []}
                for n, r in recordings.items() if n in replayed}
    return {"experiments": {e["name"]: e for e in catalogue["experiment"]}, "made": made_of, "examined": examined, "runs": runs}
