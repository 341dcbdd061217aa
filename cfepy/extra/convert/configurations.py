"""C++ headers of configurations, `#include <my_package/MyConfig.h>`, made from the package's cfg/My.cfg.

As in a catkin build the script is run, by a separate Python, with cfepy's `dynamic_reconfigure`.
"""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from cfepy.extra.convert.cpp_package import Program
from cfepy.extra.convert.entry import quoted
from cfepy.reading.resources import import_path, python_command
from cfepy.status import UsageError
from rospy_shim.library_parts import FOLDER

SUFFIX = "Config.h"
CONFIGURATION_TYPES = ("dynamic_reconfigure/Config", "dynamic_reconfigure/ConfigDescription")
"""Message types that every configuration includes."""
_TIMEOUT_S = 60
_C_TYPES = {"int": "int", "double": "double", "bool": "bool", "str": "std::string"}
_PARAMETER_TYPES = {**_C_TYPES, "str": "const char *"}
_RUN = """
import json, sys, types
folder, file, name = sys.argv[1:]
package = types.ModuleType("dynamic_reconfigure")
package.__path__ = [folder]
sys.modules["dynamic_reconfigure"] = package
from dynamic_reconfigure.parameter_generator_catkin import ParameterGenerator
sys.argv = [file]
try:
    exec(compile(open(file, encoding="utf-8").read(), file, "exec"), {"__name__": "__main__", "__file__": file})
except SystemExit:
    pass
generator = ParameterGenerator.generated.get(name)
if generator is None:
    sys.exit(f'it did not call generate(..., ..., "{name}")')
json.dump({"group": generator.group.to_dict(), "constants": generator.constants}, sys.stdout)
"""


def configuration_headers(headers: Iterable[str], program: Program) -> dict[str, str]:
    """Return the texts of the included headers for configurations of a node's own package.

    Args:
        headers: names as included, such as "my_package/MyConfig.h".
        program: the node's.

    Returns:
        Texts by header.

    Raises:
        UsageError: a script failed.
    """
    made = {}
    for header in headers:
        script = configuration_script(header, program)
        if script is not None:
            made[header] = header_text(program.package.name, script.stem, _description(script, script.stem))
    return made


def configuration_script(header: str, program: Program) -> Path | None:
    """Return the script that a configuration's header is generated from.

    Returns None if it is another header, or if the package has no such script.
    """
    package, slash, name = header.partition("/")
    stem = name.removesuffix(SUFFIX)
    if package != program.package.name or not slash or not name.endswith(SUFFIX) or not stem.isidentifier():
        return None
    script = program.package.folder / "cfg" / f"{stem}.cfg"
    return script if os.path.isfile(script) else None


def _description(script: Path, name: str) -> dict[str, Any]:
    """Run a script. Returns its description: its outermost group and its constants."""
    command = [*python_command(), "-c", _RUN, str(FOLDER / "dynamic_reconfigure"), str(script), name]
    environ = {**os.environ, "PYTHONPATH": import_path()}
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=environ, timeout=_TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        raise UsageError(f"did not end within {_TIMEOUT_S} s", file=script) from None
    if done.returncode:
        raise UsageError(f"failed: {(done.stderr.strip().splitlines() or ['no output'])[-1]}", file=script)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def header_text(package: str, name: str, description: Mapping[str, Any]) -> str:
    """Return the header of a configuration.

    Args:
        package: its package.
        name: without "Config".
        description: "group", the outermost one as ParameterGenerator has it, and "constants".
    """
    return "\n".join(_lines(package, name, description)) + "\n"


def _lines(package: str, name: str, description: Mapping[str, Any]) -> Iterator[str]:
    config = f"{name}Config"
    groups = list(_inside_out(description["group"]))
    number = {group["id"]: index for index, group in enumerate(groups)}
    outside_in = list(_outside_in(description["group"], "groups"))
    parameters = [(each, number[group["id"]]) for group, _ in outside_in for each in group["parameters"]]
    guard = f"ROSCFE_{package}_{config}_H".upper()
    yield f"// Made by cfepy from cfg/{name}.cfg of the package {package}."
    yield from (f"#ifndef {guard}", f"#define {guard}", "", "#include <string>", "")
    yield from ('#include "roscfe/configuration.h"', "", f"namespace {package}", "{", "", f"class {config}", "{")
    yield "  public:"
    for each, _ in parameters:
        yield f"    {_C_TYPES[each['type']]} {each['name']};"
    yield from ("", *_group_members(description["group"], "groups"))
    yield from ("", f"    {config}()", "    {", "        visit(roscfe::configuration::SetDefaults(), *this);")
    yield from ("        fill_groups();", "    }", "")
    yield from _visitors(config, parameters)
    yield from ("    template <class V>", f"    static void visit_groups(V visitor, {config} &config)", "    {")
    yield from (f"        visitor(config.{place}.state, {_group(group)});" for group, place in outside_in)
    yield from ("    }", "")
    yield from ("    static int group_count() { return " + f"{len(groups)}; }}",)
    yield "    static const roscfe::ConfigGroup *groups_of()"
    yield "    {"
    yield "        static const roscfe::ConfigGroup groups[] = {"
    yield from (f"            {_group(group)}," for group in groups)
    yield from ("        };", "        return groups;", "    }", "")
    yield from (
        "    void __fromServer__(const ros::NodeHandle &node)",
        "    {",
        "        static bool is_first = true;",
        "        visit(roscfe::configuration::FromServer{node}, *this);",
        "        if (is_first)",
        "        {",
        "            is_first = false;",
        "            visit_groups(roscfe::configuration::InitialState(), *this);",
        "        }",
        "    }",
        "    void __toServer__(const ros::NodeHandle &node) const",
        "    {",
        f"        {config} copy = *this;",
        "        visit(roscfe::configuration::ToServer{node}, copy);",
        "    }",
        "    void __clamp__()",
        "    {",
        "        visit(roscfe::configuration::Clamp(), *this);",
        "        fill_groups();",
        "    }",
        f"    std::uint32_t __level__(const {config} &other) const",
        "    {",
        f"        {config} one = *this, another = other;",
        "        return roscfe::configuration::levels_between(one, another);",
        "    }",
        "    bool __fromMessage__(const dynamic_reconfigure::Config &message)",
        "    {",
        f"        return roscfe::configuration::take(message, *this, {quoted(config)});",
        "    }",
        "    void __toMessage__(dynamic_reconfigure::Config &message) const",
        "    {",
        "        message = roscfe::configuration::message_of(*this);",
        "    }",
        f"    static {config} __getDefault__() {{ return {config}(); }}",
        "",
        "  private:",
        "    // Groups have their parameters once more.",
        "    void fill_groups()",
        "    {",
        *(f"        {at}.{each['name']} = {each['name']};" for group, at in outside_in for each in group["parameters"]),
        "    }",
        "};",
        "",
    )
    for each in description["constants"]:
        yield from _constant(name, each)
    yield from (f"}} // namespace {package}", "", "#endif")


