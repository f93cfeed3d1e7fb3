"""Plain values: what is found, with fields that can be read, compared and pickled. Lengths are in mm, angles in rad."""

from __future__ import annotations

from math import nan, pi
from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import meshio
    import pyvista
    import xarray
    from numpy.typing import ArrayLike, NDArray

    from ._wheelrail import Contact

_Box = tuple[tuple[float, float], tuple[float, float]]


def same(one: object, other: object) -> bool:
    """Tell whether two values are the same; arrays are by their numbers, where NaN is NaN."""
    if isinstance(one, np.ndarray):
        array = cast("NDArray[Any]", one)
        return isinstance(other, np.ndarray) and np.array_equal(array, cast("NDArray[Any]", other), equal_nan=array.dtype.kind == "f")
    if isinstance(one, list) and isinstance(other, list):
        items, others = cast("list[object]", one), cast("list[object]", other)
        return len(items) == len(others) and all(map(same, items, others))
    if isinstance(one, dict) and isinstance(other, dict):
        fields, of_other = cast("dict[object, object]", one), cast("dict[object, object]", other)
        return fields.keys() == of_other.keys() and all(same(value, of_other[key]) for key, value in fields.items())
    return bool(one == other)


class _Value:
    """Fields that cannot be changed; `dataclasses` would take longer to import than all the rest."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: Any) -> None:
        """Take the fields in their order."""
        vars(self).update(zip(type(self).__annotations__, values))

    def __setattr__(self, name: str, value: object) -> None:
        """Refuse."""
        raise AttributeError(f"{type(self).__name__}.{name} cannot be changed")

    def __eq__(self, other: object) -> bool:
        """Tell whether all fields are the same."""
        return type(other) is type(self) and all(same(value, vars(other)[name]) for name, value in vars(self).items())

    def __repr__(self) -> str:
        """Return the fields that are no arrays and lists."""
        short = {name: value for name, value in vars(self).items() if not isinstance(value, list | np.ndarray)}
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in short.items())})"


class WheelTouch(_Value):
    """First touch of a single wheel.

    >>> len(pair.touch(offset=0.0).contacts)
    1
    """

    height: float
    """Height of the wheel profile's origin over the rail's, mm, + up."""
    contacts: list[Contact]
    """The contacts, the lowest gap first."""


class Touch(_Value):
    """First touch of both wheels.

    >>> touch = track.touch(lateral=3.0)
    >>> round(touch.delta_r, 3)
    0.959
    """

    lateral: float
    """Lateral displacement, mm, + to the right."""
    yaw: float
    """Yaw, rad, + moves the right-hand wheel forward."""
    roll: float
    """Roll, rad, solved or given, + lowers the right-hand wheel."""
    z: tuple[float, float]
    """Height of the axle's middle above the rolling radius over the top of rail when the left and the right side touch, mm, + up:
    equal where the roll is solved."""
    left: list[Contact]
    """Contacts of the left side, the lowest gap first, in mirrored axes."""
    right: list[Contact]
    """Contacts of the right side, the lowest gap first."""

    @property
    def delta_r(self) -> float:
        """Right less left rolling radius of the lowest contacts, mm."""
        left, right = (side[0].rolling_radius if side else nan for side in (self.left, self.right))
        return right - left

    def __repr__(self) -> str:
        """Return the position and the numbers of contacts."""
        sides = f"{len(self.left)} left, {len(self.right)} right"
        return f"Touch(lateral={self.lateral}, yaw={self.yaw}, roll={self.roll:.6e}, {sides})"

    def _repr_html_(self) -> str:
        from ._html import touch

        return touch(self.roll, self.left, self.right)


class Feasibility(_Value):
    """Whether the bodies nowhere overlap at first touch.

    >>> bool(contact.feasibility())
    True
    """

    feasible: bool
    """Whether the least separation is 0, to rounding."""
    least_separation: float
    """The least separation, mm, negative where the bodies overlap."""
    at: tuple[float, float]
    """(xi, eta) of it, mm."""

    def __bool__(self) -> bool:
        """Tell whether the contact is feasible."""
        return self.feasible


class Pressure(_Value):
    """Pressures over a patch, of an elastic half-space: lengths in mm, pressures in N/mm2.

    >>> contact.patch(load=60e3).pressure()
    Pressure(largest=1315, largest_error=2, contact_area=70.8, load=60179)
    """

    xi: NDArray[np.float64]
    """Points in xi, (n_xi,)."""
    eta: NDArray[np.float64]
    """Points in eta, (n_eta,)."""
    values: NDArray[np.float64]
    """The pressures at the points, >= 0, (n_xi, n_eta)."""
    largest: float
    """The largest pressure."""
    largest_error: float
    """Its estimated error."""
    largest_at: tuple[float, float]
    """(xi, eta) of it."""
    contact_area: float
    """True contact area, mm2, where pressures are positive."""
    load: float
    """Their normal force, N."""
    cell: tuple[float, float]
    """Sides of the half-space's cells."""
    outline: list[NDArray[np.float64]]
    """The edges of the true contact: lines (n, 2) of xi and eta."""

    def __repr__(self) -> str:
        """Return what the pressures add up to."""
        return (
            f"Pressure(largest={self.largest:.0f}, largest_error={self.largest_error:.0f}, "
            f"contact_area={self.contact_area:.1f}, load={self.load:.0f})"
        )


