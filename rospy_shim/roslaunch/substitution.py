"""Substitution arguments of launch files: $(arg x), $(find pkg), $(eval ...) (wiki.ros.org/roslaunch/XML).

The expression of $(eval ...) is Python's; it can reach arguments, numbers and texts, and nothing of the computer.
"""

from __future__ import annotations

import builtins
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rospy_shim.roslaunch.values import converted

# fmt: off
_FUNCTIONS = (
    "abs", "all", "any", "bool", "dict", "divmod", "enumerate", "filter", "float", "int", "len", "list", "map", "max",
    "min", "pow", "range", "repr", "reversed", "round", "set", "sorted", "str", "sum", "tuple", "zip",
)
# fmt: on
_SAFE = {name: getattr(builtins, name) for name in _FUNCTIONS}
_MATH = {name: value for name, value in vars(math).items() if not name.startswith("_")}
_WORDS = {"true": True, "false": False}
COMMANDS = ("find", "env", "optenv", "dirname", "anon", "arg")
_OPEN = re.compile(r"\$\(([^$()]*)(.?)", re.DOTALL)
_EVAL, _EVAL_END = "$(eval ", ")"
_ARG = re.compile(r"\$\(\s*arg\s+([^\s()]+)\s*\)")
_WORD = re.compile(r"\w+")


class SubstitutionError(Exception):
    """A substitution that cannot be made; its text says why."""


def evaluate(text: str, functions: Mapping[str, Any], arguments: Mapping[str, Any]) -> str:
    """The value of an expression, as text.

    Args:
        text: the expression.
        functions: roslaunch's functions; they and the names of `math` win over arguments.
        arguments: what arguments stand for.

    Raises:
        SubstitutionError: it is no expression, looks at names with two underscores, or fails.
    """
    if "__" in text:
        raise SubstitutionError(f"$(eval {text}) has two underscores in a row, which are not allowed there")
    names = {**arguments, **_MATH, **_WORDS, **functions, "__builtins__": _SAFE}
    try:
        return str(eval(text.strip(), names))
    except SubstitutionError:
        raise
    except Exception as error:
        raise SubstitutionError(f"$(eval {text}) has no value: {type(error).__name__}: {error}") from None


UNKNOWN = "\0unknown"
"""Stands for the value of an argument that could not be read; no launch file can have this text."""


class UnknownArgument(SubstitutionError):
    """$(arg x) of an argument whose value could not be read, which was told before."""


class UnsetArgument(SubstitutionError):
    """$(arg x) of an argument that has no value."""

    def __init__(self, name: str) -> None:
        super().__init__(f"the argument {name!r} has no value")
        self.name = name


def arguments_in(text: str) -> set[str]:
    """Names of arguments that a text may use; each word of an expression may be one."""
    return set((_WORD if _EVAL in text else _ARG).findall(text))


class World(NamedTuple):
    """What substitutions of all files of a launch look at.

    `environ` is the environment; `find` gives the folder of a package, or None; `anonymous` makes a name that no other
    node has.
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
        value = self.args.get(name)
        if value is None:
            raise UnsetArgument(name)
        if value == UNKNOWN:
            raise UnknownArgument(name)
        return value

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
        words = set(_WORD.findall(text))
        if any(value == UNKNOWN and name in words for name, value in self.args.items()):
            raise UnknownArgument(text)
        return evaluate(text, functions, {name: converted(value, "auto") for name, value in self.args.items()})
