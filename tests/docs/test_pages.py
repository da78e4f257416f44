"""The README and the pages of docs/: what stands there as code is legal, and runs."""

import ast
import importlib
import importlib.util
import itertools
import os
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
import rtg
from rtg import _core, cli, paths

PAGES = [
    paths.ROOT / "README.md",
    paths.ROOT / "CONTRIBUTING.md",
    *sorted((paths.ROOT / "docs").glob("*.md")),
    *sorted((paths.ROOT / "docs" / "tutorials").glob("*.md")),
    paths.ROOT / "docs" / "results" / "index.md",
]
WORDS = 700  # of the README: what stands between blanks outside of code blocks, tables and targets
SLOW_TASKS = ("push_t", "gathering")
PLACEHOLDERS = re.compile(r"[A-Z]+(\.\w+)?|\.\.\.|runs/\S+|\S+\.png|(docs/results/)?mine")


def fenced(text: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def ids(path: Path) -> str:
    return str(path.relative_to(paths.ROOT))


def test_the_readme_is_short() -> None:
    text = re.sub(r"^```.*?^```", "", (paths.ROOT / "README.md").read_text(), flags=re.S | re.M)
    lines = [line for line in text.splitlines() if not line.startswith(("|", "    "))]
    words = re.sub(r"\]\([^)]*\)", "]", "\n".join(lines)).split()
    assert 300 < len(words) <= WORDS


@pytest.fixture
def tiny(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Puts a tiny task in the place of those that take long. The folder has config/ as a clone."""
    load = rtg.load_task
    file = paths.CONFIG / "tests" / "tiny.yaml"
    small = ["train.eval_episodes=3", "search.transitions=600"]

    def load_tiny(task: str) -> rtg.Task:
        return load(file, small) if task in SLOW_TASKS else load(Path(task))

    monkeypatch.setattr(rtg, "load_task", load_tiny)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "config").symlink_to(paths.CONFIG)
    return tmp_path


PROGRAMS = [page for page in PAGES if fenced(page.read_text(), "python")]


def test_pages_have_programs() -> None:
    assert len(PROGRAMS) >= 5


def skip_without(program: str) -> None:
    """Skips a test whose program imports a package of an extra that is not installed."""
    project = tomllib.loads((paths.ROOT / "pyproject.toml").read_text())["project"]
    lines = [line for extra in project["optional-dependencies"].values() for line in extra]
    extras = {re.split(r"[^\w-]", line)[0].replace("-", "_").lower() for line in lines}
    for node in ast.walk(ast.parse(program)):
        named = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        named += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        for module in {name.partition(".")[0] for name in named} & extras:
            pytest.importorskip(module, reason="a package of an extra")


@pytest.mark.parametrize("page", PROGRAMS, ids=ids)
def test_the_blocks_of_python_run(page: Path, tiny: Path) -> None:
    names: dict[str, object] = {}
    for block in fenced(page.read_text(), "python"):
        skip_without(block)
        exec(compile(block, page.name, "exec"), names)
    if page.name == "README.md":
        assert isinstance(names["policy"], rtg.Policy)
        assert 0 <= int(str(names["action"])) < 48


def test_the_tasks_in_yaml_are_legal() -> None:
    found = [block for page in PAGES for block in fenced(page.read_text(), "yaml")]
    for text in found:
        _core.Config.from_text(text, "page")
    assert len(found) >= 2


def test_the_task_of_the_tutorial_is_that_of_the_file_and_of_the_example() -> None:
    page = paths.ROOT / "docs" / "tutorials" / "own_task.md"
    program = importlib.import_module("rtg.examples.06_own_task")
    file = paths.CONFIG / "examples" / "shelf.yaml"
    for text in (*fenced(page.read_text(), "yaml"), program.TASK):
        assert _core.Config.from_text(text, "page").yaml == _core.Config.from_file(file).yaml


def commands(page: Path) -> Iterator[list[str]]:
    """Yields the words of the commands of a page: indented lines and spans in backticks."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    lines = re.sub(r"\n {8,}(?=[\[-])", " ", text).splitlines()
    found = [line[4:].split("  ")[0] for line in lines if line.startswith("    ")]
    found += re.findall(r"`((?:\./|python |--)[^`\n]+)`", text)
    for command in found:
        first = re.sub(r"( \| [\w.]+)+", "", command.split(" > ")[0])  # of alternatives
        yield shlex.split(re.sub(r"[\[\]]|\.\.\.", " ", first), comments=True)


COMMANDS = [(page, words) for page in PAGES for words in commands(page) if words]


def of(program: str) -> list[tuple[Path, list[str]]]:
    found = [(page, words[1:]) for page, words in COMMANDS if words[0] == program]
    assert found
    return found


def help_of(tool: str, capsys: pytest.CaptureFixture[str]) -> str:
    assert cli.main([tool, "--help"] if tool != "run" else ["--help"]) == 0
    return capsys.readouterr().out


def check_setting(word: str) -> None:
    """Raises ConfigError if `word` is no legal key=value."""
    if word not in ("KEY=VALUE", "section.key=value", "KEY=V1,V2", "KEY="):
        key, _, value = word.partition("=")
        text = f"task: {paths.CONFIG / 'gathering.yaml'}"
        more = {"physics.damping": ["physics.inertia=true"]}.get(key, [])
        _core.Config.from_text(text, "page", [*more, f"{key}={value.split(',')[0]}"])


def test_run_sh_takes_what_the_pages_say(capsys: pytest.CaptureFixture[str]) -> None:
    flags = {tool: set(re.findall(r"--[\w-]+", help_of(tool, capsys))) for tool in cli._TOOLS}
    for page, words in of("./run.sh"):
        tool = words[0] if words and words[0] in cli._TOOLS else "run"
        given = {word for word in words if word.startswith("--")} - {"--help"}
        assert given <= flags[tool], page
        for flag, value in itertools.pairwise(words):
            if flag == "--set":
                check_setting(value)
            if flag == "--method":
                assert value in {*_core.METHODS, "ID"}, page
        if tool not in ("run", "check", "reproduce"):  # which take tasks
            continue
        named = [word for k, word in enumerate(words) if not words[k - 1].startswith("--")]
        for word in [word for word in named if not word.startswith("--") and word != tool]:
            known = word in paths.task_names() or (paths.ROOT / word).is_file()
            assert known or PLACEHOLDERS.fullmatch(word), (page, word)


def test_settings_in_backticks_are_legal() -> None:
    found = [words[0] for _, words in of("--set") if words]
    for setting in found:
        check_setting(setting)
    assert len(found) > 5


def test_flags_in_backticks_are_flags(capsys: pytest.CaptureFixture[str]) -> None:
    known = "".join(help_of(tool, capsys) for tool in cli._TOOLS)
    known += (paths.ROOT / "tests" / "bench" / "true_pushes.cpp").read_text()
    others = {"--prefix", "--strict", "--help"}
    for page, words in COMMANDS:
        if words[0].startswith("--") and words[0] not in others:
            assert re.search(rf"{words[0]}\b", known), (page, words)


def test_test_sh_takes_what_the_pages_say() -> None:
    text = (paths.ROOT / "test.sh").read_text()
    legal = set(re.findall(r"^#   \./test\.sh (\w+)", text, re.MULTILINE))
    named = {word for _, words in of("./test.sh") for word in words if not word.startswith("--")}
    assert named <= legal and named
    listed = re.search(
        r"\./test\.sh \[([\w |]+)\]", (paths.ROOT / "docs" / "command_line.md").read_text()
    )
    assert listed is not None and set(listed[1].split(" | ")) == legal


def test_modules_and_programs_exist() -> None:
    modules = {words[2] for _, words in COMMANDS if words[1:2] == ["-m"]}
    for module in modules - {"mkdocs", "pip", "pytest"}:
        assert importlib.util.find_spec(module), module
    assert len(modules) > 4
    programs = {words[0] for _, words in COMMANDS if words[0].startswith("build/release/")}
    built = {path.parent.name for path in (paths.ROOT / "nodes").glob("*/main.cpp")}
    legal = {f"build/release/nodes/rtg_{name}" for name in built}
    assert programs == {*legal, "build/release/tests/true_pushes"}
    assert (paths.ROOT / "tests" / "bench" / "true_pushes.cpp").is_file()


def test_files_that_python_runs_exist() -> None:
    files = {words[1] for _, words in COMMANDS if words[0] == "python" and words[1].endswith(".py")}
    assert "docs/site/figures.py" in files
    for file in files:
        ast.parse((paths.ROOT / file).read_text())


def test_the_examples_have_their_pictures_and_output() -> None:
    made = os.listdir(paths.ROOT / "docs" / "figures")
    for program in (paths.ROOT / "train" / "rtg" / "examples").glob("[0-9]*.py"):
        assert f"{program.stem}.txt" in made
        assert {f"{program.stem}.png", f"{program.stem}.gif"} & set(made)
