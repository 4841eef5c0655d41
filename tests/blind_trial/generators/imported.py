"""What a module of the trial draws in: generators must stand apart from what they are to test."""

import ast
from pathlib import Path

_ROOT = Path(__file__).parents[3]


def imported(module):
    """Names of the modules of this project that ``module`` is made of: itself, and all that it imports, however far."""
    seen, left = set(), [module]
    while left:
        name = left.pop()
        path = _ROOT / (name.replace(".", "/") + ".py")
        if name in seen or not path.exists():
            continue
        seen.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                left += [node.module, *(f"{node.module}.{a.name}" for a in node.names)]
            elif isinstance(node, ast.Import):
                left += [a.name for a in node.names]
    return seen
