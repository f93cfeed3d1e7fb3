"""Studies: the same rows whatever the partitioning, with workers killed at random, and with another scheduler."""

# distributed and pyarrow have no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false, reportUnknownLambdaType=false, reportArgumentType=false

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from random import Random
from threading import Event, Thread
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


# Kills of a run of the tests; any number by WHEELRAIL_KILLS.
KILLS = int(os.environ.get("WHEELRAIL_KILLS", "5"))


@pytest.fixture(scope="module")
def many(track: wr.Wheelset) -> dict[str, wr.Wheelset]:
    """Wheelsets of several shapes."""
    wheels = ["S1002", "cone-1:20", "EN15302-A", "EN15302-B"]
    pairs = {name: wr.Pair(track.pair.rail, wr.wheel(name), 460.0) for name in wheels}
    return {name.replace(":", "-"): wr.Wheelset(pair, gauge=1435.0, wheel_spacing=1500.0) for name, pair in pairs.items()}


def times(folder: Path) -> dict[Path, int]:
    return {file: file.stat().st_mtime_ns for file in folder.glob("*/*.parquet")}


def test_workers_killed_at_random_lose_nothing_and_double_nothing(many: dict[str, wr.Wheelset], tmp_path: Path) -> None:
    need("distributed", "pyarrow")
    import dask.config
    import pandas as pd
    import pyarrow.parquet as pq
    from distributed import Client, LocalCluster

    from wheelrail.dask import sweep

    lateral = np.linspace(-7, 7, 60_001)
    random = Random(1979)
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    # A local cluster gives up for good a worker that happens to be dead 15 s after a death; a batch system starts others.
    lasting = dask.config.set({"distributed.deploy.lost-worker-timeout": "1 day"})
    with lasting, cluster, Client(cluster) as client:
        killed: list[int] = []
        over = Event()

        def kill() -> None:
            while len(killed) < KILLS and not over.wait(random.uniform(0.05, 1.0)):
                pids = [process.pid for worker in cluster.workers.values() if (process := worker.process) and process.pid]
                if pids:
                    killed.append(random.choice(pids))
                    with suppress(ProcessLookupError):
                        os.kill(killed[-1], signal.SIGKILL)

        killer = Thread(target=kill)
        killer.start()
        folder, seen = tmp_path / "killed", dict[Path, int]()
        number = 0
        try:
            # A study is over in seconds: further ones follow until all kills were made.
            while number == 0 or len(killed) < KILLS:
                folder = tmp_path / f"killed-{number}"
                sweep(
                    many, lateral, folder, client=client, batch=5_000, retries=KILLS,
                    progress=lambda *_: [seen.setdefault(*item) for item in times(folder).items()],
                )
                assert all(seen.get(file, time) == time for file, time in times(folder).items())
                # What a killed worker leaves is hidden: readers take the folder for what it is.
                assert all(file.name.startswith(".") for file in folder.glob("*/*.tmp"))
                (folder / "pair=S1002" / ".part-0000000000-0000005000.parquet.1.tmp").write_bytes(b"half")
                assert pq.read_table(folder).num_rows == pd.read_parquet(folder).shape[0] > 0
                number += 1
        finally:
            over.set()
            killer.join()
        sweep(many, lateral, tmp_path / "calm", client=client, batch=20_000)
        expected = rows(tmp_path / "calm")
        assert all(rows(tmp_path / f"killed-{k}") == expected for k in range(number))


def test_a_study_goes_on_with_another_scheduler(many: dict[str, wr.Wheelset], tmp_path: Path) -> None:
    need("distributed", "pyarrow")
    from distributed import Client, LocalCluster

    from wheelrail.dask import sweep

    class Stopped(Exception):
        pass

    def stop(done: int, all: int) -> None:
        if done >= 5:
            raise Stopped

    def study(progress: Callable[[int, int], None]) -> None:
        cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
        with cluster, Client(cluster) as client:
            sweep(many, LATERAL, tmp_path / "study", client=client, batch=500, progress=progress)

    with pytest.raises(Stopped):
        study(stop)
    before = times(tmp_path / "study")
    assert 5 <= len(before) < 20
    told: list[tuple[int, int]] = []
    study(lambda *at: told.append(at))
    after = times(tmp_path / "study")
    assert len(after) == 20 and told[0] == (len(before), 20)
    assert all(after[file] == time for file, time in before.items())
