"""Substitution arguments of launch files: $(arg x), $(find pkg), $(eval ...) (wiki.ros.org/roslaunch/XML).

Imports nothing of cfepy.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rospy_shim.roslaunch.expression import SubstitutionError, evaluate
from rospy_shim.roslaunch.values import converted

COMMANDS = ("find", "env", "optenv", "dirname", "anon", "arg")
_OPEN = re.compile(r"\$\(([^$()]*)(.?)", re.DOTALL)
_EVAL, _EVAL_END = "$(eval ", ")"


class UnsetArgument(SubstitutionError):
    """$(arg x) of an argument that has no value."""

    def __init__(self, name: str) -> None:
        super().__init__(f"the argument {name!r} has no value")
        self.name = name


class World(NamedTuple):
    """What substitutions of all files of a launch look at.

    `environ` is the environment; `find` gives the folder of a package, or None; `anonymous` makes a name that nobody
    else has.
    """

    environ: Mapping[str, str]
    find: Callable[[str], Path | None]
    anonymous: Callable[[str], str]


class Substitutions:
    """Resolves the texts of one scope.

    Args:
        world: what all scopes look at.
        file: the launch file.
        args: values of arguments.
        anonymous: names that $(anon) has made in this scope.
    """

    def __init__(self, world: World, file: Path, args: dict[str, str], anonymous: dict[str, str]) -> None:
        self.world = world
        self.file = file
        self.args = args
        self.anonymous = anonymous

    def resolve(self, text: str) -> str:
        """A text with all its substitutions made.

        Raises:
            SubstitutionError: one cannot be made.
        """
        if "$" not in text:
            return text
        if text.startswith(_EVAL) and text.endswith(_EVAL_END):
            return self._eval(text[len(_EVAL) : -len(_EVAL_END)])
        return self._pass(self._pass(text, ("env", "optenv", "dirname", "anon", "arg")), ("find",))

    def _pass(self, text: str, commands: tuple[str, ...]) -> str:
        """One look through a text; $(find) has one of its own, for what other substitutions bring."""
        return _OPEN.sub(lambda match: self._replace(match, text, commands), text)

    def _replace(self, match: re.Match[str], text: str, commands: tuple[str, ...]) -> str:
        inside, end = match.groups()
        if end in ("$", "("):
            raise SubstitutionError(f"{text!r} has a {end!r} inside $(...); substitutions cannot be nested")
        words = inside.split(" ")
        command, *arguments = [word for word in words if word] or [""]
        if not end or not inside:
            return match[0]  # never closed, or empty: plain text
        if command not in COMMANDS:
            raise SubstitutionError(f"$({inside}) is not known; known are {', '.join(COMMANDS)}, and eval alone")
        if command not in commands:
            return match[0]
        return self._made(command, arguments, inside)

    def _made(self, command: str, arguments: list[str], inside: str) -> str:
        if command == "dirname":
            return self._dirname()
        if not arguments or (len(arguments) > 1 and command != "optenv"):
            raise SubstitutionError(f"$({inside}) takes one name, as in $({command} NAME)")
        name, *default = arguments
        if command == "optenv":
            return self._optenv(name, " ".join(default))
        functions: dict[str, Callable[[str], str]] = {
            "find": self._find,
            "env": self._env,
            "anon": self._anon,
            "arg": self._arg,
        }
        return functions[command](name)

    # -- the commands ------------------------------------------------------------------------------------------------

    def _find(self, package: str) -> str:
        folder = self.world.find(package)
        if folder is None:
            text = f"there is no package {package!r}; put it beside the launch file's package, or on ROS_PACKAGE_PATH"
            raise SubstitutionError(text)
        return str(folder)

    def _env(self, name: str) -> str:
        if name not in self.world.environ:
            raise SubstitutionError(f"the environment variable {name} is not set; set it, or use $(optenv {name} ...)")
        return self.world.environ[name]

    def _optenv(self, name: str, default: str = "") -> str:
        return self.world.environ.get(name, default)

    def _anon(self, name: str) -> str:
        if name not in self.anonymous:
            self.anonymous[name] = self.world.anonymous(name)
        return self.anonymous[name]

    def _arg(self, name: str) -> str:
        if name not in self.args:
            raise UnsetArgument(name)
        return self.args[name]

    def _dirname(self) -> str:
        return str(self.file.absolute().parent)

    def _eval(self, text: str) -> str:
        functions: dict[str, Any] = {
            "anon": self._anon,
            "arg": lambda name: converted(self._arg(name), "auto"),
            "dirname": self._dirname,
            "env": self._env,
            "find": self._find,
            "optenv": self._optenv,
        }
        return evaluate(text, functions, {name: converted(value, "auto") for name, value in self.args.items()})
