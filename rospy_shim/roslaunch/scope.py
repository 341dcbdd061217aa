"""The scope of a place in a launch file: namespace, remappings, private parameters, environment, arguments.

Every tag with contents opens a scope inside the one around it; an included file gets one with arguments of its own.
Names are joined as in rosgraph.names. Stands for roslaunch.loader.LoaderContext.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rospy_shim.roslaunch.model import LaunchFindings
from rospy_shim.roslaunch.substitution import Substitutions, World
from rospy_shim.types.names import PRIV_NAME, SEP, canonicalize_name, is_legal_name


def joined(namespace: str, name: str) -> str:
    """Return a name below a namespace; global and private names stay unchanged."""
    if not namespace or name.startswith((SEP, PRIV_NAME)):
        return name
    return namespace + name if namespace.endswith(SEP) else f"{namespace}{SEP}{name}"


def as_namespace(name: str) -> str:
    """Return a namespace with a slash at both ends.

    Raises:
        ValueError: it begins with "~".
    """
    if name.startswith(PRIV_NAME):
        raise ValueError(f"invalid namespace {name!r}; a namespace cannot be private")
    name = name if name.startswith(SEP) else SEP + name
    return name if name.endswith(SEP) else name + SEP


class Scope:
    """One scope.

    Args:
        world: the common data of substitutions.
        file: the launch file.
        namespace: namespace with a slash at both ends.
        args: values of arguments.
        findings: receives errors and remarks.
        parent: the scope around it.

    Attributes:
        included_at: file and line of the <include> that reads the file; empty for the launch file itself.
    """

    def __init__(
        self,
        world: World,
        file: Path,
        namespace: str,
        args: dict[str, str],
        findings: LaunchFindings,
        parent: Scope | None = None,
    ) -> None:
        self.namespace = namespace
        self.findings = findings
        self.included_at: str = parent.included_at if parent else ""
        anonymous: dict[str, str] = dict(parent.substitutions.anonymous) if parent else {}
        self.substitutions: Substitutions = Substitutions(world, file, args, anonymous)
        self.declared: list[str] = list(parent.declared) if parent else []
        self.takes_all_args = False
        self.params: dict[str, Any] = dict(parent.params) if parent else {}
        self.env: dict[str, str] = dict(parent.env) if parent else {}
        self._remaps: dict[str, str] = {}
        self._parent = parent

    @property
    def file(self) -> Path:
        """The launch file."""
        return self.substitutions.file

    @property
    def args(self) -> dict[str, str]:
        """Values of arguments."""
        return self.substitutions.args

    def inside(self, namespace: str | None = None) -> Scope:
        """Open a scope inside this one.

        Args:
            namespace: namespace below this scope's, or global.

        Raises:
            ValueError: the namespace is private.
        """
        world = self.substitutions.world
        return Scope(world, self.file, self._below(namespace), dict(self.args), self.findings, self)

    def of_included(self, file: Path, namespace: str | None, args: dict[str, str]) -> Scope:
        """Open the scope of an included file, which sees only the arguments that are passed to it.

        Raises:
            ValueError: the namespace is private.
        """
        scope = Scope(self.substitutions.world, file, self._below(namespace), args, self.findings, self)
        scope.declared, scope.substitutions.anonymous = [], {}
        return scope

    def _below(self, namespace: str | None) -> str:
        return as_namespace(joined(self.namespace, namespace)) if namespace else self.namespace

    # -- additions by tags ---------------------------------------------------------------------------------------------

    def set_param(self, name: str, value: Any) -> None:
        """Set a private parameter for the nodes that follow."""
        self.params.pop(name, None)
        self.params[name] = value

    def add_remap(self, source: str, target: str) -> None:
        """Add a remapping for the nodes that follow.

        Raises:
            ValueError: a name is empty, or invalid.
        """
        names = canonicalize_name(source), canonicalize_name(target)
        for which, name in zip(("from", "to"), names, strict=True):
            if not name or not is_legal_name(name):
                raise ValueError(f"invalid {which!r} {name!r}; expected a ROS name")
        self._remaps.pop(names[0], None)
        self._remaps[names[0]] = names[1]

    def remaps(self) -> dict[str, str]:
        """Return all remappings in force, outer ones first."""
        found = self._parent.remaps() if self._parent else {}
        for source, target in self._remaps.items():
            found.pop(source, None)
            found[source] = target
        return found

    @property
    def size(self) -> int:
        """The number of arguments, variables, parameters and remappings in this scope, which an inner tag copies."""
        own = len(self.args) + len(self.declared) + len(self.env) + len(self.params) + len(self._remaps)
        return own + (self._parent.size if self._parent else 0)

    def declare_arg(self, name: str, value: str | None, default: str | None) -> None:
        """Handle an <arg> tag.

        Raises:
            ValueError: it exists already, or has a value that was given from outside.
        """
        if name not in self.declared:
            self.declared.append(name)
        elif not self.takes_all_args:
            raise ValueError(f"the argument {name!r} is already declared; remove one of the two tags")
        if value is not None:
            if name in self.args and not self.takes_all_args:
                raise ValueError(
                    f"the argument {name!r} has a fixed value and cannot be set from outside; write default= "
                    "instead of value=, or do not set it"
                )
            self.args[name] = value
        elif default is not None:
            self.args.setdefault(name, default)
