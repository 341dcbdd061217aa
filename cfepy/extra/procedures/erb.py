"""The part of ERB that procedures and COSMOS definitions use: variables, conditions, counted loops and header helpers.

Text between `<%` and `%>` is Ruby. This module evaluates only the forms listed in docs/how_to/procedures.md. Anything
else is refused with its file and line, because cfepy does not run Ruby.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.status import UsageError
from rospy_shim.types.expression import ExpressionError, value_of

_TAG = re.compile(r"<%(=|#|-)?(.*?)-?%>(\n?)", re.DOTALL)
_IF = re.compile(r"(if|elsif|unless)\s+(.+?)(?:\s+then)?$", re.DOTALL)
_TIMES = re.compile(r"(.+?)\.times\s+do\s*\|\s*(\w+)\s*\|$", re.DOTALL)
_RANGE = re.compile(r"\(?\s*(.+?)\s*(\.\.\.?)\s*(.+?)\s*\)?\.each\s+do\s*\|\s*(\w+)\s*\|$", re.DOTALL)
_REQUIRE = re.compile(r"require(_relative)?\b")
_ASSIGN = re.compile(r"(\$?\w+)\s*=(?!=)\s*(.+)$", re.DOTALL)
_GLOBAL = "ruby_global_"
_MOST_ROUNDS = 100_000
_RUBY = re.compile(r"\"[^\"]*\"|'[^']*'|&&|\|\||\$\w+")
_OPERATORS = {"&&": " and ", "||": " or "}
_DIVIDE = "ruby_divide"
_LITERALS: Mapping[str, Any] = {"true": True, "false": False, "nil": None}
_UNBOUND = re.compile(r"name '(?P<name>\w+)' is not defined")

Helper = Callable[..., Any]


class _Tag(NamedTuple):
    """Ruby between `<%` and `%>`, or the text before it if `kind` is empty."""

    kind: str
    text: str
    line: int


class Template:
    """Evaluates templates with the same variables.

    Args:
        variables: values by name, such as `target_name`; names of Ruby's global variables begin with "$".
        helper: returns the helper with a name, or None, such as the one that prints the headers of packets.
    """

    def __init__(self, variables: Mapping[str, Any], helper: Callable[[str], Helper | None] = lambda name: None):
        self._variables = dict(variables)
        self._helper = helper

    def render(self, text: str, file: Path) -> str:
        """Return a template's output.

        Args:
            text: the template.
            file: its file, for errors.

        Raises:
            UsageError: for Ruby that is not supported, and for unknown variables.
        """
        if "<%" not in text:
            return text
        tags = _tags(text)
        output: list[str] = []
        end = self._block(tags, 0, dict(self._variables), output, file)
        if end < len(tags):
            raise UsageError(f"unexpected <% {tags[end].text} %>", file=file, line=tags[end].line)
        return "".join(output)

    def value(self, ruby: str, file: Path, line: int = 1) -> Any:
        """Return the value of an expression.

        Args:
            ruby: the expression.
            file: its file, for errors.
            line: its line.

        Raises:
            UsageError: for Ruby that is not supported, and for unknown variables.
        """
        return self._value(ruby, self._variables, file, line)

    def _block(self, tags: list[_Tag], at: int, names: dict[str, Any], output: list[str] | None, file: Path) -> int:
        """Evaluate tags until the end of a block; without an output, only find that end."""
        while at < len(tags):
            tag = tags[at]
            if tag.kind == "text":
                if output is not None:
                    output.append(tag.text)
            elif tag.kind == "=":
                if output is not None:
                    output.append(_printed(self._value(tag.text, names, file, tag.line)))
            elif tag.kind != "#":
                word = tag.text.split(None, 1)[0] if tag.text else ""
                if word in ("end", "else", "elsif"):
                    return at
                at = self._statement(tags, at, names, output, file)
                continue
            at += 1
        return at

    def _statement(self, tags: list[_Tag], at: int, names: dict[str, Any], output: list[str] | None, file: Path) -> int:
        tag = tags[at]
        if _REQUIRE.match(tag.text) or not tag.text:
            return at + 1
        if (match := _IF.fullmatch(tag.text)) is not None:
            return self._condition(tags, at, match, names, output, file)
        if (match := _TIMES.fullmatch(tag.text)) is not None:
            last = 0 if output is None else self._value(match[1], names, file, tag.line)
            return self._loop(tags, at, match[2], range(_whole(last, file, tag.line)), names, output, file)
        if (match := _RANGE.fullmatch(tag.text)) is not None:
            ends = [0, -1] if output is None else [self._value(match[i], names, file, tag.line) for i in (1, 3)]
            first, last = (_whole(each, file, tag.line) for each in ends)
            rounds = range(first, last + (match[2] == ".."))
            return self._loop(tags, at, match[4], rounds, names, output, file)
        if (match := _ASSIGN.fullmatch(tag.text)) is not None:
            if output is not None:
                names[match[1]] = self._value(match[2], names, file, tag.line)
            return at + 1
        raise UsageError(f"Ruby is not executed: <% {tag.text} %>", file=file, line=tag.line)

    def _condition(
        self,
        tags: list[_Tag],
        at: int,
        match: re.Match[str],
        names: dict[str, Any],
        output: list[str] | None,
        file: Path,
    ) -> int:
        done = output is None
        while True:
            tag = tags[at]
            chosen = False
            if not done:
                chosen = tag.text == "else" or bool(self._value(match[2], names, file, tag.line))
                chosen = chosen != (match[1] == "unless" and tag.text != "else")
            done = done or chosen
            at = self._block(tags, at + 1, names, output if chosen else None, file)
            if at >= len(tags):
                raise UsageError(f"missing <% end %> of <% {tag.text} %>", file=file, line=tag.line)
            if tags[at].text == "end":
                return at + 1
            if tags[at].text != "else":
                found = _IF.fullmatch(tags[at].text)
                if found is None:
                    raise UsageError(f"unexpected <% {tags[at].text} %>", file=file, line=tags[at].line)
                match = found

    def _loop(
        self,
        tags: list[_Tag],
        at: int,
        name: str,
        rounds: range,
        names: dict[str, Any],
        output: list[str] | None,
        file: Path,
    ) -> int:
        if len(rounds) > _MOST_ROUNDS:
            raise UsageError(f"a loop has at most {_MOST_ROUNDS:,} rounds", file=file, line=tags[at].line)
        end = self._block(tags, at + 1, names, None, file)
        if end >= len(tags) or tags[end].text != "end":
            raise UsageError(f"missing <% end %> of <% {tags[at].text} %>", file=file, line=tags[at].line)
        for number in rounds if output is not None else ():
            names[name] = number
            self._block(tags, at + 1, names, output, file)
        return end + 1

    def _value(self, ruby: str, names: Mapping[str, Any], file: Path, line: int) -> Any:
        """Return the value of an expression that means the same in Ruby and in Python."""
        shown = f"<% {ruby.strip()} %>"
        if "#{" in ruby or "**" in ruby:
            raise UsageError(f"Ruby is not executed: {shown}", file=file, line=line)
        text = _RUBY.sub(_in_python, ruby.strip())
        known = {_GLOBAL + name[1:] if name.startswith("$") else name: value for name, value in names.items()}
        for name in re.findall(r"(\w+)\s*\(", text):
            helper = self._helper(name)
            if helper is not None:
                known[name] = helper
        try:
            return value_of(_with_division(text), {**known, **_LITERALS, _DIVIDE: _divided})
        except (SyntaxError, ExpressionError, RecursionError):
            raise UsageError(f"Ruby is not executed: {shown}", file=file, line=line) from None
        except UsageError as error:
            raise UsageError(error.text, file=file, line=line) from None
        except NameError as error:
            what = _without_value(error, text) or f"Ruby is not executed: {shown}"
            raise UsageError(what, file=file, line=line) from None
        except (TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
            raise UsageError(f"{shown}: {error}", file=file, line=line) from None


class _Division(ast.NodeTransformer):
    """Replaces each division by a call."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace a division by a call."""
        self.generic_visit(node)
        if not isinstance(node.op, ast.Div):
            return node
        return ast.Call(ast.Name(_DIVIDE, ast.Load()), [node.left, node.right], [])


