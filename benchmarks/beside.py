"""Two environments in turns: `python -m benchmarks.beside PYTHON [NAME ...] [--rounds N]`.

This Python and another one, each with a checkout of cfepy installed (`pip install -e`), run the same benchmarks in
turns, so that other load on the computer affects both alike. Use it to compare a version with the one before, or the
kernel and the bus as sources with the same compiled. The table has the median of the ratios of all rounds, and their
range; above 1, the other one is faster. Rates are those of `python -m benchmarks NAME`, in wall time.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from benchmarks.measure import machine

NAMES = ("bus", "missions")
ROUNDS = 5
ROOT = "import cfepy, pathlib; print(pathlib.Path(cfepy.__file__).resolve().parents[1])"
VERSION = "import sys; from cfepy.cli.main import main; main(['--version'])"
SECONDS = "_s"  # suffix of figures that are times, not rates

Figures = dict[str, float]


def root_of(python: str) -> Path:
    """Return the checkout that is installed for a Python."""
    with tempfile.TemporaryDirectory() as elsewhere:
        done = subprocess.run([python, "-c", ROOT], cwd=elsewhere, capture_output=True, text=True, check=True)
    return Path(done.stdout.strip())


def figures(python: str, root: Path, names: Sequence[str]) -> Figures:
    """Return the figures of a checkout's benchmarks, by name."""
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "figures.json"
        command = [python, "-m", "benchmarks", *names, "--json", str(found)]
        subprocess.run(command, cwd=root, stdout=subprocess.DEVNULL, check=True)
        measured: Mapping[str, Figures] = json.loads(found.read_text(encoding="utf-8"))
    return {figure: value for name in names for figure, value in measured[name].items()}


def gain(figure: str, before: float, after: float) -> float:
    """Return the improvement factor of a figure."""
    return before / after if figure.endswith(SECONDS) else after / before


def main() -> None:
    """Measure in turns, and print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.beside", description=__doc__.partition("\n")[0])
    parser.add_argument("python", metavar="PYTHON", help="Python of the other environment")
    parser.add_argument("names", nargs="*", metavar="NAME", default=NAMES, help=f"benchmarks ({', '.join(NAMES)})")
    parser.add_argument("--rounds", type=int, default=ROUNDS, metavar="N", help=f"turns ({ROUNDS})")
    options = parser.parse_args()
    arms = [(python, root_of(python)) for python in (sys.executable, options.python)]
    found: list[list[Figures]] = [[], []]
    for turn in range(options.rounds):
        for arm in (0, 1) if turn % 2 == 0 else (1, 0):
            print(f"round {turn + 1} of {options.rounds}: {arms[arm][1]}", file=sys.stderr)
            found[arm].append(figures(*arms[arm], options.names))
    print(json.dumps(machine()))
    for name, (python, root) in zip(("this ", "other"), arms, strict=True):
        told = subprocess.run([python, "-c", VERSION], cwd=root, capture_output=True, text=True, check=True)
        print(f"{name} {told.stdout.strip()}")
    print(f"{'':44}{'this':>12}{'other':>12}  ratio")
    for figure in found[0][0]:
        before, after = ([each[figure] for each in arm if figure in each] for arm in found)
        if len(before) == len(after) and "times_floor" not in figure:
            ratios = sorted(gain(figure, *pair) for pair in zip(before, after, strict=True))
            spread = f"{median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"
            print(f"{figure:44}{median(before):12,.4g}{median(after):12,.4g}  {spread}")


if __name__ == "__main__":
    main()
