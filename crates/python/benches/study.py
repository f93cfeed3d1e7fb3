"""What a study on Dask costs: python benches/study.py [WHEELSETS], with the release build installed.

Prints the scheduler's share of a task, and positions a second with one and two workers of one thread, files written. Given a
number of wheelsets, sweeps so many, each with worn and noisy measured wheels of its own, over 1000 positions each, in this
process and on two workers, and prints how much memory they took at most.
"""

# distributed has no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false
# pyright: reportArgumentType=false, reportAttributeAccessIssue=false

import os
import sys
import tempfile
import time
import warnings
from pathlib import Path
from pickle import dumps

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


def measured(number: int) -> wr.Wheelset:
    """Return a wheelset with its own wear and noise of 5 um on each side."""
    random = np.random.default_rng(number)
    points = wr.wheel("S1002").points(0.2)
    # Where segments meet, points are nearer to each other than any instrument's.
    x, z = points[np.hypot(*np.diff(points, axis=0, prepend=np.nan).T) > 0.1].T
    rail = wr.rail("60E1").rotated("1:40")

    def side() -> wr.Pair:
        worn = z + random.uniform(0.0, 1.5) * np.exp(-(((x - random.uniform(-10.0, 10.0)) / 20.0) ** 2))
        noisy = worn + random.normal(0.0, 0.005, len(z))
        return wr.Pair(rail, wr.Profile.from_points(x, noisy, side="wheel", cutoff_wavelength=10.0), radius=460.0)

    return wr.Wheelset(side(), left=side(), gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)


def peak() -> float:
    """Return the most memory that this process ever had, MB: as Linux counts it, without what it was started from."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024


def fleet(count: int) -> None:
    """Measure a study of many measured wheelsets."""
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wr.Doubt)
        wheelsets = [measured(number) for number in range(count)]
    print(f"{count} wheelsets made in {time.perf_counter() - start:.1f} s, {len(dumps(wheelsets[0])) / 1e3:.0f} kB each")
    lateral = np.linspace(-6.0, 6.0, 1000)
    start = time.perf_counter()
    rows = sum(wheelset.sweep(lateral, conicity=False).rows for wheelset in wheelsets)
    seconds = time.perf_counter() - start
    print(f"this process, one thread, no files: {seconds:.1f} s, {rows} rows, {len(lateral) * count / seconds:.0f} positions/s")
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as client, tempfile.TemporaryDirectory() as folder:
        before, own = client.run(peak), peak()
        start = time.perf_counter()
        files = wheelrail.dask.sweep(wheelsets, lateral, folder, client=client)
        seconds = time.perf_counter() - start
        size = sum(file.stat().st_size for file in files)
        print(f"2 workers: {seconds:.1f} s, {len(files)} files, {size / rows:.0f} bytes a row, {len(lateral) * count / seconds:.0f} positions/s")
        print(f"peak of a worker: {max(client.run(peak).values()):.0f} MB, {max(before.values()):.0f} MB before; of this process: {peak():.0f} MB, {own:.0f} MB before")


def main() -> None:
    os.environ["RAYON_NUM_THREADS"] = "1"
    if len(sys.argv) > 1:
        fleet(int(sys.argv[1]))
        return
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
