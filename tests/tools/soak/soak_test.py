"""Tests what a soak checks, how it breaks links, and a soak of a minute.

    soak_test.py FOLDER_OF_THE_SOAK MAPLOOP
"""
import json
import math
import random
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOAK, MAPLOOP = sys.argv[1:3]
sys.path.insert(0, SOAK)

import checks  # noqa: E402
import link  # noqa: E402
import vehicle  # noqa: E402


def memory(growth, hours=1.0):
    """Returns samples of every second, with noise, after a start that takes memory."""
    draw = random.Random(1)
    return [(t, 100.0 + 20.0 * math.exp(-t / 20.0) + growth * t / 3600.0 + draw.gauss(0.0, 0.1)) for t in range(int(3600 * hours))]


class Checks(unittest.TestCase):
    def test_memory_may_only_grow_at_the_start(self):
        self.assertEqual(checks.memory_grows(memory(0.0)), "")
        self.assertEqual(checks.memory_grows(memory(0.9)), "")
        self.assertRegex(checks.memory_grows(memory(2.0)), r"^memory grows by [12]\.\d+ \+-0\.\d+ MB an hour$")

    def test_a_short_run_cannot_tell(self):
        self.assertEqual(checks.memory_grows(memory(100.0, 0.1)), "")
        self.assertEqual(checks.memory_grows([]), "")

    def test_open_files_may_come_and_go(self):
        count = [(t, 30 + t % 3) for t in range(100)]
        self.assertEqual(checks.handles_grow(count), "")
        self.assertEqual(checks.handles_grow([(t, n + (t > 80) * 3) for t, n in count]), "open files grow from 32 to 33")
        self.assertEqual(checks.handles_grow([]), "")

    def test_samples_of_a_ring_add_up(self):
        ring = {"name": "a -> b", "pushed": 1000, "popped": 900, "lost": 30, "held": 6}
        self.assertEqual(checks.leaking_rings({"rings": [ring]}), [])
        self.assertEqual(checks.leaking_rings({"rings": [ring]}, 63), ["ring a -> b: 1000 in, but 900 out, 30 lost and 6 held"])

    def test_only_lasting_errors_count(self):
        def at(*stretches):
            return [(t / 10.0, 16.0 if any(a <= t <= b for a, b in stretches) else 1.0) for t in range(1000)]

        self.assertEqual(checks.wrong_stretches(at((100, 150), (300, 340))), [])
        self.assertEqual(checks.wrong_stretches(at((100, 151))), [(10.0, 15.1, 4.0)])
        self.assertEqual(checks.wrong_stretches(at((900, 2000))), [(90.0, 99.9, 4.0)])

    def test_only_warnings_of_the_present_count(self):
        self.assertFalse(checks.tells_of_a_sensor(["camera: there is none; the rest goes without", "imu: silent for 5.3 s from 0.0 s on"]))
        self.assertTrue(checks.tells_of_a_sensor(["velodyne: there is none", "imu: stale, nothing new for 2.31 s"]))

    def test_errors_are_in_the_states_own_sigmas(self):
        state = {"origin_latitude": math.radians(49.0), "origin_longitude": math.radians(8.4), "position_enu": [30.0, 0.0, 0.0],
                 "covariance": [[100.0, 0.0], [0.0, 25.0]]}
        squared, metres = vehicle.errors(state, (49.0, 8.4))
        self.assertAlmostEqual(squared, 9.0)
        self.assertAlmostEqual(metres, 30.0)
        a_minute_north = (49.0 + 1.0 / 60.0, 8.4)  # 1853.6 m on the ellipsoid
        self.assertAlmostEqual(vehicle.errors({**state, "position_enu": [0.0, 1853.6, 0.0]}, a_minute_north)[1], 0.0, delta=0.5)


class Links(unittest.TestCase):
    def setUp(self):
        self.out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.out.bind(("127.0.0.1", 0))
        self.out.settimeout(5.0)
        free = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        free.bind(("127.0.0.1", 0))
        self.port = free.getsockname()[1]
        free.close()
        self.link = link.FaultyLink(self.port, self.out.getsockname()[1], 1)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def tearDown(self):
        self.link.close()
        self.out.close()
        self.sender.close()

    def through(self, fault, datagrams, wait_for):
        """Returns the datagrams that arrive until there are `wait_for`, and then one that is not broken."""
        self.link.fault = fault
        for datagram in datagrams:
            self.sender.sendto(datagram, ("127.0.0.1", self.port))
        arrived = [self.out.recv(65536) for _ in range(wait_for)]
        while self.link.passed + self.link.broken < len(datagrams):
            time.sleep(0.01)
        self.link.fault = None
        self.sender.sendto(b"last", ("127.0.0.1", self.port))
        while (datagram := self.out.recv(65536)) != b"last":
            arrived.append(datagram)
        return arrived

    def test_a_whole_link_passes_all_on(self):
        self.assertEqual(self.through(None, [b"one", b"two"], 2), [b"one", b"two"])

    def test_each_fault_is_what_its_name_says(self):
        sent = [b"one", b"two", b"three", b"four"]
        self.assertEqual(self.through("lost", sent, 0), [])
        self.assertEqual(self.through("repeated", sent, 12), [d for d in sent for _ in range(3)])
        self.assertEqual(self.through("reordered", sent, 4), [b"two", b"one", b"four", b"three"])
        late = self.through("late", sent, 4)
        self.assertEqual(sorted(late), sorted(sent))
        for whole, cut in zip(sent, self.through("cut", sent, 4)):
            self.assertTrue(len(cut) < len(whole) and whole.startswith(cut))
        for whole, corrupt in zip(sent, self.through("corrupt", sent, 4)):
            self.assertEqual(len(corrupt), len(whole))

    def test_a_flood_needs_no_sender(self):
        self.assertGreater(len(self.through("flood", [], 50)), 49)


class WholeSoak(unittest.TestCase):
    def test_a_minute_of_lost_and_cut_datagrams(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "soak"
            # The patience is that of a computer that does other things too.
            done = subprocess.run([f"{SOAK}/run", "0.015", "--binary", MAPLOOP, "--out", out, "--patience", "90", "--kinds", "lost", "cut gnss"],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if done.returncode == 77:
                self.skipTest(done.stdout.strip())
            self.assertEqual(done.returncode, 0, done.stdout)
            told = json.loads((out / "soak.json").read_text())
            self.assertEqual(told["violations"], [])
            self.assertGreaterEqual(len(told["recoveries_s"]), 1)
            self.assertGreater(told["states"], 100)

    def test_what_cannot_be_run_is_refused(self):
        for words, why in ((["0"], "HOURS wants a number"), (["1", "--binary", "/none"], "there is no program /none"), (["1", "--out", "/"], "/ exists")):
            done = subprocess.run([f"{SOAK}/run", *words], stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(why, done.stderr)


unittest.main(argv=sys.argv[:1])
