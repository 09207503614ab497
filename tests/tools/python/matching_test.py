"""Maps, tracks and the matcher give what the command gives."""
import csv
import math

import maploop
import numpy as np
import pytest


@pytest.fixture(scope="module")
def roads(data):
    return maploop.RoadNetwork(data / "maps/karlsruhe_2012-04.osm.pbf")


def test_matches_are_those_of_the_command(data, roads, command, tmp_path):
    track = data / "kitti_odometry/oxts/06.csv.gz"
    command("match", data / "maps/karlsruhe_2012-04.osm.pbf", track, "--csv", tmp_path / "match.csv")
    fixes = maploop.read_track(track)
    matches = maploop.Matcher(roads).match(fixes)
    rows = list(csv.DictReader(open(tmp_path / "match.csv", encoding="utf-8")))
    assert len(rows) == len(fixes) == len(matches) > 500
    assert np.mean(matches["on_road"]) > 0.9
    for row, match in zip(rows, matches):
        assert row["phase"] == maploop.MATCH_PHASE[match["phase"]]
        assert (row["way_id"] != "") == match["on_road"]
        if match["on_road"]:
            assert [int(row[k]) for k in ("way_id", "node_a", "node_b")] == list(match[["way_id", "node_a", "node_b"]])
            assert row["matched_lat"] == f"{math.degrees(match['latitude']):.9f}"
            assert row["p_link"] == f"{match['probability']:.4f}"


def test_a_matcher_goes_on_where_it_stopped(data, roads):
    fixes = maploop.read_track(data / "kitti_odometry/oxts/04.csv.gz")
    whole = maploop.Matcher(roads).match(fixes)
    matcher = maploop.Matcher(roads)
    parts = np.concatenate([matcher.match(fixes[:20]), matcher.match(fixes[20:])])
    for name in whole.dtype.names:
        np.testing.assert_array_equal(parts[name], whole[name])


def test_a_track_of_ones_own(roads):
    fixes = maploop.unknown_fixes(30)
    assert np.isnan(fixes["speed"]).all() and fixes.dtype == maploop.fix_dtype
    fixes["stamp"] = 10**9 * np.arange(1, 31)
    fixes["latitude"], fixes["longitude"] = math.radians(10.0), math.radians(10.0)
    matches = maploop.Matcher(roads).match(fixes)
    assert not matches["on_road"].any()
    fixes["stamp"] = 5
    assert (maploop.Matcher(roads).match(fixes)["refusal"][1:] == 1).all()


def test_links_have_their_shapes(roads):
    assert len(roads) > 1000
    assert roads.shape(0).shape[0] >= 2 and roads.shape(0).shape[1] == 2
    with pytest.raises(IndexError, match="there is no link"):
        roads.shape(len(roads))


def test_wrong_input_is_an_error(data, roads, tmp_path):
    with pytest.raises(RuntimeError, match="no.osm.pbf"):
        maploop.RoadNetwork(tmp_path / "no.osm.pbf")
    with pytest.raises(TypeError, match="fixes has elements of type float64"):
        maploop.Matcher(roads).match(np.zeros(3))
    with pytest.raises(TypeError):
        maploop.Matcher(None)
    with pytest.raises(RuntimeError, match="no.gpx"):
        maploop.read_track(tmp_path / "no.gpx")
