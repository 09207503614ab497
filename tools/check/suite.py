"""The tests of one or several build folders, run by ctest as one suite."""
import json
import os
import re
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

from steps import say

RESULT = re.compile(r"^ *(\d+)/(\d+) Test +#\d+: (.+?) \.{3,}(.*?) +([\d.]+) sec")
SUMMARY = "% tests passed"


def loopback_is_up():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("127.0.0.1", 9))
            return True
        except OSError:
            return False


class Suite:
    """`folder` gets a CTestTestfile that joins those of `builds`."""

    def __init__(self, folder, builds, log):
        self.folder, self.log = folder, log
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "CTestTestfile.cmake"), "w", encoding="utf-8") as file:
            for build in builds:
                file.write(f'subdirs("{build}")\n')

    def tests(self):
        """What ctest knows of each test: name, command, properties; its number is its place, from 1."""
        shown = subprocess.run(["ctest", "--test-dir", self.folder, "--show-only=json-v1"], check=True,
                               capture_output=True, text=True).stdout
        return json.loads(shown)["tests"]

    def order_by(self, seconds):
        """Tells ctest how long tests took: it starts with the longest."""
        folder = os.path.join(self.folder, "Testing", "Temporary")
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "CTestCostData.txt"), "w", encoding="utf-8") as file:
            for name, cost in seconds.items():
                file.write(f"{name} 1 {cost}\n")
            file.write("---\n")

    def run(self, jobs, seconds, only=None, passed=None):
        """Runs all tests, or the set of names `only`; returns (ctest's status, results by test).

        `passed` is called with the name of each test that passes, as soon as it does. Shown meanwhile: tests
        that did not pass, and now and then how far it is. ctest's summary is kept for `summary`.
        """
        self.order_by(seconds)
        command = ["ctest", "--test-dir", self.folder, "-j", str(jobs), "--output-on-failure", "--no-tests=error",
                   "--output-junit", os.path.join(self.log, "tests.xml")]
        if only is not None:
            numbers = [str(i) for i, test in enumerate(self.tests(), 1) if test["name"] in only]
            with open(os.path.join(self.folder, "chosen.txt"), "w", encoding="utf-8") as file:
                file.write(",".join(["0", "0", "0", *numbers]) + "\n")
            command += ["-I", os.path.join(self.folder, "chosen.txt")]
        if not loopback_is_up():  # such as in a namespace without a network
            command.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "tests", "support", "own-network"))
        self.lines_of_summary = []
        told = time.monotonic()
        left = None
        with open(os.path.join(self.log, "tests.txt"), "w", encoding="utf-8") as file, \
                subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                 text=True, errors="replace") as process:
            for line in process.stdout:
                file.write(line)
                file.flush()
                if self.lines_of_summary or SUMMARY in line:
                    self.lines_of_summary.append(line)
                    continue
                result = RESULT.match(line)
                if not result:
                    if not re.match(r" *Start +\d+:|Internal ctest changing|Test project", line):
                        sys.stderr.write(line)
                    continue
                number, count, name, verdict, took = result.groups()
                if verdict.strip() != "Passed":
                    sys.stderr.write(line)
                elif passed:
                    passed(name)
                left = (left if left is not None else sum(seconds.values())) - seconds.get(name, float(took))
                if time.monotonic() - told > 60:
                    told = time.monotonic()
                    say(f"{number} of {count} tests, about {max(0, round(left / jobs / 60))} min left")
        return process.returncode, self.results()

    def results(self):
        """Name, seconds and verdict (passed, failed or skipped) of each test of the last run."""
        names = {"run": "passed", "fail": "failed"}
        try:
            cases = xml.parse(os.path.join(self.log, "tests.xml")).iter("testcase")
        except (OSError, xml.ParseError):
            return []
        return [{"test": case.get("name"), "seconds": float(case.get("time")),
                 "verdict": names.get(case.get("status"), "skipped")} for case in cases]

    def summary(self):
        return "".join(self.lines_of_summary)
