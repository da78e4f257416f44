"""The references that docs/site makes of the code."""

import re

import configuration
import environments
import headers
import messages
import programs
import pytest
import rtg
import sources
import tables
from rtg import _core, paths


def test_a_cell_is_one_line_without_bars() -> None:
    assert tables.cell("a |b|\n  c") == "a \\|b\\| c"


def test_keys_have_value_range_and_meaning() -> None:
    text = "search:\n  branches: 4  # other headings; also more; 0 to 359\n  new: true  # on; off\n"
    assert configuration.keys(text) == [
        configuration.Key("search", "branches", "4", "0 to 359", "other headings; also more"),
        configuration.Key("search", "new", "true", "true, false", "on; off"),
    ]


def test_nested_keys_have_dots_and_what_is_no_value_is_left_out() -> None:
    text = "task:\n  bodies:  # one\n    - {name: a}\n  push:\n    headings: 48  # many; 1 to 360\n"
    assert configuration.keys(text) == [
        configuration.Key("task", "push.headings", "48", "1 to 360", "many"),
    ]


def test_every_key_of_the_loader_is_in_the_reference() -> None:
    page = configuration.reference()
    config = _core.Config.from_text(f"task: {paths.CONFIG / 'gathering.yaml'}")
    for section in ("physics", "forward", "reverse", "search", "train", "run"):
        names = [name for name in dir(getattr(config, section)) if not name.startswith("_")]
        part = page.split(f"## `{section}`\n")[1].split("\n## ")[0]
        assert names
        for name in names:
            (row,) = (line for line in part.splitlines() if line.startswith(f"| `{name}` |"))
            assert all(cell.strip() for cell in row.split("|")[-3:-1]), row
    assert "| `workers` | `0` |" in page  # not the number of cores that the page was made on
    assert "| `batch` | `128` | `512` |" in page


def test_methods_have_the_settings_in_which_they_differ() -> None:
    rows = dict(line.split(" | ", 1) for line in configuration.methods().splitlines()[2:])
    assert list(rows) == [f"| `{method}`" for method in _core.METHODS]
    assert "`search.generator=naive`" in rows["| `ddqn_naive`"]
    assert "`" not in rows["| `ddqn_rtg`"]


def test_environments_have_their_sizes_and_entries() -> None:
    size = len(rtg.load_task("push_t").observation_names)
    assert f"| `RTG/PushT-v0` | `push_t` | 100 | 48 | {size} |" in environments.ids()
    page = environments.observations()
    assert f'??? note "push_t: {size} entries"' in page
    assert "| x to robot | half a stride |".replace("| x", "| t x") in page
    assert "| robot x | half of `push.arena` |" in page
    assert page.count("??? note") == len(rtg.ENVIRONMENTS)


def test_messages_have_all_fields_with_their_meaning() -> None:
    page = messages.reference()
    for file in (paths.ROOT / "msgs").glob("*.lcm"):
        assert f"## `{file.stem}`" in page
    assert "| `end[n_poses]` | `double` | p_{t+1}, per candidate and body: x, y" in page
    assert page.index("## `header_t`") < page.index("## `node_status_t`")


def test_a_message_without_its_struct_is_refused() -> None:
    with pytest.raises(ValueError, match="no struct odd_t with a comment"):
        messages._type("package rtg_msgs;\nstruct odd_t\n{\n    int8_t x;\n}\n", "odd_t")
    with pytest.raises(ValueError, match="a field that is not understood"):
        messages._type("// Odd.\nstruct odd_t\n{\n    int8_t x, y;\n}\n", "odd_t")


def test_comments_of_headers_are_prose_formulas_and_lists() -> None:
    comment = "/// The gap *g* of `x_y`:\n///\n///   b(g) = 1\n///\n///  - One\n///    more.\n"
    assert headers.prose(comment) == (
        "The gap \\*g\\* of `x_y`:\n\n```text\n  b(g) = 1\n```\n\n- One\n    more."
    )


def test_every_folder_of_headers_has_a_page() -> None:
    pages = headers.pages()
    assert {"cpp/core_energy.md", "cpp/core_reverse_sqp.md", "cpp/nodes_config.md"} <= set(pages)
    energy = pages["cpp/core_energy.md"]
    assert "## barrier.hpp { #barrier.hpp }" in energy and "```cpp\nstruct Barrier\n```" in energy
    assert all(f"({page})" in headers.index() for page in pages)


def test_examples_have_text_output_and_picture() -> None:
    page = programs.reference()
    for program in (paths.ROOT / "train" / "rtg" / "examples").glob("[0-9]*.py"):
        assert f"## {program.stem}\n" in page and f"](figures/{program.stem}." in page


def test_readers_of_the_files_are_told_how_to_see_what_is_made() -> None:
    pages = "".join(page.read_text() for page in (paths.ROOT / "docs").glob("*.md"))
    told = re.findall(r"^<!-- made: \w+ -->\n(\*The site has .*\*)$", pages, re.MULTILINE)
    assert len(told) == pages.count("<!-- made:") > 6
    for line in told:
        assert "docs/requirements.txt" in line and "`python -m mkdocs serve`" in line
        where = re.findall(r"`([^`]+)`", line.partition("; here, ")[2])
        files = [name for name in where if "/" in name and not name.startswith("./run.sh")]
        assert where and all((paths.ROOT / name).exists() for name in files)


@pytest.mark.parametrize(
    ("file", "place"),
    [
        ("README.md", "index.md"),
        ("docs/tasks.md", "tasks.md"),
        ("core/energy/barrier.hpp", "cpp/core_energy.md#barrier.hpp"),
        ("config/gate.png", "files/config/gate.png"),
    ],
)
def test_files_have_a_place_in_the_site(file: str, place: str) -> None:
    assert sources.in_site(file) == place


def test_links_between_files_become_links_of_the_site() -> None:
    text = "[a](../msgs/CHANNELS.md#rules) ![b](figures/c.png) [d](https://e.org) [f](#g)\n"
    assert sources.with_links_of_the_site("processes.md", text) == (
        "[a](channels.md#rules) ![b](figures/c.png) [d](https://e.org) [f](#g)\n"
    )
    assert sources.with_links_of_the_site("index.md", "[h](core/energy/barrier.hpp)") == (
        "[h](cpp/core_energy.md#barrier.hpp)"
    )
    fenced = "```\n[a](b.md)\n```\n"
    assert sources.with_links_of_the_site("tutorials/failure.md", fenced) == fenced
    assert list(sources.linked_files("tutorials/failure.md", "[a](../tasks.md)\n" + fenced)) == [
        "docs/tasks.md"
    ]
