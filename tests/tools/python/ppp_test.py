"""Positions are those of `maploop ppp`."""
import maploop
import numpy as np
import pytest


@pytest.fixture(scope="module")
def files(data):
    folder = data / "gnss/kamakura_kinematic"
    return [folder / name for name in ("SEPT265G.21O.gz", "SEPT2650.21P.gz", "COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz",
                                       "COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz")]


@pytest.fixture(scope="module")
def positions(files):
    return maploop.PppFilter(files).run()


def test_positions_are_those_of_the_command(files, positions, command, tmp_path):
    command("ppp", *files, "--pos", tmp_path / "out.pos", "--ecef")
    lines = [line.split() for line in open(tmp_path / "out.pos", encoding="utf-8") if not line.startswith("%")]
    solved = positions[positions["status"] > 0]
    assert len(lines) == len(solved) > 300
    for line, position in zip(lines, solved):
        assert line[2:5] == [f"{x:.4f}" for x in position["position_ecef"]]
        assert int(line[6]) == position["satellites"]
        assert line[7] == f"{np.sqrt(position['covariance'][0, 0]):.4f}"


def test_iterating_gives_the_same_epoch_by_epoch(files, positions):
    ppp = maploop.PppFilter(files)
    assert len(ppp) == len(positions)
    first = [next(ppp) for _ in range(10)]
    whole = np.concatenate([np.array(first, maploop.position_dtype), ppp.run()])
    for name in whole.dtype.names:
        np.testing.assert_array_equal(whole[name], positions[name])
    with pytest.raises(StopIteration):
        next(ppp)


def test_missing_files_and_products_are_errors(files, tmp_path):
    with pytest.raises(RuntimeError, match="nothing.21o"):
        maploop.PppFilter([tmp_path / "nothing.21o"])
    with pytest.raises(RuntimeError, match="orbits"):
        maploop.PppFilter(files[:1])
