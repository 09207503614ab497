"""The filter without threads."""
import maploop
import numpy as np
import pytest

SECOND = 10**9
START = 1_600_000_000 * SECOND


def fix(stamp, north_speed=10.0, **changed):
    values = dict(position_covariance=np.eye(3), velocity_enu=[0.0, north_speed, 0.0],
                  velocity_covariance=0.01 * np.eye(3), sequence=stamp)
    return maploop.GnssFix(stamp, 0.8, 0.1, 100.0, **{**values, **changed})


def test_a_vehicle_that_drives_straight_on_goes_north():
    f = maploop.FusionFilter(maploop.Config())
    assert f.state_at(START) is None and not f.initialized
    assert f.add(fix(START)) == "applied" and f.initialized
    for k in range(1, 101):
        stamp = START + k * SECOND // 100
        noise = 1e-6 * k  # a sensor that says the same for long is taken to be stuck
        sample = maploop.ImuSample(stamp, [noise, 0.0, 9.8], [0.0, 0.0, 0.0], six_axes=False, sequence=k)
        assert f.add(sample) == "applied"
    state = f.state_at(START + SECOND)
    assert state["position_enu"] == pytest.approx([0.0, 10.0, 0.0], abs=0.1)
    assert state["azimuth"] == pytest.approx(0.0, abs=1e-3)
    assert state["covariance"].shape == (9, 9) and np.array_equal(state["covariance"], state["covariance"].T)
    assert state.dtype == maploop.state_dtype


def test_a_refusal_has_its_reason():
    f = maploop.FusionFilter()
    assert f.add(fix(START, north_speed=0.0)) == "too slow or too uncertain for a course"
    assert f.add(fix(START + 1, position_covariance=-np.eye(3))) == "invalid covariance"
    assert f.add(maploop.WheelSpeed(START, 1.0, 0.1)) == "not used by the configuration"
    assert f.add(maploop.ImuSample(START, [float("nan"), 0.0, 0.0], [0.0, 0.0, 0.0])) == "a value is not finite"


def test_a_known_place_starts_it_too():
    f = maploop.FusionFilter(origin=[0.8, 0.1, 0.0])
    assert f.start(START, 0.8, 0.1, 0.0, azimuth=np.pi / 2, speed=5.0) == "applied"
    assert f.state_at(START)["velocity_enu"] == pytest.approx([5.0, 0.0, 0.0], abs=1e-6)


def test_the_filter_is_that_of_the_vehicle(drive):
    """Fed with what the vehicle fed to its own; there the samples come in another order."""
    recording = maploop.Recording(drive)
    odometry = maploop.StereoOdometry(recording.stereo, recording.config)
    f = maploop.FusionFilter(recording.config)
    outcomes = []
    for sample in recording:
        if isinstance(sample, maploop.StereoPair):
            outcomes.append(f.add(odometry.process(sample)))
        elif isinstance(sample, (maploop.ImuSample, maploop.GnssFix)):
            f.add(sample)
        if sample.available > recording.first_stamp + 3 * SECOND:
            break
    assert outcomes.count("applied") >= 25
    state = f.state_at(recording.first_stamp + 3 * SECOND)
    assert 10.0 < state["forward_speed"] < 15.0 and state["odometry_stamp"] > 0


def test_wrong_arguments_are_errors():
    with pytest.raises(TypeError):
        maploop.FusionFilter().add("fix")
    with pytest.raises(TypeError):
        maploop.ImuSample(START, [0.0, 9.8], [0.0, 0.0, 0.0])
