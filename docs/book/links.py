"""Checks the built book: every link and anchor leads somewhere, and nothing is loaded from a network.

usage: python3 docs/book/links.py FOLDER
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes by which a browser loads something, in contrast to the `href` of `a`, which a reader follows.
LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("object", "data")}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loaded, self.faults = set(), [], [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)
            elif tag == "a" and name == "href":
                self.links.append(value)
            elif (tag, name) in LOADED:
                self.loaded.append(value)
            elif name == "class" and "playground" in (value or "").split():
                self.faults.append("a block of code that asks a server")


def main(folder):
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    faults, links = [], 0
    for path, page in pages.items():
        name = path.relative_to(folder)
        faults += [f"{name}: {fault}" for fault in page.faults]
        faults += [f"{name}: loads {link}" for link in page.loaded if remote(link)]
        # The page for what is not found stands at any address.
        if name == Path("404.html"):
            continue
        for link in page.links + [link for link in page.loaded if not remote(link)]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            links += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                faults.append(f"{name}: {link} leads nowhere")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{name}: {link} names no heading of that page")
    for path in sorted(folder.rglob("*.css")):
        for found in re.findall(r"(?:url\(|@import)\s*[\"']?([^\"')\s;]+)", path.read_text(encoding="utf-8")):
            if remote(found):
                faults.append(f"{path.relative_to(folder)}: loads {found}")
    for fault in faults:
        print(f"docs/book/links.py: {fault}", file=sys.stderr)
    print(f"{len(pages)} pages, {links} links")
    return 1 if faults or not links else 0


def remote(link):
    return bool(re.match(r"(https?:)?//", link))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(Path(sys.argv[1]).resolve()))
