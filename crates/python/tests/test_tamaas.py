"""From a contact to a pressure, by the real solver."""

import numpy as np
import pytest
from conftest import need

import wheelrail as wr


@pytest.mark.filterwarnings("ignore::wheelrail.Doubt")
def test_tamaas_finds_hertz(track: wr.Wheelset) -> None:
    need("tamaas")
    contact = track.touch().right[0]
    problem = contact.to_tamaas(load=30e3)
    pressure = problem.solve()
    assert pressure.shape == problem.separation.shape
    assert pressure.sum() * problem.cell == pytest.approx(problem.load, rel=1e-9)
    assert problem.load * np.cos(contact.contact_angle) == pytest.approx(30e3, rel=1e-12)
    crown = wr.Pair(wr.rail("60E1"), wr.wheel("cone-1:20"), 460.0).placed(0.0, 0.0)
    small = crown.to_tamaas(load=2e3, spacing=0.05).solve()
    assert small.max() == pytest.approx(crown.hertz(load=2e3).max_pressure, rel=5e-3)
    with pytest.raises(RuntimeError, match="cuts the contact"):
        contact.to_tamaas(load=30e3, xi=np.linspace(-1, 1, 21), eta=np.linspace(-1, 1, 21)).solve()
