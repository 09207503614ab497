"""A UDP link between a sensor and its driver that can be broken."""
import heapq
import random
import selectors
import socket
import threading
import time

KINDS = ("lost", "late", "repeated", "corrupt", "reordered", "cut", "flood")


class FaultyLink:
    """Passes datagrams from one port of this host on to another; each is subject to the fault that is set."""

    def __init__(self, listen, to, seed):
        self.fault = None  # one of KINDS; None: all is passed on as it comes
        self.passed = self.broken = 0
        self._random = random.Random(seed)
        self._to = ("127.0.0.1", to)
        self._in = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._in.bind(("127.0.0.1", listen))
        self._in.setblocking(False)
        self._out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._waiting = []  # (when, number, datagram)
        self._held = None  # waits for the next one, which overtakes it
        self._number = 0
        self._ended = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self._ended = True
        self._thread.join()
        self._in.close()
        self._out.close()

    def _run(self):
        with selectors.DefaultSelector() as selector:
            selector.register(self._in, selectors.EVENT_READ)
            while not self._ended:
                arrived = selector.select(0.005)
                while arrived:
                    try:
                        self._take(self._in.recv(65536))
                    except BlockingIOError:
                        break
                if self.fault == "flood":
                    for _ in range(10):
                        self._send(self._random.randbytes(self._random.randrange(1, 200)))
                while self._waiting and self._waiting[0][0] <= time.monotonic():
                    self._send(heapq.heappop(self._waiting)[2])

    def _send(self, datagram):
        self._out.sendto(datagram, self._to)

    def _take(self, datagram):
        fault = self.fault
        overtaken, self._held = self._held, None
        self.passed += fault is None
        self.broken += fault is not None
        if fault == "late":
            self._number += 1
            heapq.heappush(self._waiting, (time.monotonic() + self._random.uniform(0.05, 0.5), self._number, datagram))
        elif fault == "reordered" and overtaken is None:
            self._held = datagram
        elif fault == "corrupt":
            damaged = bytearray(datagram)
            for _ in range(self._random.randrange(1, 9)):
                damaged[self._random.randrange(len(damaged))] ^= self._random.randrange(1, 256)
            self._send(damaged)
        elif fault == "cut":
            self._send(datagram[:self._random.randrange(len(datagram))])
        elif fault != "lost":
            for _ in range(3 if fault == "repeated" else 1):
                self._send(datagram)
        if overtaken is not None:
            self._send(overtaken)
