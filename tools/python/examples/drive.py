"""Replays a recording and draws the way it was driven: drive.py RECORDING PICTURE"""
import sys

import maploop
import matplotlib.pyplot as plt

drive = maploop.replay(maploop.Recording(sys.argv[1]))
started = drive.states[drive.states["status"] != maploop.NAV_STATUS.index("uninitialized")]
east, north, _ = started["position_enu"].T
plt.plot(east, north, label=drive.verdict.splitlines()[0])
plt.gca().set(aspect="equal", xlabel="east (m)", ylabel="north (m)")
plt.legend(fontsize="small")
plt.savefig(sys.argv[2])
