"""What a soak does to a vehicle, each kind by its name."""
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import link

BUS = ("239.255.76.67", 7667)  # the group and port of LCM's default URL


class Hazards:
    """Begins and ends faults. One is begun at a time, and ended before the next one."""

    def __init__(self, vehicle, links, disk, disk_is_small, draw):
        self._vehicle, self._links, self._disk, self._draw = vehicle, links, Path(disk), draw
        kinds = [f"{kind} {name}" for name in links for kind in link.KINDS]
        self.kinds = kinds + ["paused", "killed", "busy cores", "busy bus"] + (["full disk"] if disk_is_small else [])
        self._end = lambda: None

    def begin(self, kind):
        """Returns how long the fault should last, s."""
        word, _, name = kind.partition(" ")
        if name in self._links:
            self._links[name].fault = word
            self._end = lambda: setattr(self._links[name], "fault", None)
            return self._draw.uniform(2.0, 8.0)
        return getattr(self, "_" + kind.replace(" ", "_"))()

    def end(self):
        """Ends what was begun, if anything was."""
        end, self._end = self._end, lambda: None
        end()

    def _paused(self):
        self._vehicle.signal(signal.SIGSTOP)
        self._end = lambda: self._vehicle.signal(signal.SIGCONT)
        return self._draw.uniform(0.2, 3.0)

    def _killed(self):
        self._vehicle.signal(signal.SIGKILL)
        self._vehicle.process.wait()
        self._end = self._vehicle.start
        return self._draw.uniform(0.1, 5.0)

    def _busy_cores(self):
        hogs = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2 * (os.cpu_count() or 1))]

        def end():
            for hog in hogs:
                hog.kill()
                hog.wait()

        self._end = end
        return self._draw.uniform(2.0, 8.0)

    def _busy_bus(self):
        """Others talk on the bus: what is no LCM message at all, and what begins as one."""
        words = "import random, socket, sys, time\n" \
                "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n" \
                "s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)\n" \
                "while True:\n" \
                "    for _ in range(20):\n" \
                "        head = random.choice((b'', b'LC02\\0\\0\\0\\1NAV_STATE\\0', b'LC03\\0\\0\\0\\1'))\n" \
                f"        s.sendto(head + random.randbytes(random.randrange(1, 1000)), {BUS!r})\n" \
                "    time.sleep(0.01)\n"
        talker = subprocess.Popen([sys.executable, "-c", words])

        def end():
            talker.kill()
            talker.wait()

        self._end = end
        return self._draw.uniform(2.0, 8.0)

    def _full_disk(self):
        filler = self._disk / "filler"
        free = shutil.disk_usage(self._disk).free
        with open(filler, "wb", buffering=0) as file:
            try:
                for _ in range(free // 4096 + 1):
                    file.write(bytes(4096))
            except OSError:
                pass  # it is full
        self._end = filler.unlink
        return self._draw.uniform(5.0, 10.0)
