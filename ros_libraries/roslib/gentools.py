"""roslib.gentools: md5sums and full texts of definitions, with their dependencies. It uses genmsg."""

from __future__ import annotations

import os
from typing import Any

import genmsg.gentools
from genmsg import MsgContext
from genmsg.srvs import SrvSpec

from roslib import msgs, srvs
from roslib.names import package_resource_name
from roslib.packages import get_dir_pkg

Dependencies = dict[str, Any]
"""`spec`, `package`, `deps` (names of nested types, in order), `uniquedeps`, and `files` if they were asked for."""


def get_file_dependencies(f: str, stdout: Any = None, stderr: Any = None, rospack: Any = None) -> Dependencies:
    """Return the dependencies of the definition in a .msg or .srv file.

    Args:
        f: the file.
        stdout: accepted.
        stderr: accepted.
        rospack: accepted.

    Raises:
        Exception: the file has another extension.
        KeyError: a nested type is unknown.
    """
    loaders: dict[str, Any] = {msgs.EXT: msgs.load_from_file, srvs.EXT: srvs.load_from_file}
    load = loaders.get(os.path.splitext(f)[1])
    if load is None:
        raise Exception(f"[{f}] does not appear to be a message or service")
    _, package = get_dir_pkg(f)
    return get_dependencies(load(f, package or "")[1], package or "")


def get_dependencies(
    spec: Any, package: str, compute_files: bool = True, stdout: Any = None, stderr: Any = None, rospack: Any = None
) -> Dependencies:
    """Return the dependencies of a definition.

    Args:
        spec: the definition.
        package: its package.
        compute_files: also the files of the nested types.
        stdout: accepted.
        stderr: accepted.
        rospack: accepted.

    Raises:
        KeyError: a nested type is unknown.
    """
    deps: list[str] = []
    for part in (spec.request, spec.response) if isinstance(spec, SrvSpec) else (spec,):
        _add(part, package, deps)
    found: Dependencies = {"deps": deps, "spec": spec, "package": package, "uniquedeps": list(dict.fromkeys(deps))}
    if compute_files:
        found["files"] = {name: msgs.msg_file(*package_resource_name(name)) for name in found["uniquedeps"]}
    return found


def _add(spec: Any, package: str, deps: list[str]) -> None:
    for kind in spec.types:
        name = msgs.resolve_type(msgs.base_msg_type(kind), package)
        if not msgs.is_builtin(name):
            deps.append(name)
            _add(msgs.get_registered(name), name.partition(msgs.SEP)[0], deps)


def _context(get_deps_dict: Dependencies) -> MsgContext:
    context = MsgContext.create_default()
    for name in get_deps_dict["uniquedeps"]:
        context.register(name, msgs.get_registered(name))
    return context


def compute_md5_text(get_deps_dict: Dependencies, spec: Any, rospack: Any = None) -> str:
    """Return the text that is hashed."""
    return genmsg.gentools.compute_md5_text(_context(get_deps_dict), spec)


def compute_md5(get_deps_dict: Dependencies, rospack: Any = None) -> str:
    """md5sum of the definition that `get_dependencies` was asked for."""
    return genmsg.gentools.compute_md5(_context(get_deps_dict), get_deps_dict["spec"])


compute_md5_v2 = compute_md5


def compute_full_text(get_deps_dict: Dependencies) -> str:
    """Return the text of that definition, followed by the texts of all nested types, each once."""
    parts = [get_deps_dict["spec"].text + "\n"]
    for name in get_deps_dict["uniquedeps"]:
        parts.append(f"{'=' * 80}\nMSG: {name}\n{msgs.get_registered(name).text}\n")
    return "".join(parts)[:-1]
