"""interface_library.md, nodes in C++: the names of its tables are in the headers and in rospy."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import cpp_compiler
from cfepy.extra.convert.build import LANGUAGE, library_includes
from cfepy.extra.convert.message_headers import Profile, write_headers
from rospy_shim.types.msgs import shipped
from tests.ros_libraries.world import universe

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/reference/interface_library.md").read_text(encoding="utf-8")
INCLUDE = ROOT / "roscfe/include"
OF_FUNCTIONS = {"MinMax": "tfMin(1, 2)", "Scalar": "tfScalar(1)"}
"""Headers of LinearMath without a class of their own, and something that they have."""
PAPER = {
    "functions": "init Time::now ok Rate::sleep Duration::sleep spinOnce spin NodeHandle NodeHandle::subscribe"
    " NodeHandle::advertise Publisher::publish",
    "messages": "Header Float64MultiArray MultiArrayLayout MultiArrayDimension Wrench WrenchStamped Pose PoseStamped"
    " PoseWithCovarianceStamped Point Twist TwistWithCovariance Vector3 Odometry JointState",
    "linear math": "Matrix3x3 MinMax QuadWord Quaternion Scalar StampedTransform Transform Vector3",
}


def rows(table: str) -> list[list[str]]:
    """Return the rows of a table of the page, without backquotes."""
    text = PAGE.partition(f"<!-- {table} -->")[2].partition(f"<!-- end of {table} -->")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in lines[2:]]


@pytest.mark.parametrize("table", PAPER)
def test_table_has_no_missing_row(table: str) -> None:
    assert set(PAPER[table].split()) - {row[0].removeprefix("ros::") for row in rows(table)} == set()


@pytest.mark.parametrize("row", rows("functions"), ids=lambda row: row[0])
def test_function_is_in_its_header_and_uses_the_listed_calls(row: list[str]) -> None:
    name, header, _, calls = row
    word = name.rpartition("::")[2]
    assert re.search(rf"\b{word}\b", (INCLUDE / header).read_text(encoding="utf-8"))
    sources = "".join(each.read_text(encoding="utf-8") for each in (ROOT / "roscfe/src").rglob("*.cpp"))
    assert [call for call in re.findall(r"\b(?:CFE|OS)_\w+[a-z]\w*", calls) if call not in sources] == []


@pytest.mark.parametrize("row", rows("messages"), ids=lambda row: row[0])
def test_message_exists_for_python(row: list[str]) -> None:
    name, header, python = row
    package = header.partition("/")[0]
    assert python == f"{package}.msg.{name}"
    assert shipped().message_class(f"{package}/{name}").__name__ == name


@pytest.mark.parametrize("row", rows("linear math"), ids=lambda row: row[0])
def test_linear_math_exists_for_python(row: list[str]) -> None:
    name, _, python = row
    module = universe().importer.load(python)
    assert hasattr(
        module, name if name not in OF_FUNCTIONS else {"MinMax": "tfMin", "Scalar": "tfNormalizeAngle"}[name]
    )


@pytest.mark.slow
def test_functions_exist_for_nodes_in_python(tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    names = [row[2] for row in rows("functions") if row[2]]
    script.write_text("import rospy\n" + "".join(f"assert callable({name})\n" for name in names), encoding="utf-8")
    assert main(["node", str(script)]) == 0


def included_messages() -> list[str]:
    """Types of messages that the library's own headers of transforms include."""
    texts = [file.read_text(encoding="utf-8") for folder in library_includes() for file in Path(folder).glob("tf*/*.h")]
    return sorted({each for text in texts for each in re.findall(r"#include <(\w+_msgs/[A-Z]\w*)\.h>", text)})


@pytest.mark.slow
def test_types_exist_in_the_headers(tmp_path: Path) -> None:
    messages, maths = rows("messages"), rows("linear math")
    types = [header.removesuffix(".h") for _, header, _ in messages]
    write_headers([*types, *included_messages()], tmp_path / "messages", Profile.HOST, shipped())
    lines = [f"#include <{header}>" for _, header, _ in (*messages, *maths)]
    lines += [f"const {each.replace('/', '::')} message_{at}{{}};" for at, each in enumerate(types)]
    lines += [
        f"const auto math_{at} = {OF_FUNCTIONS[name]};" if name in OF_FUNCTIONS else f"typedef tf::{name} Math{at};"
        for at, (name, _, _) in enumerate(maths)
    ]
    source = tmp_path / "all.cpp"
    source.write_text("\n".join(lines) + "\n", encoding="utf-8")
    folders = [f"-I{each}" for each in (tmp_path / "messages", *library_includes())]
    flags = [*LANGUAGE, "-DROSCFE_PROFILE_HOST", "-fsyntax-only"]
    done = subprocess.run([*cpp_compiler(), *flags, *folders, str(source)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
