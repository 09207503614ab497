#!/usr/bin/env python3
"""`maploop spy` and `maploop profile --live` while a replay publishes: as a script reads them, and as
someone at a terminal sees them. Run it in a network namespace of its own.

    spy_on_a_replay_test.py MAPLOOP
"""
import fcntl
import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time

MAPLOOP = sys.argv[1]
DRIVE = os.path.join(os.environ["MAPLOOP_CACHE"], "2011_09_26/2011_09_26_drive_0013_sync")
ROWS, COLUMNS = 50, 140
ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


def check(what, condition, shown=""):
    if not condition:
        sys.exit(f"FAILED: {what}\n{shown}")
    print(f"ok: {what}")


def replay():
    """Three quarters of a minute of it; returns when it can be heard, which takes a while on a busy machine."""
    publishing = subprocess.Popen([MAPLOOP, "replay", DRIVE, "--loop", "3"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(60):
        heard = subprocess.run([MAPLOOP, "spy", "--once", "--seconds", "1"], capture_output=True,
                               timeout=60, check=False)
        if heard.returncode == 0:
            return publishing
    sys.exit("FAILED: the replay is not heard")


def output(*command):
    result = subprocess.run([MAPLOOP, *command], capture_output=True, text=True, timeout=60,
                            check=False)
    check(f"status of {' '.join(command)}", result.returncode == 0, result.stderr)
    return result.stdout


def halts(table):
    """What a busy machine held up, in seconds, as the table names it: a data clock that stood, a stage that did."""
    return sum(float(s) for s in re.findall(r"(?:stalled \d+ times?, |stuck for )([0-9.]+) s", table))


def for_scripts():
    publishing = replay()
    # A window in which the machine held something up is measured again, twice at most.
    for _ in range(3):
        live = subprocess.Popen([MAPLOOP, "profile", "--live", "--seconds", "7", "--json", "/dev/stderr"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        table = output("spy", "--once", "--seconds", "7")
        out, error = live.communicate(timeout=60)
        check("profile --live: status", live.returncode == 0, error)
        stalled = halts(table)
        if not stalled:
            break
    lines = table.splitlines()
    columns = lines[0].split()
    check("the columns", columns == ["CHANNEL", "TYPE", "COUNT", "RATE_HZ", "JITTER_MS", "AGE_S",
                                     "SILENT_S", "BYTES", "LOST", "BAD"], table)
    rows = {line.split()[0]: dict(zip(columns, line.split()))
            for line in lines[1:] if not line.startswith("#")}
    steady = {"DEADLINES", "GNSS_FIX", "HEALTH", "IMU", "LIDAR_ODOMETRY", "NAV_STATE",
              "NAV_PROTECTION", "ODOMETRY", "ODOM_STATE", "SELF_CALIBRATION", "TRUTH", "VO"}
    now_and_then = {"CALIBRATION", "PREVIEW", "REPLAY_CONTROL", "RUN"}
    check("the channels", steady <= set(rows) <= steady | now_and_then, table)
    types = {"NAV_STATE": "nav_state_t", "VO": "relative_motion_t", "IMU": "imu_t",
             "GNSS_FIX": "gnss_fix_t", "TRUTH": "reference_pose_t", "HEALTH": "health_t",
             "DEADLINES": "deadlines_t", "LIDAR_ODOMETRY": "lidar_motion_t",
             "ODOMETRY": "relative_motion_t", "ODOM_STATE": "odom_state_t",
             "NAV_PROTECTION": "nav_protection_t", "SELF_CALIBRATION": "self_calibration_t"}
    rates = {"NAV_STATE": 100, "ODOM_STATE": 100, "NAV_PROTECTION": 10, "VO": 10, "IMU": 10, "TRUTH": 10,
             "GNSS_FIX": 1, "HEALTH": 1, "DEADLINES": 1, "LIDAR_ODOMETRY": 10, "ODOMETRY": 10, "SELF_CALIBRATION": 1}
    # Where every window was disturbed, the figures are judged by what is left of the last.
    pace = min(1.0, float(rows["NAV_STATE"]["RATE_HZ"]) / rates["NAV_STATE"])
    check("the pace, but for stalls that are named", pace > 0.2 if stalled else pace > 0.9, table)
    for name in sorted(steady):
        row = rows[name]
        check(f"{name}: type", row["TYPE"] == "maploop_lcm." + types[name], table)
        check(f"{name}: rate", 0.7 * pace < float(row["RATE_HZ"]) / rates[name] < 1.3, table)
        check(f"{name}: count", 4 * pace * rates[name] < int(row["COUNT"]) <= 8 * rates[name], table)
        check(f"{name}: jitter", 0.0 <= float(row["JITTER_MS"]) < 500 + 1000 * stalled, table)
        check(f"{name}: age of years-old data", 0.0 <= float(row["AGE_S"]) < 1.5 + stalled, table)
        check(f"{name}: silence", 0.0 <= float(row["SILENT_S"]) < 1.5 + stalled, table)
        check(f"{name}: bytes", int(row["BYTES"]) > 50, table)
        numbered = name not in ("HEALTH", "DEADLINES", "SELF_CALIBRATION")
        check(f"{name}: losses", row["LOST"].isdigit() == numbered, table)
        check(f"{name}: nothing bad", row["BAD"] == "0", table)
    for said in ("# rings: ", "# deadlines: stereo missed"):
        check(f"the line '{said}'", said in table, table)

    rows = [json.loads(line) for line in
            output("spy", "--json", "--once", "--seconds", "2", "--filter", "^NAV_STATE").splitlines()]
    check("JSON of one channel", [row["channel"] for row in rows] == ["NAV_STATE"], rows)
    check("JSON has numbers", rows[0]["rate_hz"] > 50 * pace and rows[0]["bad"] == 0, rows)

    check("profile --live: table", "From release to result" in out, out)
    check("profile --live: figures", json.loads(error)["threads"]["fusion"]["count"] > 300 * pace, error)
    check("the replay has ended well", publishing.wait(timeout=60) == 0)


class Terminal:
    """The spy under a pseudo-terminal."""

    def __init__(self, *options):
        self.master, self.slave = pty.openpty()
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        self.before = termios.tcgetattr(self.slave)
        self.seen = ""
        self.process = subprocess.Popen([MAPLOOP, "spy", *options], stdin=self.slave,
                                        stdout=self.slave, stderr=subprocess.PIPE)

    def read(self, seconds):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select.select([self.master], [], [], left)[0]:
                self.seen += os.read(self.master, 65536).decode(errors="replace")

    def picture(self):
        """The last whole one."""
        pictures = self.seen.split("\x1b[H")
        return pictures[-2] if len(pictures) > 2 else ""

    def until(self, what, condition, seconds=20):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.read(0.3)
            if condition(self.picture()):
                print(f"ok: {what}")
                return
        sys.exit(f"FAILED: {what}\n{ESCAPE.sub('', self.picture())}")

    def selected(self):
        match = re.search(r"\x1b\[7m(\S+)", self.picture())
        return match.group(1) if match else ""

    def press(self, keys):
        os.write(self.master, keys.encode())

    def ended_and_restored(self, how):
        end = time.monotonic() + 20
        while self.process.poll() is None and time.monotonic() < end:
            self.read(0.1)
        self.read(0.2)
        check(f"{how}: ends well", self.process.poll() == 0, self.process.poll())
        check(f"{how}: the terminal's mode is as before",
              termios.tcgetattr(self.slave) == self.before)
        check(f"{how}: the cursor and the screen are back",
              self.seen.rstrip().endswith("\x1b[?25h\x1b[?1049l"), repr(self.seen[-80:]))


def at_a_terminal():
    publishing = replay()
    spy = Terminal()
    spy.until("the channels come", lambda p: all(c in p for c in ("NAV_STATE", "VO", "HEALTH")))
    check("single keys, unechoed", not termios.tcgetattr(spy.slave)[3] & (termios.ICANON | termios.ECHO))
    check("a channel is selected", spy.selected() != "", spy.picture())
    spy.press("/NAV_STATE\r")
    spy.until("a filter leaves one", lambda p: "NAV_STATE" in p and "GNSS_FIX" not in p)
    spy.until("its fields are shown", lambda p: "header.stamp_ns = 131704" in p
              and "covariance[9][9] = " in p)
    first = re.search(r"header.sequence = (\d+)", spy.picture()).group(1)
    spy.until("they are live", lambda p: f"header.sequence = {first}\x1b" not in p
              and "header.sequence" in p)
    spy.press("/" + "\x7f" * len("NAV_STATE") + "\r")
    spy.until("all come back", lambda p: "GNSS_FIX" in p)
    was = spy.selected()
    spy.press("\x1b[B")
    spy.until("an arrow selects the next", lambda p: spy.selected() not in ("", was))
    spy.until("rings and deadlines", lambda p: "rings: " in p and "deadlines: stereo" in p)
    spy.press("q")
    spy.ended_and_restored("q")

    spy = Terminal("--filter", "VO")
    spy.until("a filter from the command line", lambda p: "VO" in p and "NAV_STATE" not in p)
    spy.process.send_signal(signal.SIGINT)
    spy.ended_and_restored("SIGINT")
    spy = Terminal("--seconds", "1")
    spy.ended_and_restored("--seconds")
    publishing.wait(timeout=60)


if __name__ == "__main__":
    if not os.path.isdir(DRIVE):
        print("SKIPPED, NOT TESTED: the recorded drive is missing; run tools/restore-drive",
              file=sys.stderr)
        sys.exit(77)
    for_scripts()
    at_a_terminal()