class Hertz(_Value):
    """Hertz's ellipse at a contact: half-axes in mm, approach in mm, load in N, pressures in N/mm2.

    >>> contact.hertz(load=60e3)
    Hertz(load=60242.8, max_pressure=1320.139, semi_axes=(3.2576, 6.6886), approach=0.082289)
    """

    long_semi_axis: float
    """Long semi-axis, mm."""
    short_semi_axis: float
    """Short semi-axis, mm."""
    long_axis_angle: float
    """Angle of the long axis from xi towards eta, rad, in (-pi/2, pi/2]."""
    semi_axes: tuple[float, float]
    """The semi-axes nearest to xi (across the rail) and to eta (along it), mm."""
    approach: float
    """Approach of the bodies, mm."""
    load: float
    """Normal load, N."""
    max_pressure: float
    """Largest pressure, N/mm2."""

    @property
    def area(self) -> float:
        """Area of the ellipse, mm2."""
        return pi * self.long_semi_axis * self.short_semi_axis

    def __repr__(self) -> str:
        """Return load, pressure, semi-axes and approach."""
        xi, eta = self.semi_axes
        pressed = f"load={self.load:.1f}, max_pressure={self.max_pressure:.3f}"
        return f"Hertz({pressed}, semi_axes=({xi:.4f}, {eta:.4f}), approach={self.approach:.6f})"


class Run(_Value):
    """What a run left.

    >>> run = wr.run("scene.toml", out="folder")  # doctest: +SKIP
    """

    folder: Path
    """The folder with its files."""
    parts: list[Path]
    """The folder of every part, the first one first: each has a summary.json."""
    refusals: list[str]
    """Why contacts are infeasible or patches empty, a line each."""
    warnings: list[str]
    """What a user should know before using the files."""

    @property
    def summaries(self) -> list[dict[str, Any]]:
        """The summary.json of every part, as dicts."""
        from json import loads

        return [loads((part / "summary.json").read_text("utf-8")) for part in self.parts]


class Check(_Value):
    """What triangle meshes, measured by parry3d, say of a contact.

    >>> case = wr.Case.from_dict({
    ...     "rail": {"profile": wr.rail("60E1"), "rotate": "1:40"},
    ...     "wheel": {"profile": wr.wheel("S1002"), "radius": 460.0},
    ...     "contact": {"offset": 2.0},
    ...     "patch": {"load": 60e3},
    ... })
    >>> [check.agrees for check in case.check()]
    [True]
    """

    name: str
    """The contact."""
    agrees: bool
    """Whether separations, normals and distances agree within the errors of the meshes."""
    values: dict[str, Any]
    """All figures of the comparison."""
    text: str
    """The same in lines."""

    def __str__(self) -> str:
        """Return the lines that `wheelrail check` prints."""
        return self.text


class Component(_Value):
    """One connected component of a patch. Lengths in mm.

    >>> [component.holes for component in contact.patch(load=60e3).components]
    [[]]
    """

    area: float
    """Area, mm2."""
    perimeter: float
    """Length of all its boundaries, mm."""
    extent: _Box
    """The box around it ((xi_min, xi_max), (eta_min, eta_max)), mm."""
    deepest: tuple[float, float, float]
    """The least separation on it and its place: (s, xi, eta), mm."""
    boundary: NDArray[np.float64]
    """The outer boundary: a closed loop, float64 (n, 2), columns xi and eta in mm, counter-clockwise."""
    holes: list[NDArray[np.float64]]
    """The boundaries of its holes: closed loops like `boundary`, clockwise. Only a skewed wheel makes holes."""


