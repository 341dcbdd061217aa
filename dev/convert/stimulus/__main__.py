"""Public nodes that convert beside Debian's roscpp: `python -m dev.convert.stimulus SOURCES [--json FILE]`.

SOURCES is the folder of `dev.convert.survey`. Each node that converts for the host is built unchanged with Debian's
roscpp, and by cfepy. A driver sends both the same random messages and requests for five seconds, twice with roscpp.
Everything that the node publishes, answers and prints is compared. `--report` writes results.tsv and
docs/how_to/convertor.md.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import tempfile
import time
import traceback
from pathlib import Path
from typing import Any

from cfepy.extra.convert.flight_build import message_library
from cfepy.extra.convert.node_check import programs_of
from cfepy.status import UsageError
from dev.convert.stimulus import report
from dev.convert.stimulus.comparing import Likeness, Part, compared
from dev.convert.stimulus.debian import NotBuilt, RoscppNode
from dev.convert.stimulus.flight import Fault, NodeFlight
from dev.convert.stimulus.script import Scene, Seen, script
from dev.convert.survey import FRESH, LIST, Node, listed
from rospy_shim.types.msgs import Packages

HERE = Path(__file__).parent
SCENES = HERE / "scenes.json"


def scene_of(name: str) -> Scene:
    """Return the environment that a node needs."""
    found = json.loads(SCENES.read_text(encoding="utf-8")).get(name, {})
    return Scene(**found)


def tried(node: Node, sources: Path, folder: Path, seed: int) -> dict[str, Any]:
    """Run a node on both sides. Returns plain values."""
    name = f"{node.repository}/{node.file}"
    scene = scene_of(name)
    environ = {"ROS_PACKAGE_PATH": f"{sources / node.repository}{os.pathsep}{sources / '_messages'}"}
    file = sources / node.repository / node.file
    program = programs_of([str(file)], environ)[0]
    library = message_library(Packages(file, environ))
    made = {"node": name}
    flight = NodeFlight(program, library, environ, folder)
    debian = RoscppNode(program, library, folder)
    fault = None
    try:
        seen = flight.look(scene)
    except (UsageError, AssertionError) as error:
        return {**made, "verdict": "does not fly", "why": str(error)[:500]}
    except Fault as error:
        seen, fault = Seen({}, {}, {}, {}), error
    told = script(f"{seed} {name}", seen, library, scene)
    try:
        debian.build()
        kinds = {*seen.publishes.values(), *seen.subscribes.values(), *seen.serves.values(), *seen.calls.values()}
        debian.generate_of(sorted(kinds - {"*"}))
        first = debian.run(told, scene)
    except NotBuilt as error:
        return {**made, "verdict": "not built", "why": str(error)[:500]}
    try:
        if fault is not None:
            raise fault
        ours = flight.run(told, scene, first)
    except Fault as error:
        if not first.failed:
            return {**made, "verdict": "fault", "why": str(error)[:500]}
        end = Part("end", Likeness.EQUAL, 1, f"an error ends it on both sides: {error}"[:500])
        return {**made, "verdict": "equal", "seen": seen._asdict(), "parts": [end._asdict()]}
    for each in (first, ours):
        if each.note:
            return {**made, "verdict": "not driven", "why": each.note[:500]}
    parts = compared(first, first, ours)
    if any(each.likeness is Likeness.DIFFERENT for each in parts):
        parts = compared(first, debian.run(told, scene), ours)  # nondeterministic parts
    worst = "different" if any(each.likeness is Likeness.DIFFERENT for each in parts) else "equal"
    return {**made, "verdict": worst, "seen": seen._asdict(), "parts": [each._asdict() for each in parts]}


def main() -> None:
    """Try nodes."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.stimulus", description=__doc__)
    parser.add_argument("sources", type=Path, nargs="?", help="folder OWNER/NAME/...")
    parser.add_argument("--list", type=Path, default=LIST, help=f"another list, such as {FRESH.name}")
    parser.add_argument("--only", default="", help="a part of OWNER/NAME/file")
    parser.add_argument("--converts", type=Path, required=True, help="the verdicts of dev.convert.survey --json")
    parser.add_argument("--json", type=Path, help="results; those that are there already are kept")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="a folder for the outputs")
    parser.add_argument(
        "--report", action="store_true", help="write the results of --json into results.tsv and the document"
    )
    arguments = parser.parse_args()
    verdicts = json.loads(arguments.converts.read_text(encoding="utf-8"))
    convert = {f"{each['repository']}/{each['file']}" for each in verdicts if not each["refused"]["host"]}
    if arguments.report:
        for row in report.write(report.read(arguments.json, verdicts)):
            print(row.verdict, row.node, row.why)
        return
    done = json.loads(arguments.json.read_text(encoding="utf-8")) if arguments.json and arguments.json.is_file() else {}
    for node in listed(arguments.list):
        name = f"{node.repository}/{node.file}"
        if name not in convert or arguments.only not in name or name in done:
            continue
        begun = time.monotonic()
        folder = Path(tempfile.mkdtemp()) if arguments.keep is None else arguments.keep / name.replace("/", "_")
        folder.mkdir(parents=True, exist_ok=True)
        try:
            result = tried(node, arguments.sources.resolve(), folder.resolve(), arguments.seed)
        except Exception:
            result = {"node": name, "verdict": "failed", "why": traceback.format_exc()[-1500:]}
        if arguments.keep is None:
            shutil.rmtree(folder)
        done[name] = result
        print(f"{result['verdict']:12} {name} {time.monotonic() - begun:.0f} s {result.get('why', '')}", flush=True)
        for part in result.get("parts", ()):
            if part["likeness"] != Likeness.EQUAL:
                print(
                    f"             {part['name']} ({part['seen']}): {part['likeness']}: {part['example']}", flush=True
                )
        if arguments.json:
            arguments.json.write_text(json.dumps(done, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
