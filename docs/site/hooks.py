"""The functions that MkDocs calls while it builds the site.

- Pages that lie outside of docs/, files that pages link to, and the C++ reference are added.
- Links between files of the repository become links of the site.
- A line `<!-- made: NAME -->`, and the one below it, which tells readers of the file where to look,
  are replaced by what the code says: see _MADE.
- Formulas become MathML.
"""

from __future__ import annotations

import re
from pathlib import Path

import configuration
import environments
import headers
import mathematics
import messages
import programs
import sources
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

_MADE = {
    "configuration": configuration.reference,
    "cpp": headers.index,
    "environments": environments.ids,
    "examples": programs.reference,
    "messages": messages.reference,
    "methods": configuration.methods,
    "observations": environments.observations,
    "python": str,  # nothing: mkdocstrings replaces the names below
}
_MARK = re.compile(r"^<!-- made: (\w+) -->\n.+$", re.MULTILINE)


def _from(config: MkDocsConfig, file: str) -> File:
    there = sources.in_site(file)
    return File.generated(config, there, abs_src_path=str(sources.ROOT / file))


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Adds the pages from outside of docs/, what is linked to there, and the C++ reference."""
    for file in sources.ELSEWHERE:
        files.append(_from(config, file))
    linked = set[str]()
    for page in files.documentation_pages():
        text = Path(page.abs_src_path or "").read_text()
        linked.update(sources.linked_files(page.src_uri, text))
    for file in sorted(linked):
        if sources.in_site(file).startswith("files/") and (sources.ROOT / file).is_file():
            files.append(_from(config, file))
    for place, text in headers.pages().items():
        files.append(File.generated(config, place, content=text))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Puts links of the site, and what the code says, in their places."""
    if page.file.src_uri.startswith("cpp/"):
        return markdown
    text = sources.with_links_of_the_site(page.file.src_uri, markdown)
    return _MARK.sub(lambda match: _MADE[match[1]](), text)


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Draws formulas."""
    return mathematics.drawn(html)
