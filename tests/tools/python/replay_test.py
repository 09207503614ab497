"""A replay from Python has the bits of the command."""
import csv
import json
import math

import maploop
import numpy as np
import pytest


@pytest.fixture(scope="module")
def mine(drive):
    called = []
    result = maploop.replay(maploop.Recording(drive), end=3.1, on_state=lambda s: called.append(s.copy()))
    return result, called


def test_every_channel_has_the_hash_of_the_command(mine, three_seconds):
    figures, theirs = mine[0].figures, three_seconds[1]
    assert figures["channels"] == theirs["channels"] and "NAV_STATE" in figures["channels"]
    for key in ["verdict", "configuration", "fused", "navigation", "drive", "refusals"]:
        assert figures[key] == theirs[key], key
    assert mine[0].verdict.splitlines() == theirs["verdict"]


def test_states_are_those_of_the_csv_file(mine, three_seconds):
    states = {int(s["stamp"]): s for s in mine[0].states}
    rows = list(csv.DictReader(open(three_seconds[0] / "states.csv", encoding="utf-8")))
    assert len(rows) >= 25
    for row in rows:
        seconds, fraction = row["stamp"].split(".")
        state = states[int(seconds) * 10**9 + int(fraction)]
        assert maploop.NAV_STATUS[state["status"]] == row["status"]
        assert f"{math.degrees(state['latitude']):.9f}" == row["latitude"]
        assert [f"{x:.3f}" for x in state["position_enu"]] == [row["east"], row["north"], row["up"]]
        assert f"{state['forward_speed']:.3f}" == row["forward_speed"]
        assert f"{math.sqrt(state['covariance'][0, 0]):.3f}" == row["sigma_east"]


def test_the_callback_gets_the_states_as_they_come(mine):
    result, called = mine
    assert len(called) == len(result.states) > 250
    for name in maploop.state_dtype.names:
        np.testing.assert_array_equal([s[name] for s in called], result.states[name])
    assert np.all(np.diff(result.states["stamp"]) > 0)


def test_an_error_of_the_callback_ends_the_replay(drive):
    called = []

    def fail(state):
        called.append(state)
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        maploop.replay(maploop.Recording(drive), on_state=fail)
    assert len(called) == 1


def test_a_map_is_used_as_by_the_command(data, command, tmp_path):
    table = data / "kitti_odometry/oxts/06.csv.gz"
    roads = data / "maps/karlsruhe_2012-04.osm.pbf"
    command("replay", table, "--lockstep", "--no-lcm", "--end", 10, "--map", roads, "--map-mode", "tight", "--json",
            tmp_path / "figures.json")
    figures = maploop.replay(maploop.Recording(table), map=roads, map_mode="tight", end=10.0, keep_states=False).figures
    assert figures["channels"] == json.loads((tmp_path / "figures.json").read_text())["channels"]
    assert figures["channels"]["MAP_MATCH"]["count"] > 50


def test_what_cannot_be_replayed_is_an_error(data, tmp_path):
    recording = maploop.Recording(data / "kitti_odometry/oxts/04.csv.gz")
    with pytest.raises(ValueError, match="not sideways"):
        maploop.replay(recording, map_mode="sideways")
    with pytest.raises(RuntimeError, match="needs a map"):
        maploop.replay(recording, map_mode="tight")
    with pytest.raises(RuntimeError, match="no.osm"):
        maploop.replay(recording, map=tmp_path / "no.osm.pbf")
    with pytest.raises(TypeError):
        maploop.replay(str(recording))
