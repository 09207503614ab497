"""The odometries give the bits of the command, and refuse what is no image and no cloud."""
import threading
import time
from itertools import islice

import maploop
import numpy as np
import pytest

SMALL = dict(width=200, height=100, fx=200.0, fy=200.0, cx=100.0, cy=50.0, baseline=0.5)


def equal(a, b):
    return (a.stamp, a.from_stamp, a.status, a.tracked, a.inliers) == (b.stamp, b.from_stamp, b.status, b.tracked,
                                                                     b.inliers) and np.array_equal(
        a.T, b.T) and np.array_equal(a.covariance, b.covariance)


def test_visual_motions_have_the_bits_of_the_replay(drive, motions):
    recording = maploop.Recording(drive)
    odometry = maploop.StereoOdometry(recording.stereo, recording.config)
    mine = [odometry.process(pair.left, pair.right, pair.stamp) for pair in islice(recording.images(), len(motions[0]))]
    assert len(mine) >= 29 and sum(m.ok for m in mine) >= 28
    assert all(map(equal, mine, motions[0]))


def test_a_pair_and_its_arrays_give_the_same(drive):
    recording = maploop.Recording(drive)
    by_pair, by_arrays = (maploop.StereoOdometry(recording.stereo) for _ in range(2))
    for pair in islice(recording.images(), 4):
        one, other = by_pair.process(pair), by_arrays.process(pair.left, pair.right, pair.stamp)
        assert equal(one, other) and one.sequence == other.sequence
    assert by_pair.tracks().shape[1] == 4 and len(by_pair.tracks()) > 100


def test_lidar_motions_have_the_bits_of_the_replay(drive, motions):
    visual, lidar = motions
    recording = maploop.Recording(drive)
    stereo = maploop.StereoOdometry(recording.stereo, recording.config)
    odometry = maploop.LidarOdometry(recording.T_body_velo, recording.config)
    scans, scan, mine = recording.scans(), None, []
    for pair in islice(recording.images(), 30):
        while scan is None or scan.end <= pair.stamp:
            scan = next(scans)
        motion = stereo.process(pair)
        if scan.start <= pair.stamp:
            mine.append(odometry.process(scan.points, scan.stamp, start=scan.start, end=scan.end, visual=motion).lidar)
    assert len(lidar) >= 28
    assert all(map(equal, mine, lidar))
    assert len(odometry.local_map()) > 1000 and np.linalg.norm(odometry.pose[:3, 3]) > 10.0


def test_three_columns_are_as_good_as_four_and_nothing_is_copied(drive):
    recording = maploop.Recording(drive)
    odometries = [maploop.LidarOdometry(recording.T_body_velo) for _ in range(3)]
    for scan in islice(recording.scans(), 4):
        turn = dict(start=scan.start, end=scan.end)
        motions = [odometries[0].process(scan).lidar,
                   odometries[1].process(np.ascontiguousarray(scan.points[:, :3]), scan.stamp, **turn).lidar,
                   odometries[2].process(scan.points[:, :3], scan.stamp, **turn).lidar]
        assert equal(motions[0], motions[1]) and equal(motions[0], motions[2])
    assert scan.points.base is not None and not scan.points.flags.owndata
    assert motions[0].ok


def test_times_of_points_move_them(drive):
    recording = maploop.Recording(drive)
    odometry = maploop.LidarOdometry(recording.T_body_velo)
    for scan in islice(recording.scans(), 4):
        azimuth = np.arctan2(scan.points[:, 1], scan.points[:, 0])
        times = np.float32((0.5 - azimuth / (2 * np.pi) - 0.5) * 1e-9 * (scan.end - scan.start))
        motion = odometry.process(scan.points, scan.stamp, times=times).lidar
    assert motion.ok
    with pytest.raises(ValueError, match="one element for each point"):
        odometry.process(scan.points, scan.stamp + 10, times=times[1:])


@pytest.mark.parametrize("left, error, says", [
    (np.zeros((100, 200)), TypeError, "float64; it must have uint8"),
    (np.zeros((100, 200, 3), np.uint8), ValueError, "3 dimensions"),
    (np.zeros((100, 201), np.uint8), ValueError, "201 x 100 px; the calibration is of 200 x 100"),
    (np.zeros((100, 400), np.uint8)[:, ::2], ValueError, "ascontiguousarray"),
    ([[0, 1]], TypeError, "incompatible function arguments"),
])
def test_what_is_no_image_is_refused(left, error, says):
    odometry = maploop.StereoOdometry(maploop.StereoCalibration(**SMALL))
    with pytest.raises(error, match=says):
        odometry.process(left, np.zeros((100, 200), np.uint8), 1)


@pytest.mark.parametrize("points, error, says", [
    (np.zeros((9, 4)), TypeError, "float64; it must have float32"),
    (np.zeros(9, np.float32), ValueError, "1 dimensions"),
    (np.zeros((9, 5), np.float32), ValueError, "5 columns"),
    (np.zeros((0, 4), np.float32), ValueError, "no point"),
    (np.zeros((4, 9), np.float32).T, ValueError, "ascontiguousarray"),
])
def test_what_is_no_cloud_is_refused(points, error, says):
    with pytest.raises(error, match=says):
        maploop.LidarOdometry().process(points, 1)


def test_what_cannot_be_a_calibration_is_refused():
    with pytest.raises(ValueError, match="fx must be positive"):
        maploop.StereoOdometry(maploop.StereoCalibration(**{**SMALL, "fx": 0.0}))
    with pytest.raises(ValueError, match="no rigid motion"):
        maploop.LidarOdometry(2.0 * np.eye(4))
    with pytest.raises(RuntimeError, match="allowed is"):
        maploop.Config(settings=["lidar.kernel=-1"])


def test_other_threads_go_on_and_share_an_odometry(drive):
    recording = maploop.Recording(drive)
    scans = list(islice(recording.scans(), 5))
    odometry = maploop.LidarOdometry(recording.T_body_velo)
    expected = maploop.LidarOdometry(recording.T_body_velo)
    turns, done = [], threading.Event()

    def count():
        while not done.is_set():
            turns.append(time.monotonic())
            time.sleep(0)

    counter = threading.Thread(target=count)
    counter.start()
    begin = time.monotonic()
    results = [odometry.process(scan).lidar for scan in scans]
    end = time.monotonic()
    done.set()
    counter.join()
    assert sum(begin < t < end for t in turns) > 10 * len(scans)
    assert all(map(equal, results, [expected.process(scan).lidar for scan in scans]))
    # Two threads in one object: each scan is taken whole, in some order.
    shared = maploop.LidarOdometry(recording.T_body_velo)
    threads = [threading.Thread(target=shared.process, args=(scan,)) for scan in scans]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(shared.local_map()) > 1000
