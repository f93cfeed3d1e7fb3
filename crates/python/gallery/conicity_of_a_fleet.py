# %% [markdown]
# # Conicity of a fleet
# Many wheels, each with its own wear, on the workers of a Dask cluster: here two processes, elsewhere any cluster by its
# address. Each wheel is a task; the positions of a wheel are `wheelrail.dask.sweep`'s to share out where there are many.

# %%
from __future__ import annotations

import tempfile

import matplotlib.pyplot as plt
import numpy as np

import wheelrail as wr


def on_track(wheel: wr.Profile) -> wr.Wheelset:
    """Put a wheel on the track."""
    pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wheel, radius=460.0)
    return wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)


def conicity(wheelset: wr.Wheelset) -> float:
    """Return the equivalent conicity at 3 mm."""
    return float(wheelset.sweep([3.0], roll="neglect")["conicity"][0])


def fleet() -> dict[str, wr.Wheelset]:
    """Return wheelsets whose profiles are shifted: a stand-in for a folder of measured files."""
    wheel = wr.wheel("S1002")
    return {f"{shift:+.1f}": on_track(wheel.shifted(x=shift)) for shift in np.linspace(-1.0, 1.0, 5)}


# %%
if __name__ == "__main__":
    from distributed import Client, LocalCluster

    import wheelrail.dask

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        wheelsets = fleet()
        found = client.gather(client.map(conicity, list(wheelsets.values())))
        for shift, value in zip(wheelsets, found):
            print(f"profile shifted by {shift} mm: conicity {value:.4f}")
        with tempfile.TemporaryDirectory() as folder:
            files = wheelrail.dask.sweep(wheelsets, np.arange(-70, 71) / 10, folder, client=client)
            print(f"{len(files)} Parquet files")
        assert len(files) == len(wheelsets) and all(0.0 < value < 1.0 for value in found)
    picture, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    axes.plot([float(shift) for shift in wheelsets], found, "o-")
    axes.set(xlabel="shift of the wheels' profiles, mm", ylabel="equivalent conicity at 3 mm")
