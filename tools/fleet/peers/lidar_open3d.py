#!/usr/bin/python3
"""LiDAR odometry of Open3D: generalized ICP of each scan with the scans before it, from a constant velocity.

    lidar_open3d.py RECORDING POSES [CONFIG]
"""
import sys

import numpy
import open3d

import poses

VOXEL, SCANS, FARTHEST = 0.5, 10, 80.0  # m, scans of the local map, m


def cloud_of(points):
    xyz = points[:, :3].astype(float)
    distance = numpy.linalg.norm(xyz, axis=1)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz[(distance > 2.5) & (distance < FARTHEST)]))
    return cloud.voxel_down_sample(VOXEL)


def main():
    recording = poses.opened(sys.argv[1], *sys.argv[3:])
    T_cam_velo = numpy.linalg.inv(recording.stereo.T_body_cam) @ recording.T_body_velo
    registration = open3d.pipelines.registration
    pose, step, recent, stamps, path = numpy.eye(4), numpy.eye(4), [], [], []
    for scan in recording.scans():
        cloud = cloud_of(scan.points)
        if recent:
            local_map = open3d.geometry.PointCloud()
            for other in recent:
                local_map += other
            found = registration.registration_generalized_icp(
                cloud, local_map.voxel_down_sample(VOXEL), 1.0, pose @ step,
                registration.TransformationEstimationForGeneralizedICP())
            step = numpy.linalg.inv(pose) @ found.transformation
            pose = found.transformation
        recent = [*recent[-(SCANS - 1):], cloud.transform(pose)]
        stamps.append(scan.stamp)
        path.append(T_cam_velo @ pose @ numpy.linalg.inv(T_cam_velo))
    poses.write(sys.argv[2], stamps, path)


if __name__ == "__main__":
    main()
