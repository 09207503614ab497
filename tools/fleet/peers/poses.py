"""What the programs that read a recording by maploop's module have in common."""
import sys

import maploop
import numpy


def opened(path, *config):
    return maploop.Recording(path, maploop.Config(*config))


def quaternion(rotation):
    """x, y, z, w of a rotation matrix, by the eigenvector of Bar-Itzhack (2000)."""
    r = rotation
    k = numpy.array([[r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
                     [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
                     [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
                     [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]]]) / 3.0
    return numpy.linalg.eigh(k)[1][:, 3]


def write(path, stamps, poses):
    """The poses of the left camera in its first frame, in TUM's format."""
    if not poses:
        sys.exit("the recording has no frame")
    with open(path, "w", encoding="ascii") as file:
        for stamp, pose in zip(stamps, poses):
            values = [*pose[:3, 3], *quaternion(pose[:3, :3])]
            file.write(f"{stamp / 1e9:.9f} " + " ".join(f"{v:.9f}" for v in values) + "\n")
