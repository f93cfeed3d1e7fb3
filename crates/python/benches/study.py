"""What a study on Dask costs: python benches/study.py, with the release build installed.

Prints the scheduler's share of a task, and positions a second with one and two workers of one thread, files written.
"""

# distributed has no whole types.
# pyright: reportUnknownMemberType=false, reportArgumentType=false

import os
import tempfile
import time
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster

import wheelrail as wr
import wheelrail.dask

TASKS = 2000
POSITIONS = 2_000_000


def overhead(client: Client) -> float:
    """Return the milliseconds of a task that does nothing."""
    client.gather(client.map(abs, range(100), pure=False))
    start = time.perf_counter()
    client.gather(client.map(abs, range(TASKS), pure=False))
    return 1e3 * (time.perf_counter() - start) / TASKS


def study(client: Client, track: wr.Wheelset) -> tuple[float, float]:
    """Return positions a second, and bytes of Parquet a row."""
    with tempfile.TemporaryDirectory() as folder:
        wheelrail.dask.sweep([track], np.linspace(-8, 8, 10_000), Path(folder) / "warm", client=client, batch=1000)
        start = time.perf_counter()
        files = wheelrail.dask.sweep([track], np.linspace(-8, 8, POSITIONS), Path(folder) / "study", client=client)
        seconds = time.perf_counter() - start
        return POSITIONS / seconds, sum(file.stat().st_size for file in files) / (2 * POSITIONS)


def main() -> None:
    os.environ["RAYON_NUM_THREADS"] = "1"
    pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
    track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
    start = time.perf_counter()
    track.sweep(np.linspace(-8, 8, 200_000), conicity=False)
    print(f"this process, one thread, no files: {200_000 / (time.perf_counter() - start):.0f} positions/s")
    for workers in (1, 2):
        cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
        with cluster, Client(cluster) as client:
            rate, size = study(client, track)
            print(f"{workers} workers: {rate:.0f} positions/s, {size:.0f} bytes a row, {overhead(client):.2f} ms a task")


if __name__ == "__main__":
    main()
