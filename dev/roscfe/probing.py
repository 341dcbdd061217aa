"""Small nodes of roscpp (folder tests/roscfe/probes): their output on cfepy, compared with Debian's roscpp.

`python -m dev.roscfe.probing [NAME...] [--record]` flies probes and runs them with the roscpp of this computer
(libroscpp-dev, python3-roscore; python3-rospy for probes with a partner), and shows how their output differs.
`--record` writes roscpp's output into probes/NAME.txt, which the tests compare with.
"""

from __future__ import annotations

import argparse
import difflib
import os
import socket
import subprocess
import tempfile
import time
import xmlrpc.client
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

from cfepy.extra.convert import build_for_flight
from cfepy.mission import Mission
from cfepy.mission.launch import read_launch
from cfepy.writing.console import Console
from dev.host_ports import free_port
from dev.roscfe.building import compile_program

PROBES = Path(__file__).parents[2] / "tests/roscfe/probes"
NAMES = sorted(each.stem for each in PROBES.glob("*.cpp"))
MARK = "P| "
"""Begins each line that counts."""
PARTNER = "py "
"""Begins what is behind the mark in a line of a probe's partner: a node in Python of the same name, NAME.py."""
NO_COLOR = "\x1b[0m"
"""What rosconsole puts behind a line."""
REMAPS = {"from": "to", "chatter": "/talk"}
SECONDS = 30.0
SIMULATED = ("sim_time",)
"""Probes whose time is that of /clock."""
HANGING = ("waits",)
"""Probes that hang at their end on a robot, and have to be ended."""
HANGING_S = 10.0
"""How long they run with roscpp, in seconds of wall time."""
ROS_PYTHON = "/usr/bin/python3"
"""The interpreter that has Debian's rospy (python3-rospy)."""
LIBRARIES = (
    *("-lroscpp", "-lrosconsole", "-lrostime", "-lroscpp_serialization", "-lxmlrpcpp"),
    *("-lactionlib", "-lboost_thread"),
)
MORE_LIBRARIES = {
    "approximate": ("-lmessage_filters",),
    "filters": ("-ltf2_ros", "-ltf2", "-lmessage_filters"),
    "queues": ("-lmessage_filters",),
    "clouds": ("-linteractive_markers", "-llaser_geometry", "-ltf", "-ltf2"),
    "shapes": ("-ltopic_tools",),
}
"""Of probes that need more of ROS than others."""
MANIFEST = """<package format="2"><name>probes</name><version>1.0.0</version><description>probes</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend></package>
"""


def fly(name: str, folder: Path) -> list[str]:
    """Return the output of a probe on cfepy.

    Args:
        name: name of the probe.
        folder: an empty folder.
    """
    package = folder / "probes"
    package.mkdir()
    (package / "package.xml").write_text(MANIFEST, encoding="utf-8")
    (package / f"{name}.cpp").write_bytes((PROBES / f"{name}.cpp").read_bytes())
    (package / "CMakeLists.txt").write_text(f"project(probes)\nadd_executable({name} {name}.cpp)\n", encoding="utf-8")
    remaps = "".join(f'<remap from="{one}" to="{other}"/>' for one, other in REMAPS.items())
    launch = package / "probe.launch"
    node = f'<node pkg="probes" type="{name}" name="probe" output="screen">{remaps}</node>'
    if (PROBES / f"{name}.py").is_file():
        (package / f"{name}.py").write_bytes((PROBES / f"{name}.py").read_bytes())
        node += f'<node pkg="probes" type="{name}.py" name="partner" output="screen"/>'
    time = '<param name="/use_sim_time" value="true"/>' if name in SIMULATED else ""
    launch.write_text(f'<launch>{time}<group ns="probes">{node}</group></launch>\n', encoding="utf-8")
    with patch.dict(os.environ, {"ROS_PACKAGE_PATH": str(folder)}):
        spec = read_launch(launch, {}, build_for_flight)
    assert not spec.notes, spec.notes
    with Mission(spec, console=Console(quiet=True)) as mission:
        mission.run_for(SECONDS)
        return probe_first(marked(mission.console.lines))


def probe_first(lines: Iterable[str]) -> list[str]:
    """Return the lines of a probe, then its partner's, which may arrive at any time between them."""
    return sorted(lines, key=lambda line: line.startswith(PARTNER))


def marked(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines that count, from the mark on."""
    for line in lines:
        before, mark, rest = line.partition(MARK)
        if mark and not before.startswith("EVS"):  # warnings are events, too
            yield rest.removesuffix(NO_COLOR).rstrip()


# -- beside Debian's roscpp --------------------------------------------------------------------------------------------


@contextmanager
def master(folder: Path) -> Iterator[dict[str, str]]:
    """Run a ROS master on its own port while the block runs. Yields the environment of its nodes.

    Args:
        folder: folder for the logs of ROS.
    """
    port = free_port()
    environ = {
        **os.environ,
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_LOG_DIR": str(folder),
        "ROS_NAMESPACE": "/probes",
        "ROSCONSOLE_FORMAT": "${severity} ${message}",
    }
    command = ["rosmaster", "--core", "-p", str(port)]
    running = subprocess.Popen(command, env=environ, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while running.poll() is None:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.05)
        yield environ
    finally:
        running.terminate()
        running.wait()


def run_with_roscpp(name: str, folder: Path, environ: dict[str, str]) -> list[str]:
    """Return the output of a probe with Debian's roscpp.

    Args:
        name: name of the probe.
        folder: folder for the program.
        environ: environment from `master`.
    """
    made = folder / name
    libraries = (*MORE_LIBRARIES.get(name, ()), *LIBRARIES)
    compile_program(made, [PROBES / f"{name}.cpp"], base=("-std=c++17",), include=(), libraries=libraries)
    remaps = [f"{one}:={other}" for one, other in REMAPS.items()]
    commands = [["stdbuf", "-oL", str(made), "__name:=probe", *remaps]]
    if (PROBES / f"{name}.py").is_file():
        commands.append([ROS_PYTHON, "-u", str(PROBES / f"{name}.py"), "__name:=partner"])
    xmlrpc.client.ServerProxy(environ["ROS_MASTER_URI"]).setParam("/probing", "/use_sim_time", name in SIMULATED)
    running = [
        subprocess.Popen(each, env=environ, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) for each in commands
    ]
    if name in HANGING:
        time.sleep(HANGING_S)
        for each in running:
            assert each.poll() is None, "a probe of HANGING has ended by itself"
            each.kill()
    said = [each.communicate(timeout=60)[0].decode("utf-8", "replace") for each in running]
    return probe_first(marked("".join(said).splitlines()))


def main() -> None:
    """Compare probes, or record them."""
    parser = argparse.ArgumentParser(prog="python -m dev.roscfe.probing", description=__doc__)
    parser.add_argument("names", nargs="*", default=NAMES, metavar="NAME")
    parser.add_argument("--record", action="store_true", help="keep the output of roscpp's programs")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch, master(Path(scratch)) as environ:
        for name in arguments.names:
            folder = Path(scratch) / f"of_{name}"
            folder.mkdir()
            theirs = run_with_roscpp(name, folder, environ)
            if arguments.record:
                (PROBES / f"{name}.txt").write_text("\n".join(theirs) + "\n", encoding="utf-8")
            ours = fly(name, folder)
            print(f"{name}: {len(theirs)} lines, {'equal' if ours == theirs else 'different'}")
            for line in difflib.unified_diff(theirs, ours, "roscpp", "cfepy", lineterm="", n=1):
                print(line)


if __name__ == "__main__":
    main()
