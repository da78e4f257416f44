"""Sizes of the house style: header <= 150 lines, source <= 300, function <= 40."""

from __future__ import annotations

import ast
import re

HEADER_LINES = 150
SOURCE_LINES = 300
FUNCTION_LINES = 40

_NO_FUNCTION = re.compile(
    r"\s*(?:namespace|class|struct|enum|union|extern|if|for|while|switch|else|do|try|catch|template)\b"
)
_CLOSING = re.compile(r"^( *)\}$")


def counted(lines: list[str]) -> int:
    """Lines that are neither blank nor comment."""
    return sum(
        1 for line in lines if line.strip() and not line.strip().startswith(("//", "#", "*"))
    )


def cpp_functions(text: str) -> list[tuple[str, int]]:
    """(first line, size) of the function bodies of clang-formatted C++.

    A body ends in a lone closing brace of indentation i, and its signature is the nearest line
    above with the same indentation: all between is indented deeper (or blank, or of the
    preprocessor).
    """
    lines = text.splitlines()
    found = []
    for end, line in enumerate(lines):
        match = _CLOSING.match(line)
        if not match:
            continue
        indent = len(match.group(1))
        start = end - 1
        while start >= 0 and (
            not lines[start].strip()
            or lines[start].startswith("#")
            or len(lines[start]) - len(lines[start].lstrip()) > indent
        ):
            start -= 1
        head = lines[start] if start >= 0 else ""
        if "(" in head and not _NO_FUNCTION.match(head):
            found.append((head.strip(), counted(lines[start : end + 1])))
    return found


def python_functions(text: str) -> list[tuple[str, int]]:
    """(name, size) of every function, its docstring not counted."""
    lines = text.splitlines()
    found = []
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        doc = node.body[0] if ast.get_docstring(node) else None
        size = counted(lines[node.lineno - 1 : node.end_lineno])
        if doc:
            size -= counted(lines[doc.lineno - 1 : doc.end_lineno])
        found.append((node.name, size))
    return found


def oversized(path: str, text: str) -> list[str]:
    """What in the file is longer than the house allows."""
    found = []
    lines = len(text.splitlines())
    limit = HEADER_LINES if path.endswith((".hpp", ".h")) else SOURCE_LINES
    if lines > limit:
        found.append(f"{path}: {lines} lines, at most {limit}")
    functions = python_functions(text) if path.endswith(".py") else cpp_functions(text)
    for head, size in functions:
        if size > FUNCTION_LINES:
            found.append(f"{path}: {size} lines, at most {FUNCTION_LINES}: {head}")
    return found
