# SPDX-License-Identifier: BSD-3-Clause
"""Every block of code in docs/ runs and prints what the page says."""

from __future__ import annotations

import re

import pytest
from docs_pages import DOCS, ROOT, agrees, blocks, name, needs, pages, run_page

import iksel

RUN_HERE = {"python", "sh", "{code-cell}"}
NOT_CODE = {"text", "", "{toctree}", "{eval-rst}", "{doxygenfile}", "{include}"}
"""Other languages have to be written to a file, or be programs in C++."""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """An empty folder to run in, and figures without windows."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")


def judge(page, modules=()):
    """Run a page and compare."""
    for block, got in run_page(page, modules):
        if block.output is not None:
            wanted = block.output.code
            assert agrees(wanted, got), f"{block.place} prints\n{got}and not\n{wanted}"


@pytest.mark.parametrize("page", pages(), ids=name)
def test_page(page):
    """All blocks but those that need other libraries."""
    judge(page)


@pytest.mark.filterwarnings("default")  # of other people's libraries
@pytest.mark.parametrize(
    ("page", "module"),
    [pytest.param(p, m, id=f"{name(p)}-{m}") for p in pages() for m in needs(p)],
)
def test_page_beside(page, module):
    """Also those that need another library."""
    pytest.importorskip(module, reason=f"{name(page)} compares with {module}")
    judge(page, (module,))


@pytest.mark.parametrize("page", pages(), ids=name)
def test_blocks_are_tested(page):
    """What looks like code is run, written to a file, or says why not."""
    for block in blocks(page):
        known = RUN_HERE | NOT_CODE | {"cpp"}
        if block.language not in known and not block.language.startswith("{"):
            assert block.marks, f"{block.place}: who tests {block.language}?"


@pytest.mark.skipif(
    not DOCS.is_dir(), reason="the documentation is in the repository only"
)
def test_reference_is_complete():
    """Every public name has a place in the reference."""
    text = "".join(
        page.read_text("utf-8") for page in (DOCS / "api" / "python").glob("*.md")
    )
    words = set(text.split())
    assert set(iksel.__all__) - {"__version__"} <= words
    headers = "".join(
        page.read_text("utf-8") for page in (DOCS / "api" / "cpp").glob("*.md")
    )
    public = {p.name for p in (ROOT / "cpp/include/iksel").glob("*.hpp")}
    assert public - {"iksel.hpp"} <= set(headers.split())


@pytest.mark.skipif(
    not DOCS.is_dir(), reason="the documentation is in the repository only"
)
def test_what_to_begin_with_is_told_alike():
    """The first page of the reference and help(iksel) list the same names."""
    page = (DOCS / "api" / "python" / "index.md").read_text("utf-8")
    rows = re.findall(r"^\| ([a-z ]+) \| (`.*?) \|", page, flags=re.MULTILINE)
    _, _, listed = iksel.__doc__.partition("To begin with:\n")
    modules = {"spheres", "collision", "reach", "view"}
    told = []
    for line in listed.strip().splitlines():
        job, names = re.split("  +", line.strip())
        names = re.findall(r"\w+", names.replace("iksel.", ""))
        known = [n for n in names if n in modules | set(iksel.__all__)]
        told.append((job, ", ".join(f"`{n}`" for n in known)))
    assert told == rows
    assert len(rows) > 5


def prose(page) -> str:
    """A page without its blocks of code."""
    text = page.read_text("utf-8")
    return re.sub(r"^```\w.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def anchors(page) -> set[str]:
    """What a page's headings are called, as GitHub and Sphinx do."""
    headings = re.findall(r"^#+ (.+)$", prose(page).lower(), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h).strip().replace(" ", "-") for h in headings}


@pytest.mark.parametrize("page", pages(), ids=name)
def test_links(page):
    """Pages, anchors, pictures and files that a page names are there."""
    text = prose(page)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        path, _, anchor = link.partition("#")
        if "://" in path:
            continue
        target = (page.parent / path).resolve() if path else page
        assert target.is_file(), f"{page.relative_to(ROOT)}: no {link}"
        assert not anchor or anchor in anchors(target), f"{page}: no {link}"


def test_every_page_has_a_place():
    """A toctree names each page but the first."""
    named = {DOCS / "index.md"}
    for page in pages():
        for block in blocks(page):
            if block.language == "{toctree}":
                lines = [x for x in block.code.split() if not x.startswith(":")]
                named |= {(page.parent / f"{x}.md").resolve() for x in lines}
    assert set(pages()) <= named


def test_readme_links_lead_somewhere() -> None:
    """To a heading of README.md, or to a file."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    titles = re.findall(r"^#+ (.+)$", prose, flags=re.MULTILINE)
    # As GitHub names headings.
    anchors = {
        re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles
    }
    links = re.findall(r"\]\(([^)\s]+)\)", prose)
    assert sum(link.startswith("#") for link in links) > 5
    for link in links:
        path, _, anchor = link.partition("#")
        if link.startswith("#"):
            assert anchor in anchors, link
        elif not link.startswith("https:"):
            assert (ROOT / path).exists(), link
