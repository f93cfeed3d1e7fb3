"""Sweeps, their tables, and who takes them."""

# pandas and pyarrow have no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false, reportUnknownLambdaType=false

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, need

import wheelrail as wr


SCENE = """
[rail]
profile = "60E1"
rotate = "1:40"
[wheel]
profile = "S1002"
radius = 460.0
[track]
gauge = 1435.0
[wheelset]
back_to_back = 1360.0
flange_back_x = -70.0
"""


def test_a_table_has_the_contacts_that_touch_finds(track: wr.Wheelset) -> None:
    lateral = np.arange(-80, 81) / 10
    table = track.sweep(lateral=lateral, yaw=0.0, load=60e3)
    assert set(np.unique(table["side"])) == {"left", "right"}
    right = table.lowest("right")
    assert np.array_equal(right["lateral_mm"], lateral) and len(right["kink"]) == len(lateral)
    for k in (0, 40, 142):
        touch = track.touch(lateral[k])
        assert right["roll_rad"][k] == touch.roll
        assert (right["rail_x_mm"][k], right["contact_angle_rad"][k]) == (
            touch.right[0].rail_point[0],
            touch.right[0].contact_angle,
        )
        semi_axis = touch.right[0].hertz(load=60e3).semi_axes[0]
        assert right["hertz_xi_mm"][k] == pytest.approx(semi_axis, rel=1e-12)
    assert np.isnan(right["conicity"][80]) and 0.0 < right["conicity"][110] < 1.0
    assert track.sweep(2.0, roll=0.001)["roll_rad"][0] == 0.001
    assert track.sweep([1.0, 2.0], roll=[0.001, 0.002]).rows == 4
    assert track.sweep([300.0]).rows == 0


def test_tables_go_to_pandas_polars_and_arrow(track: wr.Wheelset) -> None:
    need("pandas", "polars", "pyarrow")
    import pandas as pd
    import polars as pl
    import pyarrow as pa

    table = track.sweep(np.arange(-2, 2.001, 0.5), conicity=False)
    frames = [table.to_pandas(), pl.DataFrame(table).to_pandas(), pa.table(table).to_pandas(), pd.DataFrame(dict(table))]
    for frame in frames:
        assert list(frame.columns) == list(table)
        for name in table:
            assert np.array_equal(frame[name].to_numpy(), table[name], equal_nan=table[name].dtype == float), name
    arrow = table.to_arrow()["lateral_mm"].chunk(0).buffers()[1]
    assert arrow.address == table["lateral_mm"].ctypes.data, "a copy"


def test_tables_draw_themselves(track: wr.Wheelset) -> None:
    table = track.sweep(np.arange(-8, 8.001, 0.1))
    svg = table._repr_svg_()
    assert svg is not None and svg.lstrip().startswith("<svg") and "161 positions" in svg
    assert track.sweep([1.0, 0.0], conicity=False)._repr_svg_() is None


def test_progress_is_told_and_may_end_the_sweep(track: wr.Wheelset) -> None:
    told: list[tuple[int, int]] = []
    track.sweep(np.linspace(-8, 8, 60_000), conicity=False, progress=lambda done, all: told.append((done, all)))
    assert told[-1] == (60_000, 60_000) and told == sorted(told)

    def stop(done: int, all: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        track.sweep(np.linspace(-8, 8, 1_000_000), conicity=False, progress=stop)


def test_progress_is_shown_by_a_bar_that_closes(track: wr.Wheelset, monkeypatch: pytest.MonkeyPatch) -> None:
    need("tqdm")
    import tqdm.auto

    bars: list[tqdm.auto.tqdm[object]] = []
    closed: list[object] = []

    class Bar(tqdm.auto.tqdm):  # type: ignore[type-arg]
        def __init__(self, **options: object) -> None:
            super().__init__(file=open(os.devnull, "w"), **options)  # type: ignore[call-overload]
            bars.append(self)

        def close(self) -> None:
            closed.append(self)
            super().close()

    def interrupted(self: object, n: float | None = 1) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(tqdm.auto, "tqdm", Bar)
    lateral = np.linspace(-8, 8, 30_000)
    case = wr.Case.from_toml(SCENE)
    for sweep in (track.sweep, case.sweep):
        with_bar = sweep(lateral, conicity=False, progress=True)
        assert with_bar == sweep(lateral, conicity=False, progress=False) == sweep(lateral, conicity=False, progress=None)
    assert [(bar.n, bar.total) for bar in bars] == [(30_000, 30_000)] * 2 and closed == bars
    monkeypatch.setattr(Bar, "update", interrupted)
    with pytest.raises(KeyboardInterrupt):
        track.sweep(lateral, conicity=False, progress=True)
    assert len(bars) == 3 and closed == bars
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match="pip install tqdm"):
        track.sweep(lateral, conicity=False, progress=True)
    with pytest.raises(TypeError, match="progress: found a int"):
        track.sweep(lateral, conicity=False, progress=3)  # type: ignore[arg-type]


def test_several_threads_share_a_wheelset_and_the_gil_is_free(track: wr.Wheelset) -> None:
    lateral = np.linspace(-8, 8, 20_000)
    expected = track.sweep(lateral, conicity=False)
    with ThreadPoolExecutor(4) as pool:
        tables = list(pool.map(lambda _: track.sweep(lateral, conicity=False), range(8)))
    for table in tables:
        assert all(np.array_equal(table[name], expected[name]) for name in ("rail_x_mm", "roll_rad"))
    ticks, done = 0, threading.Event()

    def work() -> None:
        track.sweep(np.linspace(-8, 8, 200_000), conicity=False)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        time.sleep(0.001)
        ticks += 1
    thread.join()
    assert ticks > 20


