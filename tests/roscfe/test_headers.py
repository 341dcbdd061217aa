"""The headers of the interface library compile alone; Boost headers that it lacks are refused."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from cfepy.extra.convert.build import BOOST_REFUSED
from cfepy.extra.convert.cpp_sources import collect
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import FLIGHT_FLAGS, ROSCFE, STRICT_FLAGS, compile_program, complaints, needs_cpp
from dev.roscfe.random_messages import LIBRARY, all_types, capacities

pytestmark = [pytest.mark.slow, needs_cpp]
BOOST = sorted(
    str(each.relative_to(ROSCFE / name)) for name in ("boost", "threads") for each in (ROSCFE / name).rglob("*.hpp")
)
NO_THREADS = (
    "interruption",
    "thread_only",
    "thread_group",
    "condition_variable",
    "condition",
    "barrier",
    "shared_mutex",
)
"""Headers of Boost that only nodes for the host have."""
LACKING = ("asio", "variant", "regex", "filesystem", "date_time", "format", "optional", "tuple/tuple", "any")
NO_SERIALIZER = "specialise ros::serialization::Serializer for it"
DECLARED = re.compile(r"^(?:template <.*>\n)?(?:\[\[\w+\]\] )?[\w:<>*& ]+?[ *&](\w+)\(", re.MULTILINE)
"""A function of the library, whose declaration begins a line."""
USED = re.compile(r"\broscfe::(\w+)\(")
DEPTHS = """
#include <depth_image_proc/depth_traits.h>
#include <cstdio>
#include <vector>
typedef depth_image_proc::DepthTraits<std::uint16_t> Millimeters;
typedef depth_image_proc::DepthTraits<float> Meters;
int main()
{
    std::vector<unsigned char> buffer(8);
    Millimeters::initializeBuffer(buffer);
    float first;
    std::memcpy(&first, buffer.data(), 4);
    std::printf("%d %d %g %d %g\\n", Millimeters::valid(0), Millimeters::valid(1), Millimeters::toMeters(1500),
                Millimeters::fromMeters(0.2506f), first);
    Meters::initializeBuffer(buffer);
    std::memcpy(&first, &buffer[4], 4);
    std::printf("%d %d %g %g\\n", Meters::valid(first), Meters::valid(0.5f), Meters::toMeters(2),
                Meters::fromMeters(3));
}
"""
OWN = """
#include "roscfe/message.h"
struct Own { int a; };
"""


@pytest.mark.parametrize("header", BOOST)
def test_header_of_boost_compiles_alone_or_is_refused(tmp_path: Path, header: str) -> None:
    said = complaints(tmp_path, f"#include <{header}>\n" * 2, "-DROSCFE_PROFILE_STRICT")
    if Path(header).name in BOOST_REFUSED:
        assert "[library-outside]" in said
    elif Path(header).stem in NO_THREADS:
        assert "[thread]" in said
        assert not complaints(tmp_path, f"#include <{header}>\n" * 2, base=STRICT_FLAGS)
    else:
        assert not said


@pytest.mark.parametrize("name", LACKING)
def test_unsupported_header_of_boost_is_refused(tmp_path: Path, name: str) -> None:
    said = complaints(tmp_path, f"#include <boost/{name}.hpp>\n")
    assert "[library-outside]" in said or "No such file" in said


@pytest.mark.parametrize("base", [FLIGHT_FLAGS, STRICT_FLAGS], ids=["flight", "host"])
@pytest.mark.parametrize(
    "name",
    [
        *("ros/time", "ros/duration", "ros/exception", "ros/message_forward", "ros/message_operations"),
        *("ros/message_traits", "ros/builtin_message_traits", "ros/serialization", "ros/serialized_message"),
        *("ros/service_traits", "roscfe/wire", "roscfe/fixed", "roscfe/message"),
    ],
)
def test_header_of_messages_compiles_alone(tmp_path: Path, name: str, base: tuple[str, ...]) -> None:
    assert not complaints(tmp_path, f'#include "{name}.h"\n' * 2, base=base)


def test_header_includes_the_declarations_of_the_functions_that_it_calls() -> None:
    """A node may include it alone, and a template that calls a function needs its declaration before."""
    folder = ROSCFE / "include"
    declared: dict[str, set[Path]] = {}
    for header in sorted((folder / "roscfe").rglob("*.h")):
        for name in DECLARED.findall(header.read_text(encoding="utf-8")):
            declared.setdefault(name, set()).add(header)
    for header in sorted(folder.rglob("*.h")):
        reached = collect([header], [folder, ROSCFE / "threads", ROSCFE / "boost"]).contents
        for name in USED.findall(header.read_text(encoding="utf-8")):
            assert not declared.get(name, set()).isdisjoint(reached) or name not in declared, (header, name)


def test_depths_are_millimeters_or_meters(tmp_path: Path) -> None:
    source = tmp_path / "depths.cpp"
    source.write_text(DEPTHS, encoding="utf-8")
    made = compile_program(tmp_path / "depths", [source])
    assert subprocess.check_output([made], text=True) == "0 1 1.5 251 0\n0 1 2 3\n"


def test_linear_math_has_the_include_guards_used_by_nodes(tmp_path: Path) -> None:
    asked = ("TF_SCALAR_H", "TF_MATRIX3x3_H", "TF2_SCALAR_H", "TF2_MATRIX3x3_H")
    lines = "".join(f"#ifndef {guard}\n#error {guard}\n#endif\n" for guard in asked)
    assert not complaints(
        tmp_path, f"#include <tf/LinearMath/Transform.h>\n#include <tf2/LinearMath/Transform.h>\n{lines}"
    )


@pytest.mark.parametrize("profile", [Profile.HOST, Profile.STRICT])
def test_all_messages_compile_in_one_file(tmp_path: Path, profile: Profile) -> None:
    services = [f"{package}/{name}" for package in LIBRARY.packages() for name in LIBRARY.names(package, "srv") or ()]
    made = write_headers([*all_types(), *services], tmp_path, profile, LIBRARY, capacities())
    assert len(made) > 1200
    names = ("DEBUG", "ERROR", "NAN", "INFINITY", "OK", "FATAL", "TRUE")
    macros = "".join(f"#undef {name}\n#define {name} (nothing)\n" for name in names)  # as platforms have them
    text = macros + "".join(f"#include <{path.relative_to(tmp_path)}>\n" for path in made)
    assert not complaints(tmp_path, text, f"-I{tmp_path}")


@pytest.mark.parametrize(
    ("use", "said"),
    [
        ("roscfe::wire::length(Own())", NO_SERIALIZER),
        ("ros::serialization::serializationLength(Own())", NO_SERIALIZER),
        ("roscfe::wire::Traits<Own>::md5()", "no message: specialise ros::message_traits::MD5Sum for it"),
        ("ros::message_traits::datatype<Own>()", "no message: specialise ros::message_traits::DataType for it"),
        ("ros::message_traits::hasHeader<Own>()", ""),
    ],
)
def test_type_that_is_not_a_message_is_refused(tmp_path: Path, use: str, said: str) -> None:
    text = complaints(tmp_path, f"{OWN}\nauto made = {use};\n")
    assert said in text if said else not text
