"""Studies: the same rows whatever the partitioning, and with a worker killed in the middle."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from conftest import need

import wheelrail as wr

if TYPE_CHECKING:
    from distributed import Client

LATERAL = np.linspace(-7, 7, 2001)


@pytest.fixture(scope="module")
def client() -> Iterator["Client"]:
    need("distributed", "pyarrow")
    from distributed import Client, LocalCluster

    cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, Client(cluster) as client:
        yield client


def rows(folder: Path) -> bytes:
    """Return the bits of all rows in order."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    parts = [
        pq.read_table(file, partitioning=None)
        for pair in sorted(folder.glob("pair=*"))
        for file in sorted(pair.glob("*.parquet"))
    ]
    table = pa.concat_tables(parts).unify_dictionaries().combine_chunks()
    frame = table.to_pandas()
    return b"".join((frame[name].cat.codes if name == "side" else frame[name]).to_numpy().tobytes() for name in frame)


def test_rows_are_the_same_whatever_the_partitioning(client: "Client", track: wr.Wheelset, tmp_path: Path) -> None:
    from wheelrail.dask import Positions, sweep

    wheelsets = {"new": track, "cone": wr.Wheelset(
        wr.Pair(track.pair.rail, wr.wheel("cone-1:20"), 460.0), gauge=1435.0, wheel_spacing=1500.0
    )}
    positions = Positions.grid(LATERAL, yaw=[0.0, 0.003])
    told: list[tuple[int, int]] = []
    sweep(wheelsets, positions, tmp_path / "a", client=client, batch=777, progress=lambda *at: told.append(at))
    sweep(wheelsets, positions, tmp_path / "b", client=client, batch=10**6)
    expected = rows(tmp_path / "b")
    assert rows(tmp_path / "a") == expected
    assert told[-1] == (12, 12)
    table = track.sweep(positions.lateral, positions.yaw, conicity=False)
    import pyarrow.parquet as pq

    whole = pq.read_table(tmp_path / "b/pair=new/part-0000000000-0000004002.parquet", partitioning=None)
    assert np.array_equal(whole["rail_x_mm"].to_numpy(), table["rail_x_mm"])
    # What is there is kept, what is missing is made again.
    files = sorted((tmp_path / "a").glob("*/*.parquet"))
    files[3].unlink()
    times = {file: file.stat().st_mtime_ns for file in files if file.exists()}
    sweep(wheelsets, positions, tmp_path / "a", client=client, batch=777)
    assert all(file.stat().st_mtime_ns == time for file, time in times.items())
    assert rows(tmp_path / "a") == expected
    with pytest.raises(ValueError, match="another question"):
        sweep(wheelsets, LATERAL, tmp_path / "a", client=client)


def test_a_killed_worker_loses_nothing_and_doubles_nothing(client: "Client", track: wr.Wheelset, tmp_path: Path) -> None:
    from wheelrail.dask import sweep

    lateral = np.linspace(-7, 7, 200_001)
    killed: list[int] = []

    def kill_one(done: int, all: int) -> None:
        if done >= 3 and not killed:
            workers = client.run(os.getpid)
            killed.append(next(iter(workers.values())))
            os.kill(killed[0], signal.SIGKILL)

    sweep([track], lateral, tmp_path / "killed", client=client, batch=10_000, progress=kill_one)
    assert killed
    sweep([track], lateral, tmp_path / "calm", client=client, batch=50_000)
    assert rows(tmp_path / "killed") == rows(tmp_path / "calm")
    assert not list((tmp_path / "calm").glob("*/*.tmp"))
