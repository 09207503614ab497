"""Positions a receiver precisely: ppp.py PICTURE OBSERVATIONS PRODUCT..."""
import sys

import maploop
import matplotlib.pyplot as plt
import numpy as np

positions = maploop.PppFilter(sys.argv[2:]).run()
solved = positions[positions["status"] > 0]
minutes = (solved["stamp"] - solved["stamp"][0]) / 60e9
plt.semilogy(minutes, np.sqrt(np.trace(solved["covariance"], axis1=1, axis2=2)))
plt.gca().set(xlabel="time (min)", ylabel="standard deviation of the position (m)")
plt.savefig(sys.argv[1])
