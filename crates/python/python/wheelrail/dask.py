"""Studies on many machines: sweeps of many wheelsets, as partitioned Parquet (pip install wheelrail[dask]).

Dask distributed runs the tasks and shows its progress; Arrow writes the files. Every task carries all that it needs, so that
nothing is lost with a worker, and few tasks are handed out at a time, so that a study of any size fits in memory. A part is
written under a temporary name and renamed when it is whole: a part that is there is never computed again, so that a study
that was stopped goes on where it was.
"""

# distributed and pyarrow have no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false, reportArgumentType=false, reportAttributeAccessIssue=false

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import closing
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from pickle import dumps, loads
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._progress import shown
from ._wheelrail import Wheelset, fleet_part, fleet_parts
from ._wheelrail import fleet as _assembled

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["Positions", "fleet", "sweep"]

_T = TypeVar("_T")

# Positions of a task: about a second of one core.
_BATCH = 50_000

# Tasks handed out for every thread of the workers: none waits for the scheduler, and few wait in its memory.
_TASKS_A_THREAD = 4


@dataclass(frozen=True)
class Positions:
    """Positions of a sweep: arrays of one length, or numbers, as `Wheelset.sweep` takes them."""

    lateral: ArrayLike
    """Lateral displacements, mm."""
    yaw: ArrayLike = 0.0
    """Yaw angles, rad."""
    roll: ArrayLike = "solve"
    """Roll angles, rad, or "solve" or "neglect"."""

    @classmethod
    def grid(cls, lateral: ArrayLike, yaw: ArrayLike = 0.0, roll: str = "solve") -> Positions:
        """Return every lateral displacement with every yaw, the displacement changing fastest."""
        yaws, laterals = np.meshgrid(np.atleast_1d(yaw), np.atleast_1d(lateral), indexing="ij")
        return cls(laterals.ravel(), yaws.ravel(), roll)


def sweep(
    wheelsets: Sequence[Wheelset] | Mapping[str, Wheelset],
    positions: Positions | ArrayLike,
    folder: str | os.PathLike[str],
    *,
    client: Client,
    batch: int = _BATCH,
    retries: int = 3,
    progress: bool | Callable[[int, int], object] | None = None,
    **options: Any,
) -> list[Path]:
    """Sweep every wheelset over all positions, and return the Parquet files in order.

    The folder gets `pair=NAME/part-FROM-TO.parquet`: the rows of the positions FROM up to but without TO of one wheelset, in
    their order, with `position` counted over all of them. Names are those of the mapping, or numbers. The rows are the same
    bits whatever `batch` and the number of workers. `folder` must be seen by all workers.

    Files that are there are kept: the same call goes on with a study that was stopped. A folder with files of another
    question raises ValueError.

    `client` is a `distributed.Client`, of a cluster of any size. `batch` positions are a task. A task that was lost with its
    workers or its scheduler is handed out again, at most `retries` times; where all workers are gone, others are waited for.
    `progress(done, all)` is called with the parts that are there; `progress=True` shows a bar of tqdm. `options` are
    keywords of `Wheelset.sweep`: within, load, approach, modulus. The equivalent conicity belongs to a wheelset and not to
    its positions, and is left out.

    Raises the errors of `Wheelset.sweep`; that of Dask for a task whose workers died more often.
    """
    if not isinstance(positions, Positions):
        positions = Positions(positions)
    named = wheelsets if isinstance(wheelsets, Mapping) else _numbered(wheelsets)
    lateral, yaw, roll = _arrays(positions)
    root = Path(folder).resolve()
    _mark(root, [*named.items(), lateral, yaw, roll, batch, *sorted(options.items())])
    files: list[Path] = []
    tasks: list[tuple[Wheelset, slice, Path]] = []
    for name, wheelset in named.items():
        home = root / f"pair={name}"
        home.mkdir(parents=True, exist_ok=True)
        for start in range(0, len(lateral), batch):
            part = slice(start, min(start + batch, len(lateral)))
            file = home / f"part-{part.start:010}-{part.stop:010}.parquet"
            files.append(file)
            if not file.exists():
                tasks.append((wheelset, part, file))

    def submit(task: tuple[Wheelset, slice, Path]) -> Future[Any]:
        wheelset, part, file = task
        # The scheduler reads its tasks: it would build every wheelset of objects, and keep their memory.
        pickled = dumps(wheelset, protocol=5)
        arguments = (lateral[part], yaw[part], roll if isinstance(roll, str) else roll[part])
        return client.submit(_part, pickled, part.start, arguments, file, options, pure=False)

    with shown(progress, "parts") as tell, closing(_finished(client, tasks, submit, retries)) as finished:
        if tell:
            tell(len(files) - len(tasks), len(files))
        for number, _ in enumerate(finished, start=len(files) - len(tasks) + 1):
            if tell:
                tell(number, len(files))
    return files


