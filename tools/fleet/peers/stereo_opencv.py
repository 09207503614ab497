#!/usr/bin/python3
"""Visual odometry of OpenCV: semi-global matching makes depth, and RgbdOdometry aligns one frame with the next.

    stereo_opencv.py RECORDING POSES [CONFIG]
"""
import sys

import cv2
import numpy

import poses

FARTHEST = 50.0  # m; RgbdOdometry is made for rooms, its 4 m show nothing of a street


def main():
    recording = poses.opened(sys.argv[1], *sys.argv[3:])
    c = recording.stereo
    camera = numpy.array([[c.fx, 0, c.cx], [0, c.fy, c.cy], [0, 0, 1]])
    matcher = cv2.StereoSGBM_create(minDisparity=0, numDisparities=128, blockSize=5, P1=200, P2=800,
                                    uniquenessRatio=10, speckleWindowSize=100, speckleRange=2)
    odometry = cv2.rgbd.RgbdOdometry_create(camera, minDepth=0.5, maxDepth=FARTHEST, maxDepthDiff=0.5)
    odometry.setMaxTranslation(5.0)
    odometry.setMaxRotation(30.0)
    pose, step, before, stamps, path = numpy.eye(4), numpy.eye(4), None, [], []
    for pair in recording.images():
        left = numpy.ascontiguousarray(pair.left)
        disparity = matcher.compute(left, numpy.ascontiguousarray(pair.right)).astype(numpy.float32) / 16.0
        depth = numpy.where(disparity > 0.5, c.fx * c.baseline / numpy.maximum(disparity, 0.5), numpy.nan).astype(numpy.float32)
        frame = cv2.rgbd.OdometryFrame_create(left, depth)
        if before is not None:
            found, motion = odometry.compute2(before, frame, initRt=numpy.linalg.inv(step))
            step = numpy.linalg.inv(motion) if found else step
            pose = pose @ step
        before = frame
        stamps.append(pair.stamp)
        path.append(pose)
    poses.write(sys.argv[2], stamps, path)


if __name__ == "__main__":
    main()