def _with_division(text: str) -> str:
    """Return an expression that divides as Ruby does."""
    return ast.unparse(_Division().visit(ast.parse(text, mode="eval"))) if "/" in text else text


def _divided(left: Any, right: Any) -> Any:
    """Return a quotient as Ruby has it: a whole number, rounded down, if both numbers are whole."""
    return left // right if isinstance(left, int) and isinstance(right, int) else left / right


def _in_python(found: re.Match[str]) -> str:
    """Return an operator or a global variable of Ruby as Python has it; texts stay."""
    word = found[0]
    return _GLOBAL + word[1:] if word.startswith("$") else _OPERATORS.get(word, word)


def _without_value(error: NameError, text: str) -> str:
    """Return the error of an unknown variable; empty if the name is of a class or a function of Ruby."""
    match = _UNBOUND.search(str(error))
    name = "" if match is None else match["name"]
    if not name or re.search(rf"\b{name}\s*[.(]", text):
        return ""
    known = f"${name.removeprefix(_GLOBAL)}" if name.startswith(_GLOBAL) else name
    return f"the variable {known} has no value; set it with --variable '{known}=VALUE'"


def _printed(value: Any) -> str:
    """Return a value as Ruby prints it."""
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)


def _whole(value: Any, file: Path, line: int) -> int:
    if not isinstance(value, int):
        raise UsageError(f"a loop requires whole numbers, not {value!r}", file=file, line=line)
    return value


def _tags(text: str) -> list[_Tag]:
    """Return the parts of a template; ends of lines stay, so errors have the lines of the file."""
    parts, at, line = [], 0, 1
    for match in _TAG.finditer(text):
        before = text[at : match.start()]
        parts.append(_Tag("text", before, line))
        line += before.count("\n")
        kind = "%" if match[1] in (None, "-") else match[1]
        parts.append(_Tag(kind, match[2].strip(), line))
        line += match[2].count("\n")
        parts.append(_Tag("text", match[3], line))
        line += match[3].count("\n")
        at = match.end()
    parts.append(_Tag("text", text[at:], line))
    return [each for each in parts if each.text or each.kind != "text"]
