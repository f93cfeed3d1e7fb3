"""Progress of what takes long."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from tqdm import tqdm


class _Bar:
    """A bar of tqdm, which appears with the first number."""

    def __init__(self, kind: Callable[..., tqdm[Any]], unit: str) -> None:
        """Take a class of bars, and what they count."""
        self._kind, self._unit = kind, unit
        self._bar: tqdm[Any] | None = None

    def __call__(self, done: int, all: int) -> None:
        """Show how much of all is done."""
        if self._bar is None and all > 0:
            self._bar = self._kind(total=all, unit=f" {self._unit}", unit_scale=True)
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Leave the bar as it is."""
        if self._bar is not None:
            self._bar.close()


@contextmanager
def shown(progress: bool | Callable[[int, int], object] | None, unit: str) -> Generator[Callable[[int, int], object] | None]:
    """Give what is to be called with (done, all): for True a bar of tqdm, which is closed at the end, whatever ends it."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        bar = _Bar(_bars(), unit)
        try:
            yield bar
        finally:
            bar.close()
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress: found a {type(progress).__name__}; expected True, or a function of (done, all)")


def _bars() -> Callable[..., tqdm[Any]]:
    try:
        from tqdm.auto import tqdm
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError("progress=True needs tqdm: pip install tqdm; or give a function of (done, all)") from missing
    return tqdm
