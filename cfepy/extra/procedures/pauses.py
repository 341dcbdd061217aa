"""Time in procedures: the pause before each line, and the module `time` of a procedure.

COSMOS instruments the lines of a procedure and waits before each one. Here the pause is virtual time. `time.sleep` of a
procedure lets the mission's time pass, and `time.time` reads it.
"""

from __future__ import annotations

import ast
import time
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cfepy.extra.procedures.script_api import ScriptApi

LINE = "__cfepy_line__"
"""Name of the function that procedures call before each line."""


def with_pauses(tree: ast.Module) -> ast.Module:
    """Return a module with a call of `LINE` before each statement except declarations and docstrings."""
    for node in list(ast.walk(tree)):
        for name in ("body", "orelse", "finalbody"):
            statements = getattr(node, name, None)
            if isinstance(statements, list):
                setattr(node, name, [new for each in statements for new in _paused(each)])
    return ast.fix_missing_locations(tree)


def _paused(statement: ast.stmt) -> list[ast.stmt]:
    is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    declares = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Global)
    if is_text or isinstance(statement, (*declares, ast.Nonlocal)):
        return [statement]
    call = ast.Expr(ast.Call(ast.Name(LINE, ast.Load()), [], []))
    ast.copy_location(call, statement)
    return [call, statement]


def procedure_clock(api: ScriptApi) -> ModuleType:
    """Return the module `time` of a procedure.

    Args:
        api: its functions.
    """
    module = ModuleType("time")
    module.__dict__.update({name: value for name, value in vars(time).items() if not name.startswith("__")})
    module.__dict__["sleep"] = api._sleep
    for name in ("time", "monotonic", "perf_counter"):
        module.__dict__[name] = api._time
    return module
