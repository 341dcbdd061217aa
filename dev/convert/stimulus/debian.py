"""A node with Debian's roscpp: built unchanged, and run beside a driver and its own master.

It needs libroscpp-dev, the libraries that the node uses, python3-gencpp, python3-rospy and python3-rosmaster. Debian
packages that are not installed may be in a folder that CFEPY_ROS_ROOT names, as `dpkg -x` unpacks them.
"""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy

from cfepy.extra.convert.build import library_includes
from cfepy.extra.convert.configurations import configuration_script
from cfepy.extra.convert.cpp_package import Program
from cfepy.extra.convert.cpp_sources import collect, message_types
from dev.convert.stimulus.outcome import Outcome, outcome_of
from dev.convert.stimulus.script import Scene
from dev.roscfe.building import CPP
from dev.roscfe.probing import master
from rospy_shim.types.msgs import Library

PYTHON = "/usr/bin/python3"
HERE = Path(__file__).parent
ROOT = Path(os.environ.get("CFEPY_ROS_ROOT", "/"))
ROOTS = [Path("/usr"), ROOT / "usr"]
TRIPLET = "x86_64-linux-gnu"
FLAGS = ("-std=c++17", "-w", "-DBOOST_BIND_GLOBAL_PLACEHOLDERS", "-include", "boost/bind.hpp")
"""roscpp of ROS Noetic brings the names _1, _2 along, and nodes rely on it."""
LIBRARIES = (
    "roscpp",
    "rosconsole",
    "rostime",
    "roscpp_serialization",
    "xmlrpcpp",
    "tf",
    "tf2",
    "tf2_ros",
    "actionlib",
    "message_filters",
    "roslib",
    "diagnostic_updater",
    "interactive_markers",
    "nodeletlib",
    "bondcpp",
    "class_loader",
    "console_bridge",
    "topic_tools",
    "laser_geometry",
    "tf_conversions",
    "eigen_conversions",
    "dynamic_reconfigure_config_init_mutex",
    "boost_thread",
    "boost_system",
    "boost_chrono",
    "pthread",
)
OWN_FOLDERS = ("xmlrpcpp", "angles", "pluginlib", "class_loader", "rcpputils", "rcutils")
"""Folders of headers that packages of ROS export, below the one for all."""
NODELET = """
#include <class_loader/class_loader_core.hpp>
#include <nodelet/nodelet.h>
#include <ros/ros.h>

int main(int argc, char **argv)
{
    ros::init(argc, argv, "nodelet");
    ros::NodeHandle nh;
    auto *made = class_loader::impl::createInstance<nodelet::Nodelet>("TYPE", nullptr);
    made->init(ros::this_node::getName(), ros::names::getRemappings(), nodelet::V_string());
    ros::spin();
}
"""
"""A nodelet by itself, as `nodelet standalone` has it, but for the search for its library."""
OLD_PLUGINS = """
#include <pluginlib/class_list_macros.hpp>

#define PLUGINLIB_DECLARE_CLASS(package, name, type, base) PLUGINLIB_EXPORT_CLASS(type, base)
"""
"""Debian has the new names alone."""
FORMAT = "[${severity}] [${time}]: ${message}"
LONGEST_S = 40.0
SHUTDOWN_S = 6.0
BASES = ("dynamic_reconfigure",)
TEMPLATES = ROOT / "usr/share/dynamic_reconfigure"


class NotBuilt(Exception):
    """A node that cannot be built with Debian's roscpp. The text gives the reason."""