# What takes long, each for seconds, as a program that says when it begins.
LONG = {
    "sweep": "track.sweep(np.linspace(-8, 8, 9_000_000), conicity=False)",
    "bar": "track.sweep(np.linspace(-8, 8, 9_000_000), conicity=False, progress=True)",
    "worn": "rough.sweep(np.linspace(-5, 5, 5_000_000), conicity=False)",
    "grid": "track.touch().right[0].separation(np.linspace(-9, 9, 9000), np.linspace(-9, 9, 9000), method='pointwise')",
    "skewed": "yawed.separation(np.linspace(-9, 9, 1_000_000), [0.0, 1.0])",
    "skewed gap": "yawed.normal_gap(np.linspace(-9, 9, 1_000_000), [0.0, 1.0])",
    "strips": "track.touch().right[0].separation(np.linspace(-9, 9, 14_000), np.linspace(-9, 9, 14_000))",
    "varying": "flat.separation(np.linspace(-9, 9, 2000), np.linspace(-9, 9, 2000))",
    "varying gap": "flat.normal_gap(np.linspace(-9, 9, 100), np.linspace(-9, 9, 20_000))",
    "rail": "track.touch().right[0].rail_surface(np.linspace(-9, 9, 30_000_000))",
    "midplane": "track.touch().right[0].midsep(np.linspace(-9, 9, 1_000_000))",
    "picture": "pictured.svg()",
    "look up": "made(np.linspace(-1, 1, 10_000_000), np.zeros(10_000_000))",
    "normals": "track.touch().right[0].normals(np.linspace(-9, 9, 3000), np.linspace(-9, 9, 3000))",
    "pressure": "track.touch(1.0).right[0].patch(load=6e4).pressure(0.03)",
    "profile": "wr.read_profile(sys.argv[1], side='wheel', mirror=False, flip_z=False, origin='as-is')",
    "march": "wr.march(EXAMPLES + '/crossing/crossing.toml', np.arange(-100, 300, 0.02))",
    "contacts": "wr.Case(EXAMPLES + '/scenes/wheelset.toml').sweep(np.linspace(-8, 8, 9_000_000))",
    "table": "wr.table(EXAMPLES + '/scenes/wheelset.toml', (-9, 9), yaw=(-0.03, 0.03), tolerance=1e-6, hertz=True)",
    "conicity": "wr.conicity(track, noise={'points': 0.02, 'radius': 0.1}, samples=100_000)",
    "fleet": "wr.fleet(EXAMPLES + '/fleet/fleet.toml', sys.argv[1] + '.csv', '60E1', out=sys.argv[1] + '.out')",
}

PROGRAM = """
import signal, sys, time, numpy as np, wheelrail as wr
# What begins these tests may ignore Ctrl-C, and its children then do.
signal.signal(signal.SIGINT, signal.default_int_handler)
EXAMPLES = sys.argv[2]
pair = wr.Pair(wr.rail('60E1').rotated('1:40'), wr.wheel('S1002'), 460.0)
distances = dict(gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
track = wr.Wheelset(pair, **distances)
x, z = track.pair.wheel.points(0.1).T
random = np.random.default_rng(1)
with open(sys.argv[1], 'w') as file:
    dense = np.interp(np.linspace(0, len(x), SIZE, endpoint=False), np.arange(len(x)), x), np.interp(np.linspace(0, len(x), SIZE, endpoint=False), np.arange(len(x)), z)
    np.savetxt(file, np.transpose(dense))
with open(sys.argv[1] + '.csv', 'w') as file:
    file.write('wheelset,left,right\\n' + ''.join(f'{k},S1002,S1002\\n' for k in range(5000)))
yawed = track.touch(1.0, yaw=0.02).right[0]
if 'flat' in CALL:
    flat = wr.Case(EXAMPLES + '/wheel_flat/wheel_flat.toml').contacts[0]
if 'made' in CALL:
    made = wr.table(EXAMPLES + '/scenes/wheelset.toml', (-1.0, 1.0), yaw=(-0.005, 0.005), tolerance=1e-2)
if 'rough' in CALL or 'pictured' in CALL:
    worn = wr.read_profile(sys.argv[1], side='wheel', mirror=False, flip_z=False, origin='as-is', curve='interpolation', repair=['drop-duplicates'])
    rough = wr.Wheelset(wr.Pair(pair.rail, worn, 460.0), **distances)
if 'pictured' in CALL:
    pictured = rough.touch(1.0).right[0].patch(approach=0.05)
print('begins', flush=True)
try:
    eval(CALL)
except KeyboardInterrupt:
    print(time.process_time(), flush=True)
    import os
    os._exit(7)
"""


@pytest.mark.parametrize("call", LONG)
def test_ctrl_c_ends_what_takes_long_within_half_a_second(call: str, tmp_path: os.PathLike[str]) -> None:
    size = {"profile": 900_000, "worn": 1500, "picture": 100_000}.get(call, 100)
    program = PROGRAM.replace("CALL", repr(LONG[call])).replace("SIZE", str(size))
    arguments = [sys.executable, "-c", program, os.path.join(tmp_path, "wheel.txt"), str(ROOT / "examples")]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begins\n"
        time.sleep(0.3)
        sent = worked(process.pid)
        process.send_signal(signal.SIGINT)
        ended = process.stdout.readline()
    assert process.returncode == 7, f"{call} ended by itself"
    # Seconds of all processors, to which other programs on the machine do not add.
    took = float(ended) - sent
    assert took < 0.5 * (os.cpu_count() or 1), f"{call}: {took} s"


def worked(pid: int) -> float:
    """Return for how many seconds a process has had processors."""
    user, system = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")
