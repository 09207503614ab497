"""What all programs that are compared have in common: they are run, measured and scored in the same way.

A program of a catalogue is called as

    PROGRAM --maploop FILE --json FILE --raw FOLDER RECORDING [ARGUMENTS]

It leaves what the contender wrote in the folder, and its processor time, peak memory and errors in the JSON file.
"""
import argparse
import json
import os
import resource
import subprocess
import sys
from pathlib import Path


def options(about, programs):
    """The parser of such a program's arguments."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("recording")
    parser.add_argument("--program", choices=programs, required=True, help="the contender")
    parser.add_argument("--truth", required=True, help="what it is scored with")
    parser.add_argument("--maploop", required=True)
    parser.add_argument("--json", required=True)
    parser.add_argument("--raw", required=True, type=Path, help="where to leave what the contender wrote")
    return parser


def run(command, folder, **environment):
    """Runs the contender in the folder; returns its processor time and memory. It must be the first child process."""
    log = folder / "log.txt"
    with open(log, "w", encoding="utf-8") as said:
        status = subprocess.run([str(word) for word in command], cwd=folder, stdout=said, stderr=subprocess.STDOUT,
                                env={**os.environ, **environment}).returncode
    if status:
        last = log.read_text(encoding="utf-8", errors="replace").strip()[-300:]
        sys.exit(f"{Path(str(command[0])).name} ended with status {status}: {last}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"cpu_s": used.ru_utime + used.ru_stime, "peak_mb": used.ru_maxrss / 1024.0}


def score(o, estimate, job, *how):
    """Scores the file of a contender by `maploop evaluate`, and writes the result."""
    scores = o.raw / "scores.json"
    done = subprocess.run([o.maploop, "evaluate", estimate, "--json", scores, *how], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{estimate} cannot be scored: {done.stderr.strip()}")
    Path(o.json).write_text(json.dumps({"job": job, "score": json.loads(scores.read_text(encoding="utf-8"))}), encoding="utf-8")