class RoscppNode:
    """A node as a program of Debian's roscpp.

    Args:
        program: its sources.
        library: of message types.
        folder: for all that is made.
    """

    def __init__(self, program: Program, library: Library, folder: Path) -> None:
        self._program = program
        self._library = library
        self._folder = folder
        self.made = folder / "node"

    def build(self) -> None:
        """Compile and link it.

        Raises:
            NotBuilt: the compiler or a generator refuses something.
        """
        sources = collect(self._program.sources, [*self._program.includes, *library_includes()])
        types = message_types(sources.missing, self._library)
        scripts = {configuration_script(each, self._program) for each in sources.missing} - {None}
        packages = sorted({*self._with_nested(types), *(BASES if scripts else ())})
        self.generate(packages)
        made_to = self._folder / "cpp" / self._program.package.name
        for script in scripts:
            made_to.mkdir(parents=True, exist_ok=True)
            self._call([PYTHON, str(script), str(TEMPLATES), *[str(made_to)] * 3])
        includes = [*self._program.includes, self._folder / "cpp"]
        system = [root / "include" for root in ROOTS if root != Path("/usr")]
        system += [root / "include" / name for root in ROOTS for name in OWN_FOLDERS]
        flags = [*FLAGS, *(f"-D{each}" for each in self._program.definitions), *(f"-I{each}" for each in includes)]
        flags += [f"-isystem{each}" for each in system]
        old = self._folder / "cpp/pluginlib/class_list_macros.h"
        old.parent.mkdir(parents=True, exist_ok=True)
        old.write_text(OLD_PLUGINS, encoding="utf-8")
        objects = []
        added = []
        if self._program.nodelet:
            added.append(self._folder / "nodelet_main.cpp")
            added[0].write_text(NODELET.replace("TYPE", self._program.nodelet), encoding="utf-8")
        for source in [*self._program.sources, *added]:
            objects.append(self._folder / f"{hashlib.sha256(bytes(source)).hexdigest()[:12]}.o")
            self._call([*CPP, *flags, "-c", str(source), "-o", str(objects[-1])])
        linked = [str(file) for name in LIBRARIES if (file := library_file(name)) is not None]
        found = [*map(str, objects), "-Wl,--as-needed,--allow-shlib-undefined", *linked]
        self._call([*CPP, *found, "-o", str(self.made)])

    def generate_of(self, types: list[str]) -> None:
        """Make the messages of types that the driver needs."""
        self.generate(sorted({*self._with_nested(types)}))

    def generate(self, packages: list[str]) -> None:
        """Generate code for messages of packages that Debian does not have, for C++ and for Python."""
        job: dict[str, Any] = {"include": {}, "cpp": [], "python": []}
        for package in packages:
            job["include"][package] = [str(self._definitions(package))]
            if not any(self._has(f"include/{package}/{name}.h") for name in self._names(package)):
                job["cpp"].append(package)
            if not self._has(f"lib/python3/dist-packages/{package}/msg/__init__.py") and not self._has(
                f"lib/python3/dist-packages/{package}/srv/__init__.py"
            ):
                job["python"].append(package)
        job |= {"to_cpp": str(self._folder / "cpp"), "to_python": str(self._folder / "python")}
        file = self._folder / "job.json"
        file.write_text(json.dumps(job), encoding="utf-8")
        self._call([PYTHON, str(HERE / "generate.py"), str(file)])

    def _names(self, package: str) -> list[str]:
        return [*(self._library.names(package) or ()), *(self._library.names(package, "srv") or ())]

    def _definitions(self, package: str) -> Path:
        folder = self._folder / "definitions" / package
        folder.mkdir(parents=True, exist_ok=True)
        for name in self._library.names(package) or ():
            (folder / f"{name}.msg").write_text(self._library.text(f"{package}/{name}"), encoding="utf-8")
        for name in self._library.names(package, "srv") or ():
            (folder / f"{name}.srv").write_text(self._library.text(f"{package}/{name}", "srv"), encoding="utf-8")
        return folder

    def _with_nested(self, types: list[str]) -> Iterator[str]:
        """Yield the packages of types, and of all that their packages' types are made of."""
        waiting, known = [each.partition("/")[0] for each in types], set()
        for package in waiting:
            if package in known:
                continue
            known.add(package)
            yield package
            for name in self._library.names(package) or ():
                waiting += [each.partition("/")[0] for each in self._library.spec(f"{package}/{name}").message_types]
            for name in self._library.names(package, "srv") or ():
                for part in ("Request", "Response"):
                    spec = self._library.spec(f"{package}/{name}{part}")
                    waiting += [each.partition("/")[0] for each in spec.message_types]

    def _has(self, path: str) -> bool:
        return any((root / path).is_file() for root in ROOTS)

    def _call(self, command: list[str]) -> None:
        done = subprocess.run(["nice", *command], capture_output=True, text=True, check=False, env=environment())
        if done.returncode:
            errors = [line for line in done.stderr.splitlines() if "error" in line or "undefined" in line]
            raise NotBuilt("; ".join(errors[:3] or done.stderr.splitlines()[-3:]))

    # -- running it ------------------------------------------------------------------------------------------------

    def run(self, script: Mapping[str, Any], scene: Scene) -> Outcome:
        """Run it beside the driver.

        Args:
            script: script of the driver.
            scene: the environment that the node needs.
        """
        (self._folder / "script.json").write_text(json.dumps(script), encoding="utf-8")
        told = self._folder / "driver.out"
        with master(self._folder) as given:
            environ = {**given, **environment(self._folder / "python"), "ROSCONSOLE_FORMAT": FORMAT}
            environ.pop("ROS_NAMESPACE")
            server = ServerProxy(given["ROS_MASTER_URI"])
            for name, value in scene.params.items():
                server.setParam("/stimulus", name.replace("~", "/node/"), value)
            command = [PYTHON, "-P", str(HERE / "driver.py"), str(self._folder / "script.json")]
            with told.open("wb") as out, (self._folder / "node.out").open("wb") as printed:
                driver = subprocess.Popen(command, env=environ, stdout=out, stderr=subprocess.STDOUT)
                _until(lambda: "ready" in told.read_text(encoding="utf-8") or driver.poll() is not None, LONGEST_S)
                begun_ns = time.time_ns()
                words = ["stdbuf", "-oL", "-eL", str(self.made), "__name:=node", *scene.args.split()]
                node = subprocess.Popen(
                    words, env=environ, stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.STDOUT
                )
                _until(lambda: driver.poll() is not None, LONGEST_S)
                status = node.poll()
                for process, how in ((driver, signal.SIGKILL), (node, signal.SIGINT)):
                    if process.poll() is None:
                        process.send_signal(how)
                if not _until(lambda: node.poll() is not None, SHUTDOWN_S):
                    node.kill()
                    node.wait()
        rows = told.read_text(errors="replace", encoding="utf-8").splitlines()
        lines = (self._folder / "node.out").read_text(errors="surrogateescape", encoding="utf-8").splitlines()
        return outcome_of(rows, lines, self._library, None if status is None else bool(status), begun_ns)


def library_file(name: str) -> Path | None:
    """Return the path of a library. An unpacked package for compilers only has a link to the installed library."""
    places = (file for root in ROOTS for file in sorted((root / "lib" / TRIPLET).glob(f"lib{name}.so*")))
    return next((file for file in places if file.is_file()), None)


def environment(more: Path | None = None) -> dict[str, str]:
    """Return the environment of programs of Debian's ROS."""
    paths = [*([more] if more else []), *(root / "lib/python3/dist-packages" for root in ROOTS[1:])]
    libraries = [root / "lib" / TRIPLET / inner for root in ROOTS[1:] for inner in ("", "blas", "lapack")]
    return {
        "HOME": os.environ.get("HOME", "/"),
        "PATH": "/usr/bin:/bin",
        "PYTHONPATH": os.pathsep.join(map(str, paths)),
        "LD_LIBRARY_PATH": os.pathsep.join(map(str, libraries)),
    }


def _until(over: Any, seconds: float) -> bool:
    end = time.monotonic() + seconds
    while not over() and time.monotonic() < end:
        time.sleep(0.05)
    return bool(over())
