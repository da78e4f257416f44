"""Pages that lie outside of docs/, and links between files of the repository as links of the site.

A page has two paths: where its file lies from the root of the repository (`msgs/CHANNELS.md`), and
where it lies in the site (`channels.md`). Links in the files are relative to the former.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

ELSEWHERE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "core/NOTATION.md": "notation.md",
    "msgs/CHANNELS.md": "channels.md",
    "tests/bench/RESULTS.md": "benchmarks.md",
    "train/SUMMARY.md": "summary.md",
}
_FILE_OF = {page: file for file, page in ELSEWHERE.items()}
_LINK = re.compile(r"(\]\()(?!\w+:|#)([^)\s#]+)((?:#[^)\s]*)?\))")
_FENCE = re.compile(r"(^ *```.*?^ *```)", re.MULTILINE | re.DOTALL)


def file_of(page: str) -> str:
    """Returns where the file of a page of the site lies in the repository."""
    return _FILE_OF.get(page, f"docs/{page}")


def page_of_folder(folder: str) -> str:
    """Returns the page of the headers of a folder of core/ or nodes/."""
    return f"cpp/{folder.replace('/', '_')}.md"


def in_site(file: str) -> str:
    """Returns where a file of the repository lies in the site; a header with its anchor."""
    if file in ELSEWHERE:
        return ELSEWHERE[file]
    if file.startswith("docs/"):
        return file.removeprefix("docs/")
    if re.fullmatch(r"(core|nodes)/.*\.hpp", file):
        folder, name = posixpath.split(file)
        return f"{page_of_folder(folder)}#{name}"
    return f"files/{file}"


def _outside_fences(change: Callable[[str], str], text: str) -> str:
    parts = _FENCE.split(text)
    return "".join(part if k % 2 else change(part) for k, part in enumerate(parts))


def _target(page: str, link: str) -> str:
    """Returns the path from the root of what a page of the site links to."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(file_of(page)), link))


def linked_files(page: str, text: str) -> Iterator[str]:
    """Yields the files that the text of `page` links to, from the root of the repository."""
    for part in _FENCE.split(text)[::2]:
        for _, link, _ in _LINK.findall(part):
            yield _target(page, link)


def with_links_of_the_site(page: str, text: str) -> str:
    """Returns the text of `page` with links to where the files lie in the site."""

    def changed(match: re.Match[str]) -> str:
        there, mark, anchor = in_site(_target(page, match[2])).partition("#")
        relative = posixpath.relpath(there, posixpath.dirname(page) or ".")
        end = f"#{anchor})" if mark else match[3]
        return f"{match[1]}{relative}{end}"

    return _outside_fences(lambda part: _LINK.sub(changed, part), text)
