"""Sizes of the house style: header <= 150 lines, source <= 300, function <= 40, <= 5 parameters."""

from __future__ import annotations

import ast
import re

HEADER_LINES = 150
SOURCE_LINES = 300
FUNCTION_LINES = 40
PARAMETERS = 5

# Signatures that a library prescribes to those who override them.
OF_LIBRARIES = {("train/rtg/replay.py", "add")}  # stable_baselines3's ReplayBuffer.add

_NO_FUNCTION = re.compile(
    r"\s*(?:namespace|class|struct|enum|union|extern|if|for|while|switch|else|do|try|catch|template)\b"
)
_CLOSING = re.compile(r"^( *)\}$")
_COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_TEMPLATE_ARGUMENTS = re.compile(r"(?<=\w)<[^<>]*>")
_TYPE_AND_NAME = re.compile(r"[\w:]+[&*]{0,2}(?:\.\.\.)? \w+$|[\w:]+[&*]{1,2}$")
_NO_TYPE = re.compile(r"(?:return|new|delete|throw|case|co_\w+)\b")


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


def _without_nested(text: str) -> str:
    """Without what stands in brackets; clang-format leaves blanks around operators < and >."""
    kept, depth = [], 0
    for sign in text:
        depth -= sign in ")]}"
        if depth == 0:
            kept.append(sign)
        depth += sign in "([{"
    flat, found = "".join(kept), 1
    while found:
        flat, found = _TEMPLATE_ARGUMENTS.subn("", flat)
    return flat


def cpp_parameters(text: str) -> list[tuple[str, int]]:
    """(line of the opening bracket, parameters) of every parameter list of clang-formatted C++.

    A list in brackets holds parameters, and not the arguments of a call, if one of its items is a
    type with a name, or a reference or pointer without one.
    """
    text = _COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    found, opened = [], []
    for at, sign in enumerate(text):
        if sign == "(":
            opened.append(at)
        elif sign == ")" and opened:
            start = opened.pop()
            inside = _without_nested(text[start + 1 : at])
            items = [" ".join(item.split("=")[0].split()) for item in inside.split(",")]
            if any(_TYPE_AND_NAME.search(item) and not _NO_TYPE.match(item) for item in items):
                line = text[text.rfind("\n", 0, start) + 1 :].split("\n", 1)[0]
                found.append((line.strip(), len(items)))
    return found


def python_parameters(text: str) -> list[tuple[str, int]]:
    """(name, parameters) of every function.

    Without self and cls, and without *args and **kwargs, which are another function's.
    """
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            signature = node.args
            own = [*signature.posonlyargs, *signature.args, *signature.kwonlyargs]
            bound = bool(own) and own[0].arg in ("self", "cls")
            found.append((getattr(node, "name", "lambda"), len(own) - bound))
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
    signatures = python_parameters(text) if path.endswith(".py") else cpp_parameters(text)
    for head, count in signatures:
        if count > PARAMETERS and (path, head) not in OF_LIBRARIES:
            found.append(f"{path}: {count} parameters, at most {PARAMETERS}: {head}")
    return found
