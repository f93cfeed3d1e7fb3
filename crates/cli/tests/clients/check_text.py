"""The text decks, read by the compiled Fortran reader and by a reader of CONTACT's grammar: FOLDER READ_WRP."""

import sys

import numpy as np
from contact_deck import read_contact
from folder import Checks, Folder
from wrp import read_wrp

folder = Folder(sys.argv[1])
defined = ~np.isnan(folder.s)
filled = np.where(defined, folder.s, folder.fill)
checks = Checks("gfortran")
for name in filter(folder.has, ("separation.wrp", "conform.wrp", "countact.wrp")):
    text = open(folder / name, "rb").read()
    checks(f"{name} ASCII, under 80 columns, with its end",
           text.isascii() and max(map(len, text.split(b"\n"))) < 80 and text.endswith(b"\nEND\n"))
    read = read_wrp(folder / name, sys.argv[2])
    for key, expected in (("xi", folder.xi), ("eta", folder.eta), ("mask", defined.astype("i4")), ("s", filled)):
        checks.same(f"{name} {key}", read[key], expected)
    if "approach_mm" in folder.summary:
        checks(f"{name} approach", read["approach"] == folder.summary["approach_mm"], f"{read['approach']:.6g} mm")
    checks(f"{name} frame right-handed and orthonormal",
           np.allclose(np.cross(read["frame"][1], read["frame"][2]), read["frame"][3], atol=1e-15, rtol=0)
           and np.allclose(read["frame"][1:] @ read["frame"][1:].T, np.eye(3), atol=1e-15, rtol=0))
    if name == "conform.wrp":
        norm = np.linalg.norm(read["normal"][defined], axis=-1)
        checks("conform.wrp normals are unit vectors that point up",
               np.allclose(norm, 1, atol=1e-15, rtol=0) and np.all(read["normal"][defined][:, 1] > 0))
    if name == "countact.wrp":
        checks("countact.wrp cells know their nodes",
               np.all(read["cells"][:, 1:] >= 1) and np.all(read["cells"][:, 1:] <= len(read["points"])),
               f"{len(read['cells'])} cells, {read['area'].sum():.6g} mm2")

checks.client = "CONTACT grammar"
deck = read_contact(folder / "contact.inp")
checks("contact.inp grid", deck["n"] == folder.s.shape[::-1] and deck["first"] == [folder.eta[0], folder.xi[0]]
       and deck["step"] == folder.steps[::-1])
checks.same("contact.inp distances", deck["h"], filled)
checks("contact.inp prescribes a force or an approach", deck["normal"] > 0, f"{deck['normal']}")
summary = getattr(folder, "summary", {})
static, kinetic = (summary.get("scene", {}).get("friction", {}).get(key) for key in ("static", "kinetic"))
static = 0.3 if static is None else static
checks("contact.inp friction", deck["friction"] == [static, static if kinetic is None else kinetic], f"{deck['friction']}")
creepages = summary.get("creepages")
checks("contact.inp rolls where the summary has creepages", (deck["rolling"] is None) == (creepages is None))
if creepages:
    names = ("longitudinal", "lateral", "spin_rad_per_mm")
    speed = creepages["rolling_speed_mm_per_s"]
    checks("contact.inp creepages", deck["creepages"] == [creepages[name] for name in names], f"{deck['creepages']}")
    checks("contact.inp rolls by an element a step",
           deck["rolling"] == (0.0 if creepages["forward"] else np.pi, folder.steps[1], speed), f"{deck['rolling']}")
    if set(summary["scene"]["motion"]) <= {"speed", "lateral", "vertical", "yaw", "roll", "pitch"} and not any(
            summary["scene"]["motion"].get(key) for key in ("lateral", "vertical", "yaw", "roll")):
        # A wheel that only moves forward and turns, from the skew, the radius and the wheel's contact angle.
        turned, skew = creepages["pitch_rad_per_s"] * summary["rolling_radius_mm"], summary["skew_rad"]
        carried = 1000 * summary["scene"]["motion"]["speed"]
        expected = [-(carried + turned * np.cos(skew)), turned * np.sin(skew),
                    -creepages["pitch_rad_per_s"] * np.sin(summary["wheel"]["contact_angle_rad"])]
        error = np.abs(np.array(expected) / speed - deck["creepages"]).max()
        checks("contact.inp creepages are those of a turning wheel", error <= 1e-14, f"off by {error:.1e}")
else:
    checks("contact.inp without motion does not creep", deck["creepages"] == [0, 0, 0])
checks.done()
