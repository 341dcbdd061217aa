"""`python -m benchmarks [NAME ...] [--json FILE]`: measure, and write the figures as JSON."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from benchmarks.bus import bus
from benchmarks.codec import codec
from benchmarks.compiled import compiled
from benchmarks.crowd import crowd
from benchmarks.frames import frames
from benchmarks.growth import growth
from benchmarks.measure import contexts_here, machine
from benchmarks.missions import missions
from benchmarks.peers import peers
from benchmarks.recording import recording
from benchmarks.ros_host import ros_host
from benchmarks.schedules import schedules
from benchmarks.services import services
from benchmarks.universe import universe


def main(arguments: list[str] | None = None) -> int:
    """Run the benchmarks that the command line names, or all of them."""
    contexts = contexts_here()
    suites: dict[str, Callable[[], Mapping[str, float]]] = {
        "bus": lambda: bus(contexts),
        "missions": lambda: missions(contexts),
        "schedules": lambda: schedules(contexts),
        "crowd": lambda: crowd(contexts),
        "services": lambda: services(contexts),
        "recording": lambda: recording(contexts),
        "frames": lambda: frames(contexts),
        "growth": lambda: growth(contexts),
        "peers": lambda: peers(contexts),
        "ros_host": ros_host,
        "codec": codec,
        "compiled": lambda: compiled(contexts),
        "universe": lambda: {f"{name}.{each}": value for each in contexts for name, value in universe(each).items()},
    }
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="Measure cfepy on this machine.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(suites)}; default: all")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures here instead of printing them")
    options = parser.parse_args(arguments)
    unknown = set(options.names) - suites.keys()
    if unknown:
        parser.error(f"unknown benchmark {', '.join(sorted(unknown))}")
    results: dict[str, object] = {"machine": machine()}
    for name in options.names or suites:
        print(f"measuring {name} ...", file=sys.stderr)
        results[name] = {figure: float(f"{value:.4g}") for figure, value in suites[name]().items()}
    text = json.dumps(results, indent=2) + "\n"
    if options.json is not None:
        options.json.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
