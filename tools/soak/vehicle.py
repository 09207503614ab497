"""The programs of a soak: the vehicle, the sender of its sensors' data, and what is seen of them."""
import bisect
import http.client
import json
import math
import os
import re
import subprocess
import threading
import time
from datetime import datetime, timezone
from pathlib import Path

PORTS = {"imu": (3001, 3000), "gnss": (4001, 4000)}  # where the sender sends to, and where the vehicle listens
EARTH = 6378137.0  # m


def make_town(binary, folder, seconds, seed):
    subprocess.run([binary, "simulate", "--sensors", "imu,gnss", "--seconds", str(seconds), "--seed", str(seed), "--out", folder],
                   check=True, stdout=subprocess.DEVNULL)
    return Town(folder)


class Town:
    """A simulated drive: what is sent of it, and where the vehicle truly was."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.drive = self.folder / "town_extract"
        oxts = self.drive / "oxts"
        # The truth is that of the stamps: this unit's rows state where it is then, apart from its delay.
        self.times = [self._seconds(line) for line in (oxts / "timestamps.txt").read_text().splitlines() if line.strip()]
        rows = [row.read_text().split()[:2] for row in sorted((oxts / "data").iterdir())]
        self.places = [(float(latitude), float(longitude)) for latitude, longitude in rows]

    @staticmethod
    def _seconds(stamp):
        whole, fraction = stamp.strip().split(".")
        return datetime.strptime(whole, "%Y-%m-%d %H:%M:%S").replace(tzinfo=timezone.utc).timestamp() + float("0." + fraction)

    def place(self, t):
        """Returns latitude and longitude (degrees) at a time of the drive, or nothing outside of it."""
        i = bisect.bisect(self.times, t)
        if i == 0 or i == len(self.times):
            return None
        share = (t - self.times[i - 1]) / (self.times[i] - self.times[i - 1])
        return tuple(a + share * (b - a) for a, b in zip(self.places[i - 1], self.places[i]))


class Sender:
    """Sends the drive once. Its times are shifted to the present."""

    def __init__(self, binary, town, folder):
        self.truth = Path(folder) / "truth.tum"
        config = Path(folder) / "send.toml"
        config.write_text("[ppp]\nobservations = false\n")  # fixes, as a receiver has them
        self.process = subprocess.Popen(
            [binary, "send", town.drive, "--config", config, "--truth", self.truth,
             *(word for name, (port, _) in PORTS.items() for word in (f"--{name}", f"udp://:{port}"))],
            stdout=subprocess.DEVNULL)
        self._first = town.times[0]

    def ended(self):
        return self.process.poll() is not None

    def end(self):
        """Ends it now, and waits until its truth is written. Returns its exit status."""
        if not self.ended():
            self.process.send_signal(2)
        return self.process.wait(timeout=60)

    def shift(self):
        """Returns what the drive's times were shifted by; after the end."""
        with open(self.truth) as truth:
            return float(truth.readline().split()[0]) - self._first


class Vehicle:
    """`maploop live`, which can be killed and started again, with its processor, memory and open files."""

    def __init__(self, binary, town, folder, disk):
        self.binary, self.folder = binary, Path(folder)
        config = self.folder / "live.toml"
        described = (town.folder / "vehicle.toml").read_text().replace('file = "map.osm"', f'file = "{town.folder}/map.osm"')
        config.write_text(described + "\n[live]\n" + "".join(f'{name} = "udp://:{port}"\n' for name, (_, port) in PORTS.items()))
        self._command = [binary, "live", config, "--state", Path(disk) / "maploop.state", "--black-box", self.folder / "run.box",
                         "--black-box-size", "50", "--json", self.folder / "end.json"]
        self.lives = 0
        self.log = open(self.folder / "live.txt", "w")
        self.start()

    def start(self):
        self.lives += 1
        self.process = subprocess.Popen(self._command, stdout=self.log, stderr=subprocess.STDOUT)
        self.memory, self.handles = [], []  # (s, MB), (s, count) of this life

    def look(self):
        """Notes memory and open files; returns whether it runs."""
        if self.process.poll() is not None:
            return False
        now = time.monotonic()
        try:
            status = Path(f"/proc/{self.process.pid}/status").read_text()
            self.handles.append((now, len(os.listdir(f"/proc/{self.process.pid}/fd"))))
        except OSError:
            return False
        self.memory.append((now, int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024.0))
        return True

    def signal(self, number):
        self.process.send_signal(number)

    def end(self):
        """Ends it as Ctrl-C does. Returns its exit status and its rings."""
        self.signal(2)
        status = self.process.wait(timeout=60)
        rings = json.loads((self.folder / "end.json").read_text())["rings"]
        return status, [{"name": name, **ring} for name, ring in rings.items()]


class Observer:
    """Reads what the dashboard tells of the newest run."""

    def __init__(self, binary, folder):
        self.process = subprocess.Popen([binary, "dashboard", "--port", "0"], stdout=subprocess.PIPE,
                                           stderr=open(Path(folder) / "dashboard.txt", "w"), text=True)
        self._port = int(re.search(r":(\d+)", self.process.stdout.readline())[1])
        self._lock = threading.Lock()
        self._newest = {}  # channel: (monotonic s, message)
        self._states = []
        self._ended = False
        threading.Thread(target=self._run, daemon=True).start()

    def newest(self, channel, age=3.0):
        """Returns the newest message of a channel that is not older than `age` seconds, or nothing."""
        with self._lock:
            when, message = self._newest.get(channel, (0.0, None))
        return message if time.monotonic() - when < age else None

    def take_states(self):
        """Returns the states since the last call."""
        with self._lock:
            states, self._states = self._states, []
        return states

    def runs(self):
        return self.process.poll() is None

    def end(self):
        self._ended = True
        self.process.send_signal(2)
        return self.process.wait(timeout=60)

    def _run(self):
        run = None
        while not self._ended:
            try:
                run = self._follow(run)
            except (OSError, http.client.HTTPException):
                time.sleep(0.5)

    def _follow(self, run):
        """Reads the events of a run until another one has come, which is returned."""
        connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=30)
        connection.request("GET", f"/events?run={run}" if run else "/events")
        for line in connection.getresponse():
            if not line.startswith(b"data:"):
                continue
            event = json.loads(line[5:])
            channel, message = event["channel"], event["message"]
            if channel == "RUNS":
                going = [r["id"] for r in message if not r["ended"]]
                if going and going[-1] != run:
                    connection.close()
                    return going[-1]
                continue
            with self._lock:
                self._newest[channel] = (time.monotonic(), message)
                if channel == "NAV_STATE":
                    self._states.append(message)
        return None


def errors(state, place):
    """Returns the horizontal distance of a state from a place (degrees): squared, in the state's own sigmas, and in m."""
    latitude, longitude = (math.radians(angle) for angle in place)
    north = (latitude - state["origin_latitude"]) * EARTH * (1.0 - 0.00669438 * (1.0 - 1.5 * math.sin(latitude) ** 2))
    east = (longitude - state["origin_longitude"]) * EARTH * math.cos(latitude) * (1.0 + 0.00335281 * math.sin(latitude) ** 2)
    x, y = state["position_enu"][0] - east, state["position_enu"][1] - north
    (a, b), (_, d) = (row[:2] for row in state["covariance"][:2])
    return (d * x * x - 2.0 * b * x * y + a * y * y) / (a * d - b * b), math.hypot(x, y)
