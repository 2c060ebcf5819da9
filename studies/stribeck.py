"""How much the quadrant error of a circle grows with the static friction, for a LuGre axis.

usage: stribeck.py FOLDER [--ratios 1,1.5,2,2.5,3] [--feeds "3.2 m/min,16 m/min"]

The static friction F_S of axis X goes from the Coulomb friction F_C to several times of it, all else stays. Where F_S
exceeds F_C the friction falls as the axis leaves standstill (Stribeck), and the controller has more to catch up with.
Writes stribeck.txt and stribeck.svg into FOLDER.
"""

import argparse
import pathlib

import stiction
from picture import picture

MACHINE, AXIS = "mcfv5050ln", "X"


def peak_errors(ratio, feeds):
    """The peak error of the axis, um, at each feed."""
    machine = stiction.machine(MACHINE, set=f"axis.{AXIS}.friction.lugre.static_ratio={ratio}")
    rows = stiction.simulate("circle", machine, friction="lugre", feed=feeds)["rows"]
    return [row["peak_error_um"] for row in rows if row["axis"] == AXIS]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--ratios", default="1,1.5,2,2.5,3", help="static over Coulomb friction")
    parser.add_argument("--feeds", default="3.2 m/min,16 m/min")
    options = parser.parse_args()
    ratios = [float(each) for each in options.ratios.split(",")]
    feeds = [each.strip() for each in options.feeds.split(",")]
    found = [peak_errors(ratio, feeds) for ratio in ratios]

    lines = [f"Peak error of axis {AXIS} of {MACHINE} on a circle, um, LuGre", "",
             "static/Coulomb  " + "  ".join(f"{feed:>12}" for feed in feeds)]
    for ratio, errors in zip(ratios, found):
        lines.append(f"{ratio:14.2f}  " + "  ".join(f"{error:12.3f}" for error in errors))
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / "stribeck.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    curves = [(feed, ratios, [errors[k] for errors in found]) for k, feed in enumerate(feeds)]
    (options.folder / "stribeck.svg").write_text(
        picture(curves, "static over Coulomb friction", f"peak error of {AXIS}, µm"), encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
