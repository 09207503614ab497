"""Matches a track to the roads of a map: match.py MAP TRACK PICTURE"""
import sys

import maploop
import matplotlib.pyplot as plt

roads = maploop.RoadNetwork(sys.argv[1])
matches = maploop.Matcher(roads).match(maploop.read_track(sys.argv[2]))
on = matches[matches["on_road"]]
for link in set(on["link"]):
    plt.plot(*roads.shape(link).T, color="lightgrey", linewidth=4)
plt.scatter(on["east"], on["north"], c=on["probability"], s=2)
plt.gca().set(aspect="equal", xlabel="east (m)", ylabel="north (m)")
plt.colorbar(label="probability of the link")
plt.savefig(sys.argv[3])
