"""The site is built without a warning, and needs nothing from other hosts."""

import html.parser
import os
import re
import sys
from pathlib import Path

import pytest
from rtg import _core, paths
from time_limit import run

REASON = "the site has packages of its own: docs/requirements.txt"
for module in ("mkdocs", "material", "mkdocstrings", "pymdownx", "latex2mathml"):
    pytest.importorskip(module, reason=REASON)

LOADED = {  # element -> attributes that a browser follows by itself
    "audio": ("src",),
    "iframe": ("src",),
    "img": ("src", "srcset"),
    "link": ("href",),
    "object": ("data",),
    "script": ("src",),
    "source": ("src", "srcset"),
    "video": ("src",),
}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", folder]
    train = str(paths.ROOT / "train")
    env = {**os.environ, "PYTHONPATH": train, "NO_MKDOCS_2_WARNING": "1"}
    done = run(*command, cwd=paths.ROOT, env=env)
    assert done.returncode == 0, done.stderr[-4000:]
    return folder


class Loaded(html.parser.HTMLParser):
    """Collects what a browser loads with a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value or "" for key, value in attrs if key in LOADED.get(tag, ())]


def loaded(page: Path) -> list[str]:
    parser = Loaded()
    parser.feed(page.read_text())
    return parser.found


def test_pages_load_nothing_from_other_hosts(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 40
    for page in pages:
        found = loaded(page)
        assert len(found) > 3
        assert [name for name in found if re.match(r"(\w+:)?//", name)] == [], page
        # the theme would fetch the program that draws such diagrams
        assert 'class="mermaid"' not in page.read_text()


def test_styles_load_nothing_from_other_hosts(site: Path) -> None:
    styles = list(site.rglob("*.css"))
    assert styles
    for style in styles:
        assert not re.search(r"(url\(|@import)\s*['\"]?(\w+:)?//", style.read_text()), style


def test_what_pages_load_is_there(site: Path) -> None:
    for page in site.rglob("*.html"):
        if page.name != "404.html":  # whose paths begin at the root of a server
            names = [name.partition("?")[0].partition("#")[0] for name in loaded(page)]
            missing = [name for name in names if name and not (page.parent / name).exists()]
            assert missing == [], page


def test_formulas_are_drawn_without_scripts(site: Path) -> None:
    page = (site / "algorithms.html").read_text()
    assert page.count("<math ") > 40
    for page in site.rglob("*.html"):
        assert 'class="arithmatex"' not in page.read_text(), page


def test_no_mark_of_a_reference_is_left(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text()
        assert "<!-- made:" not in text and "The site has" not in text, page


def test_the_references_are_whole(site: Path) -> None:
    python = (site / "python.html").read_text()
    for name in ("rtg.Task.observation", "rtg.ReverseSimulator.solve", "rtg._core.Task"):
        assert f'id="{name}"' in python
    configuration = (site / "configuration.html").read_text()
    for section in ("PhysicsConfig", "ReverseConfig", "SearchConfig", "TrainConfig", "RunConfig"):
        keys = [key for key in vars(getattr(_core, section)) if not key.startswith("_")]
        assert len(keys) > 5
        assert [key for key in keys if f"<code>{key}</code>" not in configuration] == []
    messages = (site / "messages.html").read_text()
    for file in (paths.ROOT / "msgs").glob("*.lcm"):
        assert f"<code>{file.stem}</code></h2>" in re.sub(r"<a .*?</a>", "", messages)
    headers = "".join(page.read_text() for page in (site / "cpp").glob("*.html"))
    for folder in ("core", "nodes"):
        for header in (paths.ROOT / folder).rglob("*.hpp"):
            assert f"All of {header.relative_to(paths.ROOT)}" in headers
