"""Substitution arguments of launch files: $(arg x), $(find pkg), $(eval ...) (wiki.ros.org/roslaunch/XML).

`rospy_shim.types.expression` evaluates the expression of $(eval ...); it has access to arguments, numbers and texts,
but not to the computer.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.reading.input_limits import SUBSTITUTED_CHARACTERS, SUBSTITUTED_IN_ALL
from cfepy.reading.suggestions import did_you_mean
from rospy_shim.roslaunch.values import converted
from rospy_shim.types.expression import MATH, ExpressionError, plain_text, value_of

_SHORTER = "check for an argument that contains itself, or make it shorter"
_TOO_LONG = f"the text must have at most {SUBSTITUTED_CHARACTERS:,} characters; {_SHORTER}"
_SHOWN = 200  # characters of an expression in an error
_WORDS = {"true": True, "false": False}
COMMANDS = ("find", "env", "optenv", "dirname", "anon", "arg")
_OPEN = re.compile(r"\$\(([^$()]*)(.?)", re.DOTALL)
_EVAL, _EVAL_END = "$(eval ", ")"
_ARG = re.compile(r"\$\(\s*arg\s+([^\s()]+)\s*\)")
_WORD = re.compile(r"\w+")


class SubstitutionError(Exception):
    """A substitution cannot be made; its text says why."""


def evaluate(text: str, functions: Mapping[str, Any], arguments: Mapping[str, Any]) -> str:
    """Evaluate an expression to a text.

    Args:
        text: the expression.
        functions: roslaunch's functions; they and the names of `math` take precedence over arguments.
        arguments: values of arguments.

    Raises:
        SubstitutionError: it is not an expression, contains two underscores in a row, or fails.
    """
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
    if "__" in text:
        raise SubstitutionError(f"$(eval {shown}) must not contain two underscores in a row")
    try:
        return plain_text(value_of(text.strip(), {**arguments, **MATH, **_WORDS, **functions}))
    except ExpressionError as error:
        raise SubstitutionError(f"$(eval {shown}) {error}") from None
    except SubstitutionError:
        raise
    except Exception as error:
        raise SubstitutionError(f"cannot evaluate $(eval {shown}): {type(error).__name__}: {error}") from None


UNKNOWN = "\0unknown"
"""Placeholder for the value of an argument that could not be read; no launch file can have this text."""


class UnknownArgument(SubstitutionError):
    """$(arg x) of an argument whose value could not be read, which was reported before."""


class UnsetArgument(SubstitutionError):
    """$(arg x) of an argument that has no value."""

    def __init__(self, name: str) -> None:
        super().__init__(f"the argument {name!r} has no value")
        self.name = name


def arguments_in(text: str) -> set[str]:
    """Return the names of arguments that a text may use; each word of an expression may be one."""
    return set((_WORD if _EVAL in text else _ARG).findall(text))


class World(NamedTuple):
    """The common data of substitutions in all files of a launch.

    `environ` is the environment; `find` returns the folder of a package, or None; `packages` returns the names of all
    packages, for errors; `anonymous` makes a unique node name; `made` has the number of characters that substitutions
    have made.
    """

    environ: Mapping[str, str]
    find: Callable[[str], Path | None]
    anonymous: Callable[[str], str]
    made: list[int]
    packages: Callable[[], Iterable[str]] = tuple


class Substitutions:
    """Resolves the texts of one scope.

    Args:
        world: the common data of all scopes.
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
        """Return a text with all its substitutions made.

        Raises:
            SubstitutionError: one cannot be made.
        """
        if "$" not in text:
            return text
        if text.startswith(_EVAL) and text.endswith(_EVAL_END):
            return self._counted(self._eval(text[len(_EVAL) : -len(_EVAL_END)]))
        return self._pass(self._pass(text, ("env", "optenv", "dirname", "anon", "arg")), ("find",))

    def _pass(self, text: str, commands: tuple[str, ...]) -> str:
        """Make one pass through a text; $(find) has its own pass, so that it sees the results of other
        substitutions.
        """
        size = len(text)

        def replaced(match: re.Match[str]) -> str:
            nonlocal size
            made = self._replace(match, text, commands)
            size += len(made)
            if size > SUBSTITUTED_CHARACTERS:
                raise SubstitutionError(_TOO_LONG)
            return made

        return self._counted(_OPEN.sub(replaced, text))

    def _counted(self, text: str) -> str:
        """Return a made text; raise an error if it, or all texts of the launch together, are too long."""
        self.world.made[0] += len(text)
        if len(text) > SUBSTITUTED_CHARACTERS:
            raise SubstitutionError(_TOO_LONG)
        if self.world.made[0] > SUBSTITUTED_IN_ALL:
            raise SubstitutionError(
                f"substitutions of the launch file make more than {SUBSTITUTED_IN_ALL:,} characters; {_SHORTER}"
            )
        return text

    def _replace(self, match: re.Match[str], text: str, commands: tuple[str, ...]) -> str:
        inside, end = match.groups()
        if end in ("$", "("):
            raise SubstitutionError(f"{text!r} has a {end!r} inside $(...); substitutions cannot be nested")
        words = inside.split(" ")
        command, *arguments = [word for word in words if word] or [""]
        if not end or not inside:
            return match[0]  # never closed, or empty: plain text
        if command not in COMMANDS:
            hint = did_you_mean(command, (*COMMANDS, "eval"), before="; ")
            raise SubstitutionError(
                f"unknown substitution $({inside}); known are {', '.join(COMMANDS)}, and eval alone{hint}"
            )
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
            what_to_do = "put it next to the package of the launch file, or on ROS_PACKAGE_PATH"
            raise SubstitutionError(
                f"unknown package {package!r}; {did_you_mean(package, self.world.packages(), what_to_do)}"
            )
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
