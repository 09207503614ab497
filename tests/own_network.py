"""A network of a test's own: what it sends stays there, and it sees nobody else's messages. A test that
starts programs in it imports this module.
"""
import os
import subprocess
import sys

INSIDE = "MAPLOOP_TEST_NETWORK_NAMESPACE"


def skip(reason):
    print(f"SKIPPED, NOT TESTED: {reason}")
    sys.exit(77)


def enter():
    """Goes on in a network namespace of its own, whose loopback carries multicast."""
    if INSIDE in os.environ:
        return open_multicast()
    for options in (["--net"], ["--net", "--map-root-user"]):
        probe = subprocess.run(["unshare", *options, "true"], capture_output=True, text=True)
        if probe.returncode == 0:
            os.execvpe("unshare", ["unshare", *options, sys.executable, *sys.argv],
                       {**os.environ, INSIDE: "1"})
    skip(f"no network namespace of its own is permitted here: {probe.stderr.strip()}")


def open_multicast():
    for command in ("ip link set lo up multicast on", "ip route add 224.0.0.0/4 dev lo"):
        done = subprocess.run(command.split(), capture_output=True, text=True)
        if done.returncode != 0:
            skip(f"'{command}' is not permitted here: {done.stderr.strip()}")


class Children:
    """Processes of this test. They end with it, even when it is killed."""

    def __init__(self):
        self.running = []

    def start(self, *command, **options):
        child = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *command], **options)
        self.running.append(child)
        return child

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        for child in reversed(self.running):
            child.terminate()
        for child in self.running:
            try:
                child.wait(timeout=10)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
