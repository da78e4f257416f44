"""The fields of a configuration and of a message stand in one file each: a field that is added
there is read, written, sent and checked without a change elsewhere. The tests add one in a copy."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import time_limit
from compiler import BUILD, command_for
from layering import ROOT

SCRIPT = ROOT / "msgs" / "wire_fields.py"

A_SETTING = """#include <cstdio>
#include "core/search/search_config.hpp"
#include "nodes/config/field_writer.hpp"
using namespace rtg;
int main() {
  search::SearchConfig search;
  config::ConfigNode written = config::fields_of(search);
  for (config::ConfigEntry& entry : written.entries)
    if (entry.key == "added") entry.value.scalar = "7";
  config::read_fields(written, "search", search);
  return search.added == 7 ? 0 : 1;
}
"""
A_FIELD = """#include "nodes/bus/wire.hpp"
int main() {
  rtg_msgs::stream_tail_t sent{}, received{};
  sent.n_added = 2;
  sent.added = {3, 4};
  const auto bytes = rtg::bus::encode(sent);
  if (rtg::bus::decode(bytes, received) || received.added != sent.added) return 1;
  sent.n_added = 3;  // more than there are
  try {
    rtg::bus::encode(sent);
  } catch (const std::logic_error&) {
    return 0;
  }
  return 2;
}
"""


def run(folder: Path, text: str, like: str, libraries: list[str]) -> int:
    """The exit status of a program that sees the headers of `folder` before ours, compiled with the
    flags of the file `like`."""
    words, where = command_for(like)
    source, program = folder / "program.cpp", folder / "program"
    source.write_text(text)
    dropped = {k + d for k, word in enumerate(words) if word == "-include" for d in (0, 1)}
    flags = [word for k, word in enumerate(words[1:], 1) if k not in dropped]
    command = [words[0], "-iquote", str(folder), f"-I{folder}", *flags, "-O0", str(source)]
    command += [*(str(BUILD / library) for library in libraries), "-o", str(program)]
    done = time_limit.run(*command, cwd=where)
    assert done.returncode == 0, done.stderr
    return time_limit.run(program).returncode


def changed(path: Path, folder: Path, *changes: tuple[str, str]) -> None:
    """Writes the file with the changes to the same place below `folder`."""
    text = (ROOT / path).read_text()
    for before, after in changes:
        assert text.count(before) == 1
        text = text.replace(before, after)
    (folder / path).parent.mkdir(parents=True, exist_ok=True)
    (folder / path).write_text(text)


def test_a_setting_is_a_change_of_one_file(tmp_path: Path) -> None:
    changed(
        Path("core/search/search_config.hpp"),
        tmp_path,
        ("  bool randomise = false;", "  int added = 3;\n  bool randomise = false;"),
        (
            '    v.flag("randomise"',
            '    v.integer("added", added, 0, 9, "");\n    v.flag("randomise"',
        ),
    )
    assert run(tmp_path, A_SETTING, "/nodes/config/config.cpp", ["nodes/librtg_config.a"]) == 0


def test_a_field_of_a_message_is_a_change_of_one_file(tmp_path: Path) -> None:
    changed(
        Path("msgs/stream_tail_t.lcm"),
        tmp_path,
        ("int8_t sealed;", "int8_t sealed;\n    int32_t n_added;\n    int64_t added[n_added];"),
    )
    files = {path.name: path for path in sorted((ROOT / "msgs").glob("*.lcm"))}
    files["stream_tail_t.lcm"] = tmp_path / "msgs" / "stream_tail_t.lcm"
    lcm_gen = Path(sys.prefix) / "bin" / "lcm-gen"
    words = ["--cpp", "--cpp-std=c++11", "--cpp-hpath", str(tmp_path), *map(str, files.values())]
    time_limit.run(lcm_gen, *words, check=True)
    header = tmp_path / "rtg_msgs" / "wire_fields.hpp"
    time_limit.run(sys.executable, SCRIPT, header, *files.values(), check=True)
    assert run(tmp_path, A_FIELD, "/nodes/bus/wire.cpp", ["nodes/librtg_bus.a"]) == 0


@pytest.mark.parametrize(
    "field",
    ["double x[2]", "boolean x", "double x[3][n]", "int64_t x[later]; int32_t later", "header_t x"],
)
def test_a_field_that_the_bus_cannot_check_is_refused(tmp_path: Path, field: str) -> None:
    file = tmp_path / "odd_t.lcm"
    file.write_text(
        f"package rtg_msgs;\nstruct odd_t\n{{\n    header_t header;\n    {field};\n}}\n"
    )
    words = [sys.executable, SCRIPT, tmp_path / "wire_fields.hpp", file]
    done = time_limit.run(*words)
    assert done.returncode == 1 and not (tmp_path / "wire_fields.hpp").exists()
    assert done.stderr.startswith(f"odd_t.lcm: '{field.split(';')[0]}'")


def test_a_message_without_a_header_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "odd_t.lcm"
    file.write_text("package rtg_msgs;\nstruct odd_t\n{\n    int32_t x; /* no; header */\n}\n")
    words = [sys.executable, SCRIPT, tmp_path / "wire_fields.hpp", file]
    done = time_limit.run(*words)
    assert (done.returncode, done.stderr[:20]) == (1, "odd_t.lcm: 'int32_t ")
