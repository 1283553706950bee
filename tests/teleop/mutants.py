"""Functions with one term removed or its sign flipped, one after the other.

A mutant is made of the source of a function: it is Python where the function was compiled. What is
a term: both sides of every sum and difference, what a sign or a sum in place adds, both choices
of a conditional expression, and both bounds of every min and max.
"""

import ast
import inspect
import textwrap
from collections.abc import Iterator
from copy import deepcopy
from types import ModuleType
from typing import Any, NamedTuple

Function = Any


class Mutant(NamedTuple):
    """One of them.

    Arguments:
        name: what was changed, in words
        owner: module or class that the function is an attribute of
        attribute: its name
        function: to take its place
    """

    name: str
    owner: Any
    attribute: str
    function: Function


def mutants(owner: ModuleType | type, attribute: str) -> Iterator[Mutant]:
    """All mutants of a function or a method."""
    original: Function = inspect.getattr_static(owner, attribute)
    plain = getattr(original, "py_func", original)
    tree = ast.parse(textwrap.dedent(inspect.getsource(plain)))
    home = plain.__globals__
    seen = {ast.dump(tree)}
    for place, node in enumerate(ast.walk(tree)):
        for change, other in _changes(node):
            mutated = _with(tree, place, other)
            if ast.dump(mutated) in seen:
                continue
            seen.add(ast.dump(mutated))
            name = f"{attribute}: {ast.unparse(node)} -> {change}"
            yield Mutant(name, owner, attribute, _compiled(mutated, home, attribute))


def _changes(node: ast.AST) -> list[tuple[str, ast.AST]]:
    """What may take the place of a node."""
    others = list[ast.AST]()
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            others = [left, right, ast.BinOp(left, ast.Sub(), right)]
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            others = [left, ast.UnaryOp(ast.USub(), right), ast.BinOp(left, ast.Add(), right)]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            others = [operand]
        case ast.AugAssign(target=target, op=ast.Add(), value=value):
            others = [ast.Pass(), ast.AugAssign(target, ast.Sub(), value)]
        case ast.AugAssign(target=target, op=ast.Sub(), value=value):
            others = [ast.Pass(), ast.AugAssign(target, ast.Add(), value)]
        case ast.AugAssign(op=ast.Mult()):
            others = [ast.Pass()]
        case ast.IfExp(body=body, orelse=orelse):
            others = [body, orelse]
        case ast.Call(func=ast.Name(id="min" | "max"), args=args):
            others = list(args)
        case _:
            pass
    return [(ast.unparse(ast.fix_missing_locations(deepcopy(o))), o) for o in others]


def _with(tree: ast.Module, place: int, other: ast.AST) -> ast.Module:
    """A copy of a tree with another node in a place."""
    copy = deepcopy(tree)
    old = list(ast.walk(copy))[place]

    class Swap(ast.NodeTransformer):
        def visit(self, node: ast.AST) -> Any:
            return deepcopy(other) if node is old else self.generic_visit(node)

    return ast.fix_missing_locations(Swap().visit(copy))


def _compiled(tree: ast.Module, home: dict[str, Any], attribute: str) -> Function:
    """The function of a tree, without decorators, that sees what the original sees."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            node.decorator_list = []
    found: dict[str, Any] = {}
    exec(compile(tree, f"<mutant of {attribute}>", "exec"), home, found)
    return found[attribute]
