"""python wire_fields.py HEADER FILE.lcm...: writes a C++ header that lists the fields of messages.

A message is a struct of scalars, texts and arrays of one dimension. Its first field is `header_t
header`. The length of an array is an int32_t field before the array. Other messages are refused
with exit status 1.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import NoReturn

HEAD = """// Made by msgs/wire_fields.py from the .lcm files.
#pragma once

{includes}

/// fields(v, m) calls visitor `v` with the name of each field of message `m` and the field, in the
/// order of its .lcm file: v.scalar("x", x), v.count("n", n), v.array("a", vector, n),
/// v.text("s", string), v.texts("t", vector of strings, n). Those of the header come first.
/// Visitors check the bytes of a message before decoding and its values after decoding.
namespace rtg_msgs {{

/// A list of all types of messages.
template <template <class...> class List>
using EveryMessage = List<{types}>;
"""
FUNCTION = """
template <class V>
void fields(V& v, {name}& m) {{
{lines}
}}
"""
TAIL = """
}  // namespace rtg_msgs
"""
NUMBERS = {"int8_t", "int16_t", "int32_t", "int64_t", "float", "double"}
STRUCT = re.compile(r"struct\s+(\w+)\s*\{(.*)\}", re.DOTALL)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
FIELD = re.compile(r"(\w+)\s+(\w+)(?:\[(\w+)\])?")


def refuse(name: str, field: str) -> NoReturn:
    raise SystemExit(f"{name}.lcm: '{field}': no field that the bus can check; see {__file__}")


def visits(name: str, fields: list[str]) -> list[str]:
    """Returns the C++ calls by which a visitor visits `fields` of message `name`, in order."""
    matches = [FIELD.fullmatch(field) for field in fields]
    lengths = {match[3] for match in matches if match and match[3]}
    calls: list[str] = []
    seen: set[str] = set()
    for field, match in zip(fields, matches, strict=True):
        if not match:
            refuse(name, field)
        kind, key, length = match.groups()
        if field == "header_t header":
            calls.append("fields(v, m.header);")
        elif kind not in {*NUMBERS, "string"} or (length and length not in seen):
            refuse(name, field)
        elif length:
            visit = "texts" if kind == "string" else "array"
            calls.append(f'v.{visit}("{key}", m.{key}, m.{length});')
        elif key in lengths and kind != "int32_t":
            refuse(name, field)
        elif key in lengths:
            calls.append(f'v.count("{key}", m.{key});')
        else:
            calls.append(f'v.{"text" if kind == "string" else "scalar"}("{key}", m.{key});')
        seen.add(key)
    return calls


def function(name: str, text: str) -> str:
    """Returns the C++ function fields() of message `name`; `text`: its .lcm file."""
    struct = STRUCT.search(COMMENT.sub("", text))
    if not struct or struct[1] != name:
        raise SystemExit(f"{name}.lcm: no struct {name}")
    found = [" ".join(field.split()) for field in struct[2].split(";") if field.strip()]
    if name != "header_t" and found[:1] != ["header_t header"]:
        refuse(name, found[0] if found else "")
    return FUNCTION.format(name=name, lines="\n".join(f"  {call}" for call in visits(name, found)))


def header(files: dict[str, str]) -> str:
    """Returns the C++ header; `files` maps the names of messages to the texts of .lcm files."""
    names = sorted(files)
    ordered = sorted(names, key=lambda name: name != "header_t")  # the other messages contain it
    head = HEAD.format(
        includes="\n".join(f"#include <rtg_msgs/{name}.hpp>" for name in names),
        types=", ".join(name for name in names if name != "header_t"),
    )
    return head + "".join(function(name, files[name]) for name in ordered) + TAIL


if __name__ == "__main__":
    target, *paths = [Path(word) for word in sys.argv[1:]]
    text = header({path.stem: path.read_text() for path in paths})
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text)
