"""The steps of a check: numbered on stderr with the time that is left, measured, their output in files."""
import json
import os
import subprocess
import sys
import time


def say(text):
    print(f"      {text}", file=sys.stderr, flush=True)


def minutes(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def processor_ticks():
    """Idle and total time of all processors since the machine started."""
    with open("/proc/stat", encoding="ascii") as file:
        values = [int(word) for word in file.readline().split()[1:9]]
    return values[3] + values[4], sum(values)


class StepFailed(Exception):
    """A step whose output says why; nothing after it can run."""


class Steps:
    """Runs one step after the other and keeps how long each took.

    `expected` has the seconds that each step took the last time, by its name.
    """

    def __init__(self, names, expected, log):
        self.waiting = list(names)
        self.number = 0
        self.total = len(names)
        self.expected = expected
        self.log = log
        self.rows = []

    def left(self):
        """The seconds that the steps which have not begun will take, as far as that is known."""
        return sum(self.expected.get(name, 0.0) for name in self.waiting)

    def add_finished(self, name, seconds):
        """A step that ran before this program."""
        self.rows.append({"step": name, "seconds": seconds, "finished": True})

    def run(self, name, work):
        """Calls `work`, which returns a dictionary of what else is worth keeping of the step."""
        self.number += 1
        left = self.left()
        about = f" (about {round(left / 60)} min left)" if left > 90 else ""
        print(f"[{self.number}/{self.total}] {name}{about}", file=sys.stderr, flush=True)
        self.waiting.remove(name)
        began, (idle, total) = time.monotonic(), processor_ticks()
        row = {"step": name}
        self.rows.append(row)
        row["finished"] = False
        try:
            row.update(work() or {})
            row["finished"] = True
        finally:
            idle_now, total_now = processor_ticks()
            row["seconds"] = round(time.monotonic() - began, 1)
            row["idle"] = round((idle_now - idle) / max(1, total_now - total), 3)
            say(f"{minutes(row['seconds'])} min")
        return row

    def logged(self, name, command, **options):
        """Runs a command with its output in a file; raises StepFailed with the end of it."""
        path = os.path.join(self.log, name + ".txt")
        with open(path, "w", encoding="utf-8") as file:
            status = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                    check=False, **options).returncode
        if status != 0:
            with open(path, encoding="utf-8", errors="replace") as file:
                sys.stderr.write("".join(file.readlines()[-60:]))
            raise StepFailed(f"FAILED: {name} (all of it: {path})")


class History:
    """How long steps and tests took the last time, kept outside the tree so that a new checkout knows it."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, encoding="utf-8") as file:
                self.seconds = json.load(file)
        except (OSError, ValueError):
            self.seconds = {}

    def of(self, kind):
        return self.seconds.get(kind, {})

    def update(self, kind, seconds):
        self.seconds.setdefault(kind, {}).update(seconds)

    def save(self):
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        temporary = f"{self.path}.{os.getpid()}"
        with open(temporary, "w", encoding="utf-8") as file:
            json.dump(self.seconds, file)
        os.replace(temporary, self.path)
