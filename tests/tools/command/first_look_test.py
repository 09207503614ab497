#!/usr/bin/env python3
"""What a new user tries first: every --help, no argument, files that are missing, empty or something else, numbers
that are none. Status 2 is a command line that is not understood, 1 a failure; each says what, where, what to do.

    first_look_test.py MAPLOOP
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

MAPLOOP = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else sys.exit(__doc__)

# What reads one file, and what stands before and after its name.
READERS = ["replay FILE --lockstep --no-lcm", "odometry FILE", "odometry FILE --lidar", "match FILE track.csv", "ppp FILE",
           "gnss info FILE", "evaluate FILE FILE", "map info FILE", "map build FILE out.net", "map doubts FILE track.csv", "log info FILE",
           "log split FILE -o out", "log merge FILE -o out", "log recover FILE -o out", "profile FILE",
           "spy FILE --once", "sensors pcap FILE", "odometry FILE --json x.json",
           "calibrate FILE --board 9x6 --square 0.1", "doctor --config FILE", "replay FILE --config FILE",
           "evaluate match FILE FILE", "vehicle check FILE", "vehicle draw FILE out.svg"]
# What takes a missing or empty log for one without an event.
EMPTY_IS_FINE = {"log info FILE", "log merge FILE -o out", "doctor --config FILE", "vehicle check FILE", "vehicle draw FILE out.svg"}


def run(words, where):
    done = subprocess.run([MAPLOOP, *words], cwd=where, capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


def subcommands(text):
    listed = re.search(r"^Subcommands:\n((?:  .*\n?)*)", text, re.MULTILINE)
    return re.findall(r"^  ([a-z][a-z-]*)", listed.group(1), re.MULTILINE) if listed else []


class FirstLook(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.mkdir(os.path.join(self.folder.name, "folder"))
        for name, text in (("empty", ""), ("other.txt", "this is something else\n"), ("track.csv", "t,lat,lon\n0,49,8.4\n")):
            with open(os.path.join(self.folder.name, name), "w", encoding="utf-8") as file:
                file.write(text)

    def expect(self, line, status, *said):
        with self.subTest(line):
            code, _, error = run(line.split(), self.folder.name)
            self.assertEqual(code, status, error)
            for words in said:
                self.assertIn(words, error)
            return error

    def commands(self, words=()):
        code, text, _ = run([*words, "--help"], self.folder.name)
        self.assertEqual(code, 0, words)
        yield words, text
        for name in subcommands(text):
            yield from self.commands((*words, name))

    def test_every_help_is_short_of_internals(self):
        seen = 0
        for words, text in self.commands():
            seen += 1
            with self.subTest(words):
                self.assertNotRegex(text, r"ENUM|->|e\+\d\d|1797693")
                self.assertLessEqual(max(map(len, text.splitlines())), 80)
        self.assertGreater(seen, 25)

    def test_a_command_that_lacks_something_says_what(self):
        for words, text in list(self.commands()):
            if words in (("doctor",), ("dashboard",), ("spy",), ("live",), ("vehicle", "new")):
                continue
            code, _, error = run(words, self.folder.name)
            with self.subTest(words):
                self.assertEqual(code, 2, error)
                self.assertRegex(error, "is required|Subcommands:")

    def test_a_name_that_is_not_known(self):
        self.expect("foo", 2, "no subcommand 'foo'")
        self.expect("log inof x", 2, "did you mean 'info'")
        self.expect("replay x --lokstep", 2, "did you mean '--lockstep'", "'maploop replay --help'")

    def test_a_file_that_is_missing_is_named(self):
        for reader in READERS:
            self.expect(reader.replace("FILE", "nowhere.bin"), 1, "nowhere.bin")

    def test_a_file_that_is_empty_or_something_else(self):
        for reader in READERS:
            for name in ("empty", "other.txt"):
                if name == "empty" and reader in EMPTY_IS_FINE:
                    continue
                self.expect(reader.replace("FILE", name), 1)

    def test_a_folder_that_is_something_else(self):
        for reader in READERS:
            self.expect(reader.replace("FILE", "folder"), 1, "folder")

    def test_what_is_no_log_is_not_called_a_damaged_one(self):
        error = self.expect("replay other.txt --lockstep --no-lcm", 1, "it is not a log")
        self.assertNotIn("recover", error)

    def test_numbers_that_are_none(self):
        for line in ("replay x --speed abc", "replay x --speed nan", "replay x --speed 0", "replay x --end -1",
                     "replay x --speed-scale nan", "replay x --loop -1", "odometry empty --first -1",
                     "evaluate x y --lengths nan", "match x y --sigma nan", "match x y --box 1,2,3,nan",
                     "ppp x --mask nan", "sensors listen --imu udp://:3000 --seconds nan"):
            error = self.expect(line, 2, "is no ")
            self.assertLess(len(error), 300)

    def test_choices_are_listed(self):
        self.expect("odometry empty --matching orb", 2, "klt", "sift")
        self.expect("odometry empty --motion 4d", 2, "3d-2d", "2d-2d")
        self.expect("odometry empty --lidar --seed x", 2, "vo", "motion", "none")
        self.expect("odometry empty --lidar --tracks x.csv", 2, "--lidar")

    def test_a_result_that_cannot_be_written_is_said_before_the_work(self):
        for line in ("replay x --lockstep --json", "replay x --report", "odometry folder --poses", "ppp x --pos",
                     "match x y --html", "evaluate x y --csv", "log split x -o", "map build x", "map doubts x y -o"):
            self.expect(line + " no/such/folder/out", 1, "no/such/folder/out", "there is no folder 'no/such/folder'")
            self.expect(line + " folder", 1, "it is a folder")

    def test_a_configuration_that_cannot_work_names_file_and_key(self):
        for text, said in (("[fusion]\ngyro_noise = -1.0\n", "gyro_noise"), ("[fusion]\ngyro_noise = nan\n", ":2:14: fusion.gyro_noise"),
                           ("[stereo]\nwindow = 14\n", "window"), ("[lidar]\nmap_voxel = 0.0\n", "map_voxel"),
                           ("speed = 3\n", ":1:1: speed: unknown key"), ("[stereo]\nmatching = \"orb\"\n", "\"klt\", \"sift\"")):
            with open(os.path.join(self.folder.name, "my.toml"), "w", encoding="utf-8") as file:
                file.write(text)
            self.expect("replay x --config my.toml", 1, "my.toml", said)


if __name__ == "__main__":
    unittest.main()
