"""`cfepy new`: write the skeleton of an application or a mission, which runs unchanged.

An application in Python is a copy of apps/sample_app under another name, so that only one example needs maintenance.
One in C, and the files around the others, are in `templates`.
"""

from __future__ import annotations

import argparse
import keyword
import os
import re
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

from cfepy.cli.main import ENDED_WELL
from cfepy.interpreter.own_code import BESIDE
from cfepy.plugins import Hook
from cfepy.reading.resources import shipped
from cfepy.status import UsageError
from cfepy.tbl import image

TEMPLATES = Path(__file__).with_name("templates")
APP_SUFFIX = "_app"
LONGEST_APP = 14  # its entry point, NAME_Main, must fit the 19 characters that cFE permits
LONGEST = {"app": LONGEST_APP, "mission": LONGEST_APP - len(APP_SUFFIX)}
SHIPPED = ("ci_lab", "hk", "sample_app", "sample_lib", "sch", "sch_lab", "sch_lib", "to_lab")
TAKEN = ("cfepy", "rclpy", "rospy", "std_msgs", *BESIDE, *SHIPPED)
OF_CFE = ("cfe_", "ccsds_", "os_", "osal_")
LIBRARY = "library"  # the sample's use of the sample library, which a new application does not need
FIRST_TOPIC, TOPIC_PAIRS = 0xA0, 0x30  # topic ids of new apps: after NASA's apps, before ROS topics
FIRST_PERF_ID, PERF_IDS = 100, 28  # after NASA's apps, up to the last of cFE's 128

Files = dict[str, bytes]
MISSION_FROM: Hook[Callable[[Path, Path | None, str | None], int]] = Hook("mission_from")
"""Makes a mission folder from a mission tree or an application in C, and flies it. Returns the exit status."""


def run(arguments: argparse.Namespace) -> int:
    """Write the skeleton that the command line asks for into a new folder.

    Returns:
        The exit status.

    Raises:
        UsageError: the name cannot be used, or such a file or folder exists already.
    """
    kind, name = arguments.kind, arguments.name
    if kind == "mission" and arguments.source is not None:
        made = None if name is None else Path(name)
        return MISSION_FROM.need("`--from`")(Path(arguments.source), made, arguments.cfe)
    if kind == "mission" and arguments.cfe is not None:
        raise UsageError("only valid with --from", field="--cfe")
    if name is None:
        raise UsageError("missing name: cfepy new mission NAME", field="NAME")
    _check_name(kind, name)
    folder = Path(name)
    if os.path.exists(folder):
        raise UsageError("already exists and is not overwritten; choose another name", file=folder)
    if arguments.c:
        _check_c(name)
    files = mission_files(name) if kind != "app" else c_app_files(name) if arguments.c else app_files(name)
    try:
        for path, content in files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(content)
    except OSError as error:
        raise UsageError(f"cannot be written: {error.strerror}", file=error.filename) from None
    for path in files:
        print(folder / path)
    print(f"\nNow: cfepy build {name} && cfepy run {name}" if arguments.c else f"\nNow: cfepy run {name}")
    return ENDED_WELL


def app_files(name: str) -> Files:
    """Return an application and the smallest mission around it: path to content."""
    return {
        "README.md": _rendered("app/README.md.in", name, name),
        "startup.scr": _rendered("app/startup.scr.in", name, name),
        f"test_{name}.py": _rendered("app/test_app.py.in", name, name),
        **_package(name),
    }


def c_app_files(name: str) -> Files:
    """Return an application in C, in the layout of cFS, which is a mission, too: path to content."""
    templates = sorted(file.relative_to(TEMPLATES) for file in (TEMPLATES / "c_app").rglob("*.in"))
    made = {template: template.with_suffix("").relative_to("c_app").as_posix() for template in templates}
    return {path.replace("NAME", name): _rendered(template.as_posix(), name, name) for template, path in made.items()}