def fleet(
    path: str | os.PathLike[str],
    wheels: str | os.PathLike[str],
    rails: str | os.PathLike[str] | None = None,
    *,
    out: str | os.PathLike[str],
    client: Client,
    retries: int = 3,
    progress: bool | Callable[[int, int], object] | None = None,
) -> dict[str, Any]:
    """Compute a fleet as `wheelrail.fleet` does, part by part on the workers, and return its summary.

    All files and the folder `out` must be seen by all workers. Parts that are there are kept: the same call goes on with a
    fleet that was stopped, and the files are the same bits as those of `wheelrail.fleet` with the same absolute paths.
    `retries` and `progress` are as of `sweep`; progress counts parts.

    Raises the errors of `wheelrail.fleet`; that of Dask for a task whose workers died more often.
    """
    scene, list, folder = (Path(name).resolve() for name in (path, wheels, out))
    # A built-in rail has no path.
    sections = Path(rails).resolve() if rails is not None and Path(rails).exists() else rails
    count = fleet_parts(scene, list, sections)

    def submit(number: int) -> Future[Any]:
        return client.submit(_fleet_part, scene, list, sections, folder, number, pure=False)

    with shown(progress, "parts") as tell, closing(_finished(client, range(count), submit, retries)) as finished:
        for done, _ in enumerate(finished, start=1):
            if tell:
                tell(done, count)
    return _assembled(scene, list, sections, out=folder)


def _fleet_part(path: Path, wheels: Path, rails: str | os.PathLike[str] | None, out: Path, number: int) -> None:
    """Compute one part of a fleet on a worker."""
    one_thread()
    fleet_part(path, wheels, rails, out, number)


def _finished(client: Client, tasks: Sequence[_T], submit: Callable[[_T], Future[Any]], retries: int) -> Generator[_T]:
    """Yield the tasks as they are finished. A task that was lost is submitted again, at most `retries` times."""
    from distributed import KilledWorker, as_completed

    waiting = [(task, retries) for task in reversed(tasks)]
    under_way: dict[Future[Any], tuple[_T, int]] = {}
    completed = as_completed()
    try:
        while waiting or under_way:
            most = _TASKS_A_THREAD * max(sum(client.nthreads().values()), 1)
            while waiting and len(under_way) < most:
                task, left = waiting.pop()
                future = submit(task)
                under_way[future] = (task, left)
                completed.add(future)
            for future in completed.next_batch():
                task, left = under_way.pop(future)
                try:
                    future.result()
                except (KilledWorker, CancelledError):
                    if left == 0:
                        raise
                    waiting.append((task, left - 1))
                else:
                    yield task
                # The scheduler forgets what is done.
                future.release()
    finally:
        # After Ctrl-C or an error nobody waits for the tasks that no worker has begun.
        for future in under_way:
            future.release()


def _while_wanted() -> Callable[[int, int], None]:
    """Return what ends the task of the calling thread once its worker closes, or nobody waits for it any more."""
    from distributed import get_worker

    worker = get_worker()
    key = worker.get_current_task()

    def go_on(done: int, all: int) -> None:
        task = worker.state.tasks.get(key)
        if worker.status.name != "running" or task is None or task.state == "cancelled":
            raise CancelledError

    return go_on


def one_thread() -> None:
    """Keep the calling process to one thread of rayon, unless it has been told otherwise: a worker has one core."""
    os.environ.setdefault("RAYON_NUM_THREADS", "1")


def _numbered(wheelsets: Sequence[Wheelset]) -> dict[str, Wheelset]:
    width = len(str(max(len(wheelsets) - 1, 0)))
    return {f"{number:0{width}}": wheelset for number, wheelset in enumerate(wheelsets)}


def _arrays(positions: Positions) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | str]:
    lateral = np.atleast_1d(np.asarray(positions.lateral, dtype=np.float64))
    lateral, yaw = np.broadcast_arrays(lateral, np.asarray(positions.yaw, dtype=np.float64))
    if isinstance(positions.roll, str):
        return np.ascontiguousarray(lateral), np.ascontiguousarray(yaw), positions.roll
    roll = np.broadcast_to(np.asarray(positions.roll, dtype=np.float64), lateral.shape)
    return np.ascontiguousarray(lateral), np.ascontiguousarray(yaw), np.ascontiguousarray(roll)


def _mark(root: Path, question: Sequence[object]) -> None:
    """Write the hash of the question into the folder, or compare it with the one that is there."""
    # One by one: the bytes of a pickled sequence tell whether two of its items are one object.
    hash = sha256(b"".join(sha256(dumps(item, protocol=5)).digest() for item in question)).hexdigest()
    mark = root / "_question.sha256"
    root.mkdir(parents=True, exist_ok=True)
    if mark.exists() and mark.read_text() != hash:
        raise ValueError(f"{root}: found files of another question; expected those of this one, or none; give another folder")
    _write(mark, lambda file: file.write_text(hash))


def _write(file: Path, content: Callable[[Path], object]) -> None:
    """Write a file under a temporary name, and give it its own in one step."""
    # A worker that is taken for dead may still write: its name must not be that of its successor. What a killed one leaves is hidden, so
    # that pandas and Arrow do not take it for a part.
    temporary = file.with_name(f".{file.name}.{os.getpid()}.tmp")
    content(temporary)
    os.replace(temporary, file)


def _part(
    pickled: bytes,
    start: int,
    arguments: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | str],
    file: Path,
    options: Mapping[str, Any],
) -> None:
    """Compute one part and write it."""
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    if file.exists():
        return
    one_thread()
    lateral, yaw, roll = arguments
    wheelset: Wheelset = loads(pickled)
    table = wheelset.sweep(lateral, yaw, roll, conicity=False, progress=_while_wanted(), **options).to_arrow()
    numbers = pc.add(table["position"], start).cast("uint64")
    table = table.drop_columns(["conicity", "conicity_error"]).set_column(0, "position", numbers)
    doubles = [field.name for field in table.schema if field.type == "double"]
    _write(
        file,
        lambda path: pq.write_table(
            table, path, compression="zstd", use_dictionary=["side"], use_byte_stream_split=doubles
        ),
    )
