"""`python -m benchmarks.message_sizes`: the cost of messages in C++, as the table of docs/reference/roscfe.md.

Code is the compiled length, write and read functions of a message, at -Os, in a separate object file. A node with
several types shares the parts that are equal. Memory is sizeof.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from cfepy.extra.convert.capacities import Capacities
from cfepy.extra.convert.message_headers import Profile, write_headers
from cfepy.reading.resources import shipped as shipped_files
from rospy_shim.types.msgs import shipped
from rospy_shim.types.msgs.spec import BUILTINS

TYPES = (
    *("std_msgs/Empty", "std_msgs/Float64", "std_msgs/String", "std_msgs/Header", "std_msgs/Float64MultiArray"),
    *("geometry_msgs/Twist", "geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped"),
    *("sensor_msgs/Imu", "sensor_msgs/JointState", "sensor_msgs/LaserScan", "sensor_msgs/PointCloud2"),
    *("nav_msgs/Odometry", "nav_msgs/Path", "tf2_msgs/TFMessage", "trajectory_msgs/JointTrajectory"),
    *("diagnostic_msgs/DiagnosticArray", "visualization_msgs/Marker"),
)
COMPILERS = {"x86-64": ("g++",), "ARM": ("arm-linux-gnueabihf-g++",)}
FLAGS = ("-std=c++17", "-Os", "-fno-exceptions", "-fno-rtti", "-fno-asynchronous-unwind-tables")
SIZE = re.compile(r"^\s*\.size\s+size_(\d+),\s*(\d+)", re.MULTILINE)
ITEMS = 8  # capacity of an array of messages
CODE = """
#include <{name}.h>
typedef {cpp} Message;
std::size_t length(const Message &message) {{ return roscfe::wire::length(message); }}
bool write(const Message &message, std::uint8_t *to, std::size_t size)
{{ return roscfe::wire::write(message, to, size); }}
bool read(Message &message, const std::uint8_t *from, std::size_t size)
{{ return roscfe::wire::read(message, from, size); }}
"""


def code_size(name: str, includes: Sequence[Path], compiler: Sequence[str], folder: Path) -> int:
    """Return bytes of code and of read-only data."""
    source, made = folder / "code.cpp", folder / "code.o"
    source.write_text(CODE.format(name=name, cpp=name.replace("/", "::")), encoding="utf-8")
    include = [f"-I{each}" for each in includes]
    subprocess.run([*compiler, *FLAGS, *include, "-c", str(source), "-o", str(made)], check=True)
    size = shutil.which(compiler[0].replace("g++", "size")) or "size"
    table = subprocess.run([size, "-A", str(made)], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in table.splitlines() if line.startswith((".text", ".rodata"))]
    return sum(int(row[1]) for row in rows)


def memory_of(types: Sequence[str], includes: Sequence[Path], compiler: Sequence[str]) -> dict[str, int]:
    """Return sizeof of each type. For another computer, only its compiler knows it."""
    lines = [f"#include <{name}.h>" for name in types]
    lines += [
        f'extern "C" {{ char size_{number}[sizeof({name.replace("/", "::")})]; }}' for number, name in enumerate(types)
    ]
    command = [*compiler, *FLAGS, *(f"-I{folder}" for folder in includes), "-S", "-x", "c++", "-", "-o", "-"]
    done = subprocess.run(command, input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return {types[int(number)]: int(size) for number, size in SIZE.findall(done.stdout)}


def capacities() -> Capacities:
    """Return the default capacities, and `ITEMS` for each array of messages."""
    library = shipped()
    names = [f"{package}/{name}" for package in library.packages() for name in library.names(package) or ()]
    arrays = [(name, each) for name in names for each in library.spec(name).fields if each.is_array]
    return Capacities({f"{name}.{each.name}": ITEMS for name, each in arrays if each.base not in BUILTINS})


def table() -> str:
    """Return the table, a type in a row."""
    columns = [(target, profile) for target in COMPILERS for profile in (Profile.HOST, Profile.STRICT)]
    cells: dict[str, list[str]] = {name: [] for name in TYPES}
    headers = shipped_files("roscfe")
    for target, profile in columns:
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            write_headers(TYPES, folder, profile, shipped(), capacities())
            includes = [folder, headers / "include", headers / "boost"]
            memory = memory_of(TYPES, includes, COMPILERS[target])
            for name in TYPES:
                cells[name].append(f"{code_size(name, includes, COMPILERS[target], folder):,} / {memory[name]:,}")
            print(f"{target}, {profile}", file=sys.stderr)
    titles = ["type", *(f"{target}, {profile}" for target, profile in columns)]
    lines = [f"| {' | '.join(titles)} |", "|---" * len(titles) + "|"]
    lines += [f"| {name} | {' | '.join(row)} |" for name, row in cells.items()]
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
