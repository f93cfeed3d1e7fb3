"""Fleets: the table, a stop and another go, and the same bits from workers."""

# distributed and pyarrow have no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false, reportUnknownLambdaType=false

import csv
from pathlib import Path

import pytest
from conftest import need

import wheelrail as wr

SCENE = """
rail = { rotate = "1:40" }
wheel = { radius = 460.0 }
track = { gauge = 1435.0 }
wheelset = { back_to_back = 1360.0, flange_back_x = -70.0 }
"""
TABLE = "wheelset,left,right,radius_left_mm\nnew,S1002,S1002,\ncone,cone-1:20,cone-1:20,\nbad,nowhere.whl,S1002,\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "wheels.csv").write_text(TABLE)
    return tmp_path


def test_a_fleet_is_a_table_with_a_row_for_every_pair(folder: Path) -> None:
    seen: list[tuple[int, int]] = []
    summary = wr.fleet(
        folder / "scene.toml", folder / "wheels.csv", "60E1", out=folder / "out", progress=lambda *at: seen.append(at)
    )
    assert (summary["pairs"], summary["pairs_with_conicity"], summary["pairs_with_finding"]) == (3, 2, 2)
    assert seen[-1] == (3, 3)
    with open(folder / "out" / "fleet.csv", newline="") as file:
        new, cone, bad = csv.DictReader(file)
    assert [row["wheelset"] for row in (new, cone, bad)] == ["new", "cone", "bad"]
    # A cone of 1:20 on crowns of 300 mm that rolls about them: γ (l + R γ)/(l − R_R γ).
    assert float(cone["conicity"]) == pytest.approx(0.05 * (750 + 23) / (750 - 15), rel=5e-3)
    assert "nowhere.whl" in bad["finding"]
    wheelset = wr.Wheelset(
        wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), 460.0),
        gauge=1435.0,
        back_to_back=1360.0,
        flange_back_x=-70.0,
    )
    assert float(new["conicity"]) == pytest.approx(wheelset.conicity(3.0), rel=2e-4)


def test_the_bar_of_a_fleet_counts_pairs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    need("tqdm")
    wr.fleet(folder / "scene.toml", folder / "wheels.csv", "60E1", out=folder / "out", progress=True)
    assert "3.00/3.00" in (bar := capsys.readouterr().err) and " pairs" in bar


def test_workers_compute_the_same_fleet(folder: Path) -> None:
    need("distributed", "pyarrow")
    from distributed import Client, LocalCluster

    from wheelrail.dask import fleet

    arguments = (folder / "scene.toml", folder / "wheels.csv", "60E1")
    wr.fleet(*arguments, out=folder / "one")
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0")
    with cluster, Client(cluster) as client:
        summary = fleet(*arguments, out=folder / "many", client=client)
    assert summary["pairs"] == 3
    for name in ("fleet.csv", "summary.json", "fleet.html"):
        assert (folder / "one" / name).read_bytes() == (folder / "many" / name).read_bytes()
