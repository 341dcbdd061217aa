"""The journal of a short run in which a node uses files, folders and paths. It is made once."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import dedent

from cfepy.journal import record
from cfepy.journal.journal import FrameWriter, read_frames
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule

PATHS = """
    import os, sys
    import rospy
    import helper

    rospy.init_node("paths")
    print(os.getcwd(), __file__, helper.__file__, sys.argv, os.environ["HOME"])
    print(open("data.txt").read(), os.path.abspath("data.txt"), sorted(os.listdir(".")))
    open("out.txt", "w").write("written")
    rospy.loginfo(open("out.txt").read())
    helper.fail()
"""
HELPER = """
    def fail():
        raise ValueError("as asked")
"""


def paths(folder: Path) -> str:
    """Write a mission whose node prints its location, reads and writes files beside it, and fails in its own module."""
    (folder / "data.txt").write_text("from disk", encoding="utf-8")
    (folder / "paths.py").write_text(dedent(PATHS), encoding="utf-8")
    (folder / "helper.py").write_text(dedent(HELPER), encoding="utf-8")
    startup = "CFE_APP, paths.py, __main__, PATHS, 100, 16384, 0x0, 0;\n!"
    (folder / "startup.scr").write_text(startup, encoding="utf-8")
    return str(folder)


@cache
def sample() -> bytes:
    """Return its bytes."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "run.cfepy")
        record(RunPlan((paths(Path(folder)),), seconds=1, schedule=Schedule.parse("random:3")), path)
        return path.read_bytes()


def with_frames(path: Path, change: object) -> None:
    """Write a journal with changed frames. `change` gets the kind and the body of each, and may change the body."""
    path.write_bytes(sample())
    frames = list(read_frames(path))
    writer = FrameWriter(path)
    for kind, body in frames:
        if callable(change):
            change(kind, body)
        writer.write(kind, body)
    writer.close()
