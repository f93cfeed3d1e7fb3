"""The exceptions: where, what was found, what was expected, and what to do."""


class Error(Exception):
    """Base of all errors of this package."""

    place: str
    """Where: file, key, argument or line."""
    found: str
    """What stands there."""
    expected: str
    """What could stand there."""
    advice: str
    """What the user can do about it."""

    def __init__(self, place: str, found: str, expected: str, advice: str) -> None:
        super().__init__(place, found, expected, advice)
        self.place, self.found, self.expected, self.advice = place, found, expected, advice

    def __str__(self) -> str:
        place = f"{self.place}: " if self.place else ""
        return f"{place}found {self.found}; expected {self.expected}; {self.advice}"


class InputError(Error, ValueError):
    """The input is malformed, contradictory or impossible."""


class LimitError(Error, ValueError):
    """More is asked for than the program computes or reads."""


class GeometryError(Error):
    """The bodies do not lie as the input supposes: a wheel beside its rail, no ellipse at a kink."""


class FileError(Error, OSError):
    """The disk does not do what it is asked."""


class Doubt(UserWarning):
    """What is allowed but seldom meant: a unit, a sign, a place where no wheel stands.

    `warnings.simplefilter("error", wheelrail.Doubt)` makes exceptions of doubts.
    """

    kind: str
    """What it is about, one word: "load", "gauge", "flange-tip", …"""
    found: str
    """What was found, with its number."""
    advice: str
    """The likely cause, and what to look at."""

    def __init__(self, kind: str, found: str, advice: str) -> None:
        super().__init__(kind, found, advice)
        self.kind, self.found, self.advice = kind, found, advice

    def __str__(self) -> str:
        return f"{self.found}: {self.advice}"
