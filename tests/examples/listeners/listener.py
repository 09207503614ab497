#!/usr/bin/env python3
"""Prints each NAV_STATE, in Python, which needs no library of LCM. TYPES is the folder of the installed
message types, share/maploop/lcm:   PYTHONPATH=TYPES/python python3 listener.py
"""
import socket
import struct

from maploop_lcm import nav_state_t

GROUP, PORT = "239.255.76.67", 7667  # LCM's default network
SHORT = 0x4C433032  # a message that fits into one datagram, as all but pictures and scans do

listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
listener.bind((GROUP, PORT))
listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                    struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton("0.0.0.0")))
while True:
    datagram = listener.recv(65536)
    if len(datagram) < 8 or struct.unpack(">I", datagram[:4])[0] != SHORT:
        continue
    channel, _, message = datagram[8:].partition(b"\0")
    if channel == b"NAV_STATE":
        s = nav_state_t.decode(message)
        print(f"{s.header.stamp_ns * 1e-9:.3f} s: east {s.position_enu[0]:.2f} m, "
              f"north {s.position_enu[1]:.2f} m, azimuth {s.azimuth:.4f} rad", flush=True)