def mission_files(folder: str) -> Files:
    """Return a mission of an application and two ROS nodes: path to content."""
    app = folder + APP_SUFFIX
    plain = ("README.md", "startup.scr", "mission.yaml", "talker.py", "listener.py")
    return {
        **{file: _rendered(f"mission/{file}.in", app, folder) for file in plain},
        f"test_{folder}.py": _rendered("mission/test_mission.py.in", app, folder),
        **_package(app),
    }


def _check_name(kind: str, name: str) -> None:
    longest = LONGEST[kind]
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or len(name) > longest:
        text = (
            f"invalid name {name!r}; expected 1 to {longest} lower-case letters, "
            "digits and '_', beginning with a letter"
        )
        raise UsageError(text, field="NAME")
    if keyword.iskeyword(name) or name in sys.stdlib_module_names or name in TAKEN:
        raise UsageError(f"the name {name!r} is already taken; choose another name", field="NAME")


def _check_c(name: str) -> None:
    if name.startswith(OF_CFE):
        raise UsageError(f"C names made from {name!r} would clash with cFE's own; choose another name", field="NAME")


def _rendered(template: str, name: str, folder: str) -> bytes:
    text = (TEMPLATES / template).read_text(encoding="utf-8")
    topic = _topic(name)
    for key, value in (
        ("{{name}}", name),
        ("{{NAME}}", name.upper()),
        ("{{folder}}", folder),
        ("{{topic}}", f"0x{topic:02X}"),
        ("{{hk_topic}}", f"0x{topic + 1:02X}"),
        ("{{perf_id}}", str(FIRST_PERF_ID + topic % PERF_IDS)),
    ):
        text = text.replace(key, value)
    return text.encode()


def _topic(name: str) -> int:
    """Return the first of the two topics of an application."""
    return FIRST_TOPIC + 2 * (zlib.crc32(name.encode()) % TOPIC_PAIRS)


def _package(name: str) -> Files:
    """Return apps/sample_app under another name, with message ids and a table of its own."""
    sample = shipped("apps") / "sample_app"
    files: Files = {}
    for source in sorted([*sample.glob("*.py"), *sample.glob("tables/*.py")]):
        if source.stem == LIBRARY:
            continue
        path = source.relative_to(sample).as_posix().replace("sample_app_tbl", name)
        files[f"{name}/{path}"] = _renamed(source.read_text(encoding="utf-8"), name).encode()
    table = image.read((sample / "tables/sample_app_tbl.tbl").read_bytes())
    renamed = table._replace(name=table.name.replace("SAMPLE_APP", name.upper()))
    files[f"{name}/tables/{name}.tbl"] = image.build(renamed)
    return files


def _renamed(text: str, name: str) -> str:
    text = "".join(line for line in text.splitlines(keepends=True) if LIBRARY not in line)
    title = name.replace("_", " ").title()
    topic = _topic(name)
    for old, new in (
        ("the smallest real cFE app: ", "a cFE app: "),
        (" Start here, and copy it.", ""),
        (" (sample_app_eventids.h)", ""),
        ("apps.sample_app.tables.sample_app_tbl", f"{name}.tables.{name}"),
        ("sample_app_tbl", name),
        ("SAMPLE_APP_CMD_PIPE", f"{name.upper()}_PIPE"),
        ("SAMPLE_APP", name.upper()),
        ("SAMPLE APP", title),
        ("SAMPLE:", f"{name.upper()}:"),
        ("SampleApp", title.replace(" ", "")),
        ('VERSION_TEXT = version_string("Sample App", VERSION, "Equuleus", "v1.1.0")\n', ""),
        ("from cfepy.config.versions import version_string\n", ""),
        ("equuleus-rc1+dev54", "v1.0.0"),
        ("Sample App Initialized.{VERSION_TEXT}", f"{title} initialized, version {{VERSION}}"),
        ("Sample App", title),
        ("0x82", f"0x{topic:02X}"),
        ("0x83", f"0x{topic + 1:02X}"),
    ):
        text = text.replace(old, new)
    return text
