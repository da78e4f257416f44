"""The pages say what is there."""

import ast
import re
import runpy
from pathlib import Path

import pytest
from layering import ROOT, sources
from time_limit import run

PAGES = run("git", "ls-files", "*.md", cwd=ROOT, check=True).stdout.splitlines()
READERS_OWN = {"config/mine.yaml", "msgs/NAME_t.lcm", "tests/fuzz/NAME.cpp"}
CODE = "\n".join(path.read_text() for path in sources(".hpp", ".cpp", ".py"))


def in_backticks(page: str) -> list[str]:
    return re.findall(r"`([^`\n]+)`", (ROOT / page).read_text())


def anchors(page: Path) -> set[str]:
    """Returns the anchors of the headings of a page, as sites make them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    words = [re.sub(r"[^\w\s-]", "", heading).strip().lower() for heading in headings]
    return {re.sub(r"[\s-]+", "-", heading) for heading in words}


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    here = ROOT / page
    wrong = []
    for name, anchor in re.findall(r"\]\((?!https?:)([^)#]*)(?:#([^)]*))?\)", here.read_text()):
        there = here.parent / name if name else here
        if not there.exists() or (anchor and anchor not in anchors(there)):
            wrong.append(f"{name}#{anchor}")
    assert wrong == []


def test_every_page_is_in_the_navigation() -> None:
    """With remarks on results it is the report. docs/site/sources.py has those outside of docs/."""
    lines = (ROOT / "mkdocs.yml").read_text().partition("\nnav:\n")[2].splitlines()
    listed = {line.rpartition(": ")[2] for line in lines if line.endswith(".md")}
    elsewhere = runpy.run_path(str(ROOT / "docs/site/sources.py"))["ELSEWHERE"]
    pages = [page for page in PAGES if not page.endswith("/remarks.md")]
    assert listed == {elsewhere.get(page, page.removeprefix("docs/")) for page in pages}


def test_every_report_is_linked_from_the_page_of_results() -> None:
    text = (ROOT / "docs/results/index.md").read_text()
    reports = {path.parent.name for path in (ROOT / "docs/results").glob("*/report.md")}
    assert reports == set(re.findall(r"\]\((\w+)/report\.md\)", text))


@pytest.mark.parametrize("page", PAGES)
def test_paths_exist(page: str) -> None:
    """Names in backticks that begin with a folder of the repository."""
    folders = "core|msgs|nodes|config|train|tests|docs"
    paths = [name for name in in_backticks(page) if re.fullmatch(rf"({folders})/[\w./]*", name)]
    assert {name for name in paths if not (ROOT / name).exists()} <= READERS_OWN


def test_the_page_of_results_has_the_gates_of_the_benchmarks() -> None:
    """Otherwise it is of an older commit: ./test.sh bench, then tests/bench/results.py make it."""
    page = (ROOT / "tests/bench/RESULTS.md").read_text()
    listed = re.findall(r"^\| `([\w.]+)` \| \S+ \| [<>]=", page, re.MULTILINE)
    gates = runpy.run_path(str(ROOT / "tests/bench/gates.py"))["GATES"]
    assert listed == [name for name, *_ in gates]


def test_every_room_has_a_line_on_what_it_holds() -> None:
    rooms = {
        f"{path.parent.relative_to(ROOT)}/"
        for path in sources(".hpp", ".py")
        if path.relative_to(ROOT).parts[0] in {"core", "nodes", "train"}
        and path.parent not in {ROOT / "core", ROOT / "train" / "rtg", ROOT / "train" / "bindings"}
    }
    table = re.findall(r"^\| (`.*?`) \|", (ROOT / "CONTRIBUTING.md").read_text(), re.MULTILINE)
    named = {name for cell in table for name in re.findall(r"`([^`]+)`", cell)}
    assert rooms - named == set() and len(rooms) > 15


def test_channels_of_the_code_are_in_the_table_and_only_they() -> None:
    processes = "\n".join(
        path.read_text()
        for path in sources(".hpp", ".cpp", ".py")
        if path.relative_to(ROOT).parts[0] != "tests"
    )
    page = (ROOT / "msgs/CHANNELS.md").read_text()
    table = set(re.findall(r"^\| `(RTG_\w+)`", page, re.MULTILINE))
    assert table == set(re.findall(r'"(RTG_[A-Z]+(?:_[A-Z]+)*)"', processes))


def test_every_message_type_has_a_channel() -> None:
    types = {path.stem for path in (ROOT / "msgs").glob("*.lcm")} - {"header_t"}
    assert types == {name for name in in_backticks("msgs/CHANNELS.md") if name in types}


def test_notation_names_what_is_in_the_code() -> None:
    words = {
        word
        for name in in_backticks("core/NOTATION.md")
        if "/" not in name and "Departs" not in name
        for word in re.findall(r"[A-Za-z_]\w*", name)
    }
    assert len(words) > 50
    assert {word for word in words if not re.search(rf"\b{word}\b", CODE)} == set()


def openings() -> list[str]:
    """Lists the first words of all doc comments."""
    found = []
    for path in sources(".hpp", ".cpp", ".py"):
        text = path.read_text()
        if path.suffix == ".py":
            kinds = ast.Module | ast.ClassDef | ast.FunctionDef
            nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)]
            found += [doc for node in nodes if (doc := ast.get_docstring(node))]
        else:
            blocks = re.findall(r"(?:^ *///.*\n)+", text, re.MULTILINE)
            found += [block.strip().removeprefix("///") for block in blocks]
    return [words.split()[0] for words in found]


def test_doc_comments_say_what_a_thing_does_or_is() -> None:
    """Few begin with a word that leaves the reader to find subject and verb."""
    words = openings()
    vague = sum(word in {"What", "Whether", "One", "Of"} for word in words)
    assert len(words) > 1500 and vague <= 0.03 * len(words)
