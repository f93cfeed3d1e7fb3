"""Tables for notebooks."""

from __future__ import annotations

from html import escape
from math import degrees
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._wheelrail import Contact

_HEADS = ("contact", "x on the rail [mm]", "x on the wheel [mm]", "contact angle [°]", "rolling radius [mm]", "gap [mm]")


def touch(roll: float, left: Sequence[Contact], right: Sequence[Contact]) -> str:
    """Return the contacts of both sides as an HTML table."""
    heads = "".join(f"<th>{escape(head)}</th>" for head in _HEADS)
    rows = "".join(_row(contact) for contact in (*left, *right))
    caption = f"<caption>roll {roll * 1e3:.4f} mrad</caption>"
    return f"<table>{caption}<thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"


def _row(contact: Contact) -> str:
    cells = (
        contact.name,
        f"{contact.rail_point[0]:.3f}",
        f"{contact.wheel_point[0]:.3f}",
        f"{degrees(contact.contact_angle):.3f}",
        f"{contact.rolling_radius:.3f}",
        f"{contact.gap:.3g}",
    )
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"


def framed(page: str) -> str:
    """Return a whole page in a frame of its own."""
    return f'<iframe srcdoc="{escape(page)}" style="width:100%;height:760px;border:0"></iframe>'
