#!/usr/bin/python3
"""Makes or examines one recording, or makes one run. The file of its result appears whole or not at all.

    job.py make SETUP
    job.py doctor SETUP RESULT
    job.py run SETUP RESULT LAST        LAST is 1 at the last attempt

SETUP is what a plan says of it (catalogue.py), with the plan's binary, code and folder of results, as JSON: reading a
plan of ten thousand runs would take longer than a short run.

A run that ends with an error has a result that says so. One that was killed has none, so that it is tried again with
more memory and time; at the last attempt it has a result, too.
"""
import json
import os
import platform
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 20.0  # times the recording's length, and a minute


def make(made):
    folder = Path(made["folder"])
    partial = folder.with_name(folder.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run([made["binary"], *made["command"], "--out", partial], check=True, stdout=subprocess.DEVNULL)
    if made["record"]:
        subprocess.run([made["binary"], *made["record"]], check=True, cwd=partial, stdout=subprocess.DEVNULL)
    shutil.rmtree(folder, ignore_errors=True)
    os.rename(partial, folder)


def write_whole(result, record):
    partial = Path(result + f".{os.getpid()}.partial")
    partial.write_text(json.dumps(record))
    os.replace(partial, result)


def doctor(setup, result):
    """What is in a recording, and how sound it is."""
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "output.json"
        done = subprocess.run([setup["binary"], "doctor", setup["path"], *setup["arguments"], "--json", output, "--html", result + ".html"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
        found = json.loads(output.read_text()) if output.exists() else {}
    write_whole(result, {**setup, "error": (done.stderr.strip()[-500:] or f"it ended with status {done.returncode}") if done.returncode else "",
                         "sensors": found.get("sensors", []), "sentences": found.get("sentences", []),
                         "page": f"../doctor/{Path(result).name}.html" if os.path.exists(result + ".html") else ""})


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("flags"):
            return sorted(set(line.split()) & {"avx2", "avx512f", "fma", "sse4_2"})
    return [platform.machine()]


def run(setup, result, last):
    key = setup["key"]
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "output.json"
        if setup["program"]:
            raw = Path(setup["results"]).with_name("raw") / key
            shutil.rmtree(raw, ignore_errors=True)
            raw.mkdir(parents=True)
            command = [setup["program"], "--maploop", setup["binary"], "--raw", str(raw)]
        else:
            command = [setup["binary"], setup["command"]]
            if setup["command"] == "replay":
                command += ["--lockstep", "--no-lcm"]
        command += ["--json", str(output), *setup["arguments"]]
        report = Path(setup["results"]).with_name("reports") / f"{key}.html"
        if setup["report"]:
            report.parent.mkdir(exist_ok=True)
            command += ["--report", str(report)]
        began = time.monotonic()
        limit = PATIENCE * setup["seconds"] + 60.0
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=limit,
                                  errors="replace")
            status, said = done.returncode, done.stderr
        except subprocess.TimeoutExpired:
            status, said = -9, f"it did not end within {limit:.0f} s"
        if status < 0 and not last:
            sys.exit(f"{key}: killed by signal {-status}; it is tried again")
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        job = {"cpu_s": round(used.ru_utime + used.ru_stime, 3), "peak_mb": round(used.ru_maxrss / 1024.0, 1)}
        record = {"schema": 1, **setup, "machine": processor(),
                  "status": status, "error": said.strip()[-500:] if status else "",
                  "wall_s": round(time.monotonic() - began, 3),
                  "report": f"../reports/{key}.html" if report.exists() else "",
                  "output": {"job": job, **json.loads(output.read_text())} if output.exists() else None}
    write_whole(result, record)


if __name__ == "__main__":
    what = json.loads(sys.argv[2])
    if sys.argv[1] == "make":
        make(what)
    elif sys.argv[1] == "doctor":
        doctor(what, sys.argv[3])
    else:
        run(what, sys.argv[3], sys.argv[4] == "1")
