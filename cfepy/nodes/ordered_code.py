"""The transformation that makes a program's set displays and comprehensions build ordered sets."""

from __future__ import annotations

import ast
from types import CodeType

from cfepy.nodes.ordered_set import SET_NAME


class _SetLiterals(ast.NodeTransformer):
    """`{a, b}` and `{x for ...}` become calls; the right side of `in` stays, as its order cannot be seen."""

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        node.left = self.visit(node.left)
        node.comparators = [
            right if isinstance(right, ast.Set) and isinstance(how, (ast.In, ast.NotIn)) else self.visit(right)
            for how, right in zip(node.ops, node.comparators, strict=True)
        ]
        return node

    def visit_Set(self, node: ast.Set) -> ast.AST:
        self.generic_visit(node)
        return _call(node, ast.List(node.elts, ast.Load()))

    def visit_SetComp(self, node: ast.SetComp) -> ast.AST:
        self.generic_visit(node)
        return _call(node, ast.GeneratorExp(node.elt, node.generators))


def _call(node: ast.expr, argument: ast.expr) -> ast.AST:
    call = ast.Call(ast.Name(SET_NAME, ast.Load()), [argument], [])
    return ast.fix_missing_locations(ast.copy_location(call, node))


def compile_ordered(source: bytes | str, file: str) -> CodeType:
    """Compile a module so that its set displays make ordered sets.

    Raises:
        SyntaxError: as `compile` does.
    """
    tree = _SetLiterals().visit(ast.parse(source, file))
    code: CodeType = compile(tree, file, "exec", dont_inherit=True)
    return code
