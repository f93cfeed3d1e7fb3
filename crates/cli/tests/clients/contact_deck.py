"""A reader of the grammar of CONTACT's module 3."""

import numpy as np


def read_contact(path):
    """A reader of the grammar of CONTACT's module 3 with IBASE = 9: words up to % on lines up to 256 characters."""
    lines = []
    for line in open(path, encoding="ascii"):
        assert len(line.rstrip("\n")) <= 256, "line too long"
        words = line.split("%")[0].split()
        assert len(words) <= 50, "too many items"
        if words:
            lines.append(words)
    take = iter(lines).__next__
    assert int(take()[0]) == 3
    digits = take()[0]
    assert len(digits) == 6 and digits[:2] == "20" and digits[2] in "03" and digits[3] in "01" and digits[4:] == "00"
    influence = take()[0]
    assert influence in ("022020", "024020", "024029") and take()[0] == "0002221"
    rounds = [int(word) for word in take()[:4]][3]
    # CONTACT warns of one round where the reference is curved and slips.
    curved = influence[:3] == "024"
    assert rounds > 1 if curved and digits[2] == "3" else rounds >= 1
    kinematics = [float(word) for word in take()[:4]]
    deck = {"force": digits[3] == "1", "normal": kinematics[0], "creepages": kinematics[1:], "rolling": None}
    deck["friction"] = [float(word) for word in take()[:2]]
    if digits[2] == "3":
        chi, step, speed = take()[:3]
        degrees = chi.endswith("d")
        chi = np.deg2rad(float(chi[:-1])) if degrees else float(chi)
        deck["rolling"] = (chi, float(step), float(speed))
    if curved:
        method, variant, count = (int(word) for word in take()[:3])
        assert method in (0, 1) and 1 <= variant <= 4 and 2 <= count <= 9999
        deck["inclination"] = np.array([[float(word) for word in take()[:2]] for _ in range(count)])
        assert np.all(np.diff(deck["inclination"][:, 0]) > 0)
    [float(word) for word in take()[:4]]
    assert int(take()[0]) == 3
    grid = take()
    deck |= {"n": (int(grid[0]), int(grid[1])), "first": [float(w) for w in grid[2:4]], "step": [float(w) for w in grid[4:6]]}
    assert take()[:2] == ["9", "1"]
    h = []
    while len(h) < deck["n"][0] * deck["n"][1]:
        h += [float(word) for word in take()]
    deck["h"] = np.array(h).reshape(deck["n"][1], deck["n"][0])
    if influence[-1] == "9":
        slips = [[float(word) for word in take()] for _ in h]
        deck["extra_slip"] = np.array(slips).reshape(deck["n"][1], deck["n"][0], 2)
    assert take()[0] == "0" and next(iter(lines[len(lines):]), None) is None
    return deck
