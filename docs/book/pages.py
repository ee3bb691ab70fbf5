"""Copies the pages that SUMMARY.md names, and the files that they link to, into a folder from which mdBook builds the book.

usage: python3 docs/book/pages.py FOLDER

Pages keep their places relative to each other, so that a link is the same on a code host and in the book. Differences:

- README.md is index.md, which a browser opens for a folder.
- A linked text file, such as a study, becomes a page of its own below the page of its folder: browsers download .toml.
- A link to source code becomes its path: the book has no source code.
- The exit codes of console blocks (`? 1`), which are for the tests, are left out.
"""

import os
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SUMMARY = Path("docs/book/SUMMARY.md")
ENTRY = re.compile(r"^(?P<indent> *)(?P<item>- )?\[(?P<title>[^\]]*)\]\((?P<target>[^)]*)\)$")
# A link or an image. Its text may have brackets in it, and may go over the end of a line.
LINK = re.compile(r"(?P<image>!?)\[(?P<text>(?:[^\[\]]|\[[^\[\]]*\])*)\]\((?P<target>[^()\s]+)\)")
EXTERNAL = re.compile(r"^[a-z]+:")
IMAGES = {".png", ".svg"}
# Endings of texts that are copied as .txt: a licence has none, and the citation stands below the first page, which has no pages below it.
PLAIN = {"", ".cff"}
# Languages that mdBook highlights, by the ending of a file; others are shown plainly.
LANGUAGES = {".toml": "toml", ".py": "python", ".json": "json", ".yaml": "yaml", ".c": "c", ".csv": "text", ".m": "text"}
# Folders of the source code.
SOURCES = ("src", "crates", "docs/book", "tests", "fuzz", "web", "commands", ".ci", "python/src", "python/tests", "python/tools")


class Broken(Exception):
    """What is wrong with a page."""


def normal(path):
    return Path(os.path.normpath(path))


def entries():
    """The lines of SUMMARY.md: each as it is, or an entry with its page, relative to the repository."""
    for line in (ROOT / SUMMARY).read_text(encoding="utf-8").splitlines():
        found = ENTRY.match(line)
        if found:
            yield found, normal(SUMMARY.parent / found["target"])
        else:
            yield line, None


def placed(page):
    """Where a page of the repository lies in the book."""
    return page.with_name("index.md") if page.name == "README.md" else page


class Book:
    def __init__(self, folder):
        self.folder = folder
        self.pages = [page for _, page in entries() if page]
        self.files = {}  # a file of text: the page that it stands below
        self.faults = []

    def write(self):
        for page in sorted({page for page in self.pages if self.pages.count(page) > 1}):
            self.faults.append(f"{SUMMARY}: {page} stands there twice")
        for page in dict.fromkeys(self.pages):
            if not (ROOT / page).is_file():
                self.faults.append(f"{SUMMARY}: there is no {page}")
            else:
                text = (ROOT / page).read_text(encoding="utf-8")
                self.put(placed(page), self.converted(page, text))
        for file in self.files:
            self.put(Path(f"{file}.md"), self.shown(file))
        self.put(Path("SUMMARY.md"), self.summary())
        for name in ("book.toml", "book.css"):
            shutil.copy(ROOT / SUMMARY.parent / name, self.folder / name)
        return self.faults

    def put(self, path, text):
        target = self.folder / "src" / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")

    def converted(self, page, text):
        """A page with its links as the book has them. Blocks of code stay as they are, but for exit codes."""
        parts = re.split(r"(?ms)^( *```.*?^ *```$)", text)
        for index, part in enumerate(parts):
            if index % 2 == 0:
                parts[index] = LINK.sub(lambda link: self.link(page, link), part)
            elif part.lstrip().startswith("```console"):
                parts[index] = re.sub(r"(?m)^\? \w+\n", "", part)
        return "".join(parts)

    def link(self, page, link):
        target, _, anchor = link["target"].partition("#")
        if EXTERNAL.match(link["target"]) or not target:
            return link[0]
        try:
            found = self.found(page, normal(page.parent / target))
        except Broken as fault:
            self.faults.append(f"{page}: the link to {link['target']}: {fault}")
            return link[0]
        if found is None:
            return path_instead(link["text"], normal(page.parent / target))
        place = os.path.relpath(found, page.parent) + (f"#{anchor}" if anchor else "")
        return f"{link['image']}[{link['text']}]({place})"

    def found(self, page, target):
        """The place in the book to which a link leads, or None where it leads to source code."""
        if not (ROOT / target).exists():
            raise Broken("there is no such file")
        if target in self.pages:
            return placed(target)
        if (ROOT / target).is_dir():
            index = target / "README.md"
            return placed(index) if index in self.pages else None
        if any(target.is_relative_to(folder) for folder in SOURCES):
            return None
        if target.suffix == ".md":
            raise Broken(f"{SUMMARY} does not name that page")
        readable = text_of(target)
        if readable is None or target.suffix in IMAGES or target.suffix in PLAIN:
            # Browsers show .txt, and download other endings.
            place = Path(f"{target}.txt") if target.suffix in PLAIN else target
            copy = self.folder / "src" / place
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / target, copy)
            return place
        index = target.parent / "README.md"
        self.files.setdefault(target, index if index in self.pages else page)
        return Path(f"{target}.md")

    def shown(self, file):
        """A file of text as a page."""
        text = text_of(file).rstrip("\n")
        language = LANGUAGES.get(file.suffix, "text")
        folder = self.files[file]
        back = os.path.relpath(placed(folder), file.parent)
        return f"# {file.name}\n\n`{file}`, of [this page]({back}).\n\n```{language}\n{text}\n```\n"

    def summary(self):
        lines = []
        for entry, page in entries():
            if page is None:
                lines.append(entry)
                continue
            lines.append(f"{entry['indent']}{entry['item'] or ''}[{entry['title']}]({placed(page)})")
            below = sorted(file for file, owner in self.files.items() if owner == page)
            if below and not entry["item"]:
                self.faults.append(f"{page}: links to {below[0]}, and nothing can stand below an entry without a hyphen")
            lines += [f"{entry['indent']}  - [{file.name}]({file}.md)" for file in below]
        return "\n".join(lines) + "\n"


def text_of(file):
    try:
        return (ROOT / file).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None


def path_instead(text, path):
    """The text of a link to source code, with the path unless the text is the end of it."""
    plain = text.strip("`")
    return f"`{path}`" if str(path).endswith(plain) else f"{text} (`{path}`)"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = Book(Path(sys.argv[1])).write()
    for fault in faults:
        print(f"docs/book/pages.py: {fault}", file=sys.stderr)
    sys.exit(1 if faults else 0)