def _visitors(config: str, parameters: Sequence[tuple[Mapping[str, Any], int]]) -> Iterator[str]:
    """Yield the functions that call a visitor with each field, of one configuration and of two."""
    yield from ("    template <class V>", f"    static void visit(V visitor, {config} &config)", "    {")
    yield from ("        static_cast<void>(visitor);", "        static_cast<void>(config);")
    for each, group in parameters:
        yield f"        visitor(config.{each['name']}, {_parameter(each, group)});"
    yield from ("    }", "    template <class V>")
    yield f"    static void visit_both(V visitor, const {config} &one, const {config} &other)"
    yield from ("    {", "        static_cast<void>(visitor);", "        static_cast<void>(one);")
    yield "        static_cast<void>(other);"
    for each, group in parameters:
        yield f"        visitor(one.{each['name']}, other.{each['name']}, {_parameter(each, group)});"
    yield from ("    }", "")


def _inside_out(group: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield a group and its inner groups, in the order of ROS's descriptions."""
    for each in _inner(group):
        yield from _inside_out(each)
    yield group


def _outside_in(group: Mapping[str, Any], place: str) -> Iterator[tuple[Mapping[str, Any], str]]:
    """Yield a group and its inner groups, in the order of parameters and states, each with its member of the class."""
    yield group, place
    for each in _inner(group):
        yield from _outside_in(each, f"{place}.{_identifier(each['name']).lower()}")


def _group(group: Mapping[str, Any]) -> str:
    state = "true" if group.get("state", True) else "false"
    fields = (quoted(group["name"]), quoted(group["type"]), str(group["parent"]), str(group["id"]), state)
    return f"roscfe::ConfigGroup{{{', '.join(fields)}}}"


def _group_members(group: Mapping[str, Any], member: str) -> list[str]:
    """Return a group as a member of a class, with its parameters and inner groups, as dynamic_reconfigure has it."""
    lines = [f"struct {_identifier(group['name']).upper()}", "{", "    bool        state = true;"]
    lines += [f"    std::string name  = {quoted(group['name'])};"]
    lines += [f"    {_C_TYPES[each['type']]} {each['name']};" for each in group["parameters"]]
    for each in _inner(group):
        lines += _group_members(each, _identifier(each["name"]).lower())
    return [f"    {line}" for line in [*lines, f"}} {member};"]]


def _inner(group: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    inner = group["groups"]
    return list(inner.values() if isinstance(inner, dict) else inner)


def _identifier(name: str) -> str:
    return re.sub(r"\W", "_", name)


def _parameter(each: Mapping[str, Any], group: int) -> str:
    kind = each["type"]
    limits = ", ".join(_literal(kind, each[field]) for field in ("default", "min", "max"))
    texts = f"{quoted(each['name'])}, {quoted(kind)}, {int(each['level']) & 0xFFFFFFFF}u"
    about = f"{quoted(each['description'])}, {quoted(each['edit_method'])}"
    return f"roscfe::ConfigParameter<{_PARAMETER_TYPES[kind]}>{{{texts}, {about}, {limits}, {group}}}"


def _literal(kind: str, value: Any) -> str:
    if kind == "str":
        return quoted(str(value))
    if kind == "bool":
        return "true" if value else "false"
    if kind == "int":
        return f"({int(value)})" if int(value) > -(1 << 31) else "(-2147483647 - 1)"
    if math.isinf(float(value)):
        return f"{'-' if float(value) < 0 else ''}std::numeric_limits<double>::infinity()"
    return repr(float(value))


def _constant(name: str, constant: Mapping[str, Any]) -> Iterator[str]:
    kind = constant["type"]
    c_type = "const char *const" if kind == "str" else f"constexpr {_C_TYPES[kind]}"
    yield f"{c_type} {name}_{constant['name']} = {_literal(kind, constant['value'])};"