class Mesh(_Value):
    """A mesh of triangles or quadrangles in the contact frame (xi, eta, zeta), mm, with fields.

    >>> mesh = contact.patch(load=60e3).mesh()
    >>> mesh.points.shape[1], mesh.kind, sorted(mesh.point_data)
    (3, 'triangle', ['overlap', 'rail_normal', 'separation', 'wheel_normal'])
    """

    points: NDArray[np.float64]
    """Nodes, float64 (n, 3)."""
    kind: str
    """"triangle" or "quad"."""
    cells: NDArray[np.int64]
    """Nodes of the cells, int64 (m, 3) or (m, 4), counter-clockwise seen from outside the body."""
    point_data: Mapping[str, NDArray[Any]]
    """Fields by name, each (n,) or (n, 3)."""
    cell_data: Mapping[str, NDArray[Any]]
    """Fields by name, each (m,)."""

    def __repr__(self) -> str:
        """Return numbers of points and cells."""
        return f"Mesh({len(self.points)} points, {len(self.cells)} cells of kind {self.kind}: {', '.join(self.point_data)})"

    def to_meshio(self) -> meshio.Mesh:
        """Return it as meshio's, which writes some forty formats. Needs meshio."""
        import meshio

        cell_data: dict[str, list[ArrayLike]] = {name: [values] for name, values in self.cell_data.items()}
        return meshio.Mesh(self.points, [(self.kind, self.cells)], dict(self.point_data), cell_data)

    def to_pyvista(self) -> pyvista.PolyData:
        """Return it as PyVista's, which shows it. Needs pyvista."""
        import pyvista

        counts = np.full((len(self.cells), 1), self.cells.shape[1])
        mesh = pyvista.PolyData(self.points, faces=np.hstack([counts, self.cells]).ravel())
        # PyVista's arrays have no types of numbers.
        mesh.point_data.update(dict(self.point_data))  # pyright: ignore[reportUnknownMemberType]
        mesh.cell_data.update(dict(self.cell_data))  # pyright: ignore[reportUnknownMemberType]
        return mesh


# What the names of a grid mean, and their units.
_MEANINGS = {
    "xi": ("place along the common tangent, + towards the field side", "mm"),
    "eta": ("place along the rail, + forward", "mm"),
    "sigma": ("arc length along the rail from C, + towards +xi", "mm"),
    "zeta": ("height along the common normal at C, + from rail to wheel", "mm"),
    "alpha": ("angle of the rail's outward normal from zeta", "rad"),
    "separation": ("separation of the undeformed bodies, + apart", "mm"),
    "normal_gap": ("gap along the rail's own normal, + apart", "mm"),
}


class Grid(_Value):
    """Values over a grid, with the coordinates of its points.

    >>> wr.Grid.of_separation(contact, np.linspace(-5, 5, 11), np.linspace(-8, 8, 17))
    Grid(separation over 11 xi x 17 eta)
    """

    name: str
    """"separation", mm, over xi and eta; or "normal_gap", mm, over sigma and eta."""
    values: NDArray[np.float64]
    """The values, float64 (n, m); NaN where a body has no surface."""
    axes: Mapping[str, NDArray[np.float64]]
    """The two axes by name, in the order of the values, mm: (n,) and (m,)."""
    along: Mapping[str, NDArray[np.float64]]
    """What else is known of the points of the first axis, (n,): xi and zeta in mm and alpha in rad along sigma, as of
    `Contact.rail_surface`; nothing along xi."""

    @classmethod
    def of_separation(cls, contact: Contact, xi: ArrayLike, eta: ArrayLike, **options: Any) -> Grid:
        """Compute the separation as `Contact.separation` does, whose options it takes."""
        values = contact.separation(xi, eta, **options)
        return cls("separation", values, {"xi": _axis(xi), "eta": _axis(eta)}, {})

    @classmethod
    def of_normal_gap(cls, contact: Contact, sigma: ArrayLike, eta: ArrayLike, **options: Any) -> Grid:
        """Compute the gap of conformal contact as `Contact.normal_gap` does, whose options it takes."""
        values = contact.normal_gap(sigma, eta, **options)
        along = dict(zip(("xi", "zeta", "alpha"), contact.rail_surface(sigma)))
        return cls("normal_gap", values, {"sigma": _axis(sigma), "eta": _axis(eta)}, along)

    def __repr__(self) -> str:
        """Return the name, and the axes with their numbers of points."""
        return f"Grid({self.name} over {' x '.join(f'{len(axis)} {name}' for name, axis in self.axes.items())})"

    def to_xarray(self) -> xarray.DataArray:
        """Return it as xarray's, with its coordinates; each has `units` and `long_name`. The values are shared. Needs xarray."""
        try:
            import xarray
        except ModuleNotFoundError as missing:
            raise ModuleNotFoundError("Grid.to_xarray needs xarray: pip install xarray") from missing
        first = next(iter(self.axes))
        coordinates = {name: ((name,), axis, _meaning(name)) for name, axis in self.axes.items()}
        coordinates |= {name: ((first,), values, _meaning(name)) for name, values in self.along.items()}
        return xarray.DataArray(self.values, coordinates, tuple(self.axes), self.name, _meaning(self.name))


def _meaning(name: str) -> dict[str, str]:
    """Return the attributes of a variable."""
    long_name, units = _MEANINGS[name]
    return {"long_name": long_name, "units": units}


def _axis(axis: ArrayLike) -> NDArray[np.float64]:
    # A copy: the caller may change its own.
    return np.array(axis, dtype=np.float64)
