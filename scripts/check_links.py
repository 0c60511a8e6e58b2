# SPDX-License-Identifier: BSD-3-Clause
"""Checks the links of a built site: pages, anchors, pictures and files.

Usage: check_links.py FOLDER    (with index.html)

Links to other sites are counted, not followed.
"""

from __future__ import annotations

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

# Attributes that name something else.
LINKS = {"a": "href", "img": "src", "link": "href", "script": "src", "source": "src"}
# Made for a script of the theme's, and no place on the page.
UNNAMED = {"", "top"}


class Page(HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path: Path) -> None:
        """Read it."""
        super().__init__()
        self.links: list[str] = []
        self.anchors = set(UNNAMED)
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what it names, and what names it."""
        values = dict(attrs)
        self.anchors |= {values.get("id") or "", values.get("name") or ""}
        target = values.get(LINKS.get(tag, ""))
        if target:
            self.links.append(target)


def main() -> None:
    """Entry point."""
    root = Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in sorted(root.rglob("*.html"))}
    inside, outside, broken = 0, set(), []
    for path, page in pages.items():
        for link in page.links:
            if urlsplit(link).scheme or link.startswith("//"):
                outside.add(urldefrag(link).url)
                continue
            inside += 1
            target, anchor = urldefrag(link)
            file = (path.parent / unquote(urlsplit(target).path)).resolve()
            if not target:
                file = path
            found = file.is_file() and file.is_relative_to(root)
            if found and anchor and file in pages:
                found = unquote(anchor) in pages[file].anchors
            if not found:
                broken.append(f"{path.relative_to(root)}: {link}")
    print(f"{len(pages)} pages, {inside} links inside, {len(outside)} pages elsewhere")
    if not pages or broken:
        sys.exit("\n".join(["broken links:", *broken]))


if __name__ == "__main__":
    main()
