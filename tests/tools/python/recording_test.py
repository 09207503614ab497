"""Recordings of several containers, sample by sample."""
import gc
from itertools import islice

import maploop
import numpy as np
import pytest


def test_samples_of_a_drive_come_in_the_order_of_their_delivery(drive):
    recording = maploop.Recording(drive)
    samples = list(islice(recording, 100))
    available = [s.available for s in samples]
    assert available == sorted(available)
    kinds = {type(s) for s in samples}
    assert {maploop.StereoPair, maploop.LidarScan, maploop.ImuSample, maploop.GnssFix} <= kinds
    pair = next(s for s in samples if isinstance(s, maploop.StereoPair))
    assert pair.left.shape == (375, 1242) == (recording.stereo.height, recording.stereo.width)
    assert pair.left.dtype == np.uint8 and 20 < pair.left.mean() < 200
    assert recording.first_stamp <= pair.stamp <= recording.last_stamp
    assert recording.T_body_velo.shape == (4, 4) and recording.stereo.baseline == pytest.approx(0.537, abs=0.01)


@pytest.mark.parametrize("name", ["kitti13_ros1_bz2.bag", "kitti13_ros2_zstd_message", "kitti13_zstd.mcap"])
def test_a_bag_has_the_samples_that_it_was_made_of(data, drive, name):
    samples = list(maploop.Recording(data / "bags/kitti_0013" / name))
    pairs, scans, imu = ([s for s in samples if isinstance(s, kind)]
                         for kind in (maploop.StereoPair, maploop.LidarScan, maploop.ImuSample))
    assert len(pairs) == 3 and len(scans) >= 2
    originals = {p.left.tobytes() for p in islice(maploop.Recording(drive).images(), 40)}
    assert sum(p.left.tobytes() in originals for p in pairs) >= 1
    assert all(s.points.shape[1] == 4 and len(s.points) > 50_000 for s in scans[:2])
    assert imu and all(abs(np.linalg.norm(s.specific_force) - 9.8) < 3.0 for s in imu)


def test_a_view_keeps_its_sample(drive):
    points = next(maploop.Recording(drive).scans()).points
    before = points.copy()
    gc.collect()
    assert np.array_equal(points, before)


def test_what_cannot_be_opened_is_an_error_with_the_commands_sentence(drive, tmp_path):
    with pytest.raises(RuntimeError, match="nowhere"):
        maploop.Recording(tmp_path / "nowhere")
    (tmp_path / "empty.bag").write_bytes(b"")
    with pytest.raises(RuntimeError, match="empty.bag"):
        maploop.Recording(tmp_path / "empty.bag")
    with pytest.raises(RuntimeError, match="nokey"):
        maploop.Config(settings=["fusion.nokey=1"])


def test_a_file_and_settings_set_what_they_name(tmp_path):
    (tmp_path / "car.toml").write_text("[stereo]\nwindow_frames = 4\n")
    text = maploop.Config(tmp_path / "car.toml", settings=["lidar.max_range=50.0"]).toml()
    assert "window_frames = 4" in text and "max_range = 50.0" in text
    assert maploop.Config().toml() != text
