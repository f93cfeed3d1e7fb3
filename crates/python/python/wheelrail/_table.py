"""The table of a sweep."""

# pyarrow and polars have no whole types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownParameterType=false

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._values import same
from ._wheelrail import doubt_words, sweep_picture

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from numpy.typing import NDArray

_SIDES = ("left", "right")
_DOUBTS = doubt_words()


class Table(Mapping[str, "NDArray[Any]"]):
    """Contacts of a wheelset at many positions: a mapping of column names to NumPy arrays (n,), a row for each position,
    side and contact. Lengths are in mm, angles in rad, as the names say; NaN stands where a quantity does not exist.

    `position` counts the positions from 0; one without contact has no row. `contact` counts those of a side from 1, the
    lowest gap first. What the other columns mean is said in "Sweeps" of the library's documentation.

    `to_pandas`, `to_arrow`, `polars.DataFrame(table)`, `pyarrow.table(table)` and `pandas.DataFrame(table)` take it; number
    columns are shared, not copied, where the other side can share them.

    >>> table = track.sweep(np.arange(-6, 7), conicity=False)
    >>> table.rows, table["side"][0].item()
    (26, 'left')
    """

    def __init__(self, columns: Mapping[str, NDArray[Any]]) -> None:
        """Take the columns of a sweep: those of this table in their order, `right` instead of `side`."""
        self._columns = dict(columns)
        self._names = tuple("side" if name == "right" else name for name in self._columns)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column: float64, but for `position` (uint64), `contact` (uint32), `kink` (bool), `side` and `doubt` (str)."""
        if name == "side":
            return np.asarray(_SIDES)[self._columns["right"].astype(np.intp)]
        if name == "doubt":
            return np.asarray(_DOUBTS)[self._columns["doubt"].astype(np.intp)]
        if name not in self._names:
            raise KeyError(name)
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the columns."""
        return iter(self._names)

    def __len__(self) -> int:
        """Return the number of columns; `rows` is that of the rows."""
        return len(self._names)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self._columns["position"])

    def lowest(self, side: str) -> dict[str, NDArray[Any]]:
        """Return the columns of the lowest contacts of one side, "left" or "right": a row for each position with contact."""
        if side not in _SIDES:
            raise ValueError(f'found side {side!r}; expected "left" or "right"')
        chosen = (self._columns["right"] == (side == "right")) & (self._columns["contact"] == 1)
        return {name: self[name][chosen] for name in self}

    def _coded(self) -> Iterator[tuple[str, tuple[NDArray[np.int8], list[str]]]]:
        """Iterate over the columns of words: their names, with codes and words."""
        yield "side", (self._columns["right"].astype(np.int8), list(_SIDES))
        yield "doubt", (self._columns["doubt"].astype(np.int8), _DOUBTS)

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame; `side` and `doubt` are categorical. Needs pandas."""
        import pandas as pd

        columns = {name: pd.Categorical.from_codes(codes, categories=words) for name, (codes, words) in self._coded()}
        return pd.DataFrame({name: columns[name] if name in columns else self[name] for name in self}, copy=False)

    def to_arrow(self) -> pyarrow.Table:
        """Return an Arrow table; `side` and `doubt` are dictionaries of strings. Needs pyarrow."""
        import pyarrow as pa

        columns = {
            name: pa.DictionaryArray.from_arrays(pa.array(codes), pa.array(words)) for name, (codes, words) in self._coded()
        }
        return pa.table({name: columns[name] if name in columns else pa.array(self[name]) for name in self})

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the table as an Arrow stream (PyCapsule interface), by way of pyarrow, or of polars where that is there."""
        try:
            table: Any = self.to_arrow()
        except ModuleNotFoundError:
            import polars as pl

            table = pl.DataFrame({name: self[name] for name in self})
        return table.__arrow_c_stream__(requested_schema)

    def svg(self, title: str = "Sweep") -> str:
        """Return the usual curves over the lateral displacement as SVG: at most 2000 positions, evenly chosen.

        Raises InputError for displacements that do not ascend.
        """
        return sweep_picture(self._columns, title)

    def __repr__(self) -> str:
        """Return rows and columns in short."""
        return f"Table({self.rows} rows: {', '.join(self)})"

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        """Tell whether all columns are the same, NaN where NaN is."""
        return isinstance(other, Table) and self._names == other._names and all(map(same, self.values(), other.values()))

    def _repr_svg_(self) -> str | None:
        try:
            return self.svg()
        except ValueError:
            # Positions in no order have no curves.
            return None
