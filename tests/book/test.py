"""The scripts of the book, on small repositories and pages with faults: `python3 tests/book/test.py`."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "book"))

import links
import pages


def written(folder, files):
    for name, text in files.items():
        path = pathlib.Path(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())


class Case(unittest.TestCase):
    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return pathlib.Path(folder.name)


class Pages(Case):
    def book(self, files):
        """The faults of a repository of these files, and its pages in the book."""
        folder = self.folder()
        written(folder, {"docs/book/book.toml": "", "docs/book/book.css": "", **files})
        self.addCleanup(setattr, pages, "ROOT", pages.ROOT)
        pages.ROOT = folder
        faults = pages.Book(folder / "book").write()
        source = folder / "book" / "src"
        return faults, {str(path.relative_to(source)): path.read_bytes() for path in source.rglob("*") if path.is_file()}

    def test_links(self):
        page = (
            "[study](study.toml) [other](../b/README.md#part) [folder](../b) [part](#part) [web](https://example.org)\n"
            "[`mod.rs`](../src/mod.rs) [a test](../tests/one.rs) ![figure](f.svg) [licence](../LICENSE)\n"
            "```console\n$ sensitol check x\n? 2\nerror: [a](b.md)\n```\n[over\ntwo lines](../b/README.md)\n"
        )
        faults, book = self.book(
            {
                "docs/book/SUMMARY.md": "# Part\n\n- [A](../../a/README.md)\n  - [B](../../b/README.md)\n",
                "a/README.md": page,
                "a/study.toml": "x = 1\n",
                "a/f.svg": "<svg/>",
                "b/README.md": "# B\n\n## Part\n",
                "src/mod.rs": "",
                "tests/one.rs": "",
                "LICENSE": "free",
            }
        )
        self.assertEqual(faults, [])
        expected = (
            "[study](study.toml.md) [other](../b/index.md#part) [folder](../b/index.md) [part](#part) [web](https://example.org)\n"
            "`src/mod.rs` a test (`tests/one.rs`) ![figure](f.svg) [licence](../LICENSE.txt)\n"
            "```console\n$ sensitol check x\nerror: [a](b.md)\n```\n[over\ntwo lines](../b/index.md)\n"
        )
        self.assertEqual(book["a/index.md"].decode(), expected)
        self.assertIn(b"```toml\nx = 1\n```", book["a/study.toml.md"])
        self.assertEqual(book["LICENSE.txt"], b"free")
        self.assertEqual(book["a/f.svg"], b"<svg/>")
        summary = "# Part\n\n- [A](a/index.md)\n  - [study.toml](a/study.toml.md)\n  - [B](b/index.md)\n"
        self.assertEqual(book["SUMMARY.md"].decode(), summary)

    def test_faults(self):
        faults, _ = self.book(
            {
                "docs/book/SUMMARY.md": "- [A](../a.md)\n- [B](../b.md)\n- [A](../a.md)\n",
                "docs/a.md": "[gone](gone.toml) [left out](c.md)",
                "docs/c.md": "",
            }
        )
        faults = "\n".join(faults)
        for fault in (
            "docs/a.md stands there twice",
            "there is no docs/b.md",
            "the link to gone.toml: there is no such file",
            "the link to c.md: docs/book/SUMMARY.md does not name that page",
        ):
            self.assertIn(fault, faults)


class Links(Case):
    def checked(self, files):
        folder = self.folder()
        written(folder, files)
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            code = links.main(folder)
        return code, said.getvalue()

    def test_a_right_book(self):
        index = '<a href="a/b.html#x">b</a><a href="#y" id="y">here</a><a href="https://example.org">web</a><img src="f.png"><a href="a/">folder</a>'
        files = {"index.html": index, "a/b.html": '<h1 id="x">', "a/index.html": "", "f.png": b"\x89", "s.css": "a{background:url(f.png)}"}
        self.assertEqual(self.checked(files), (0, "3 pages, 4 links\n"))

    def test_faults(self):
        index = '<a href="gone.html">1</a><a href="#z">2</a><a href="b.html#z">3</a><script src="https://cdn.example.org/x.js"></script><img src="//x.org/f.png">'
        files = {"index.html": index, "b.html": '<pre><code class="language-rust playground">', "s.css": '@import "https://fonts.example.org/f.css";'}
        code, said = self.checked(files)
        self.assertEqual(code, 1)
        for fault in (
            "index.html: gone.html leads nowhere",
            "index.html: #z names no heading of that page",
            "index.html: b.html#z names no heading of that page",
            "index.html: loads https://cdn.example.org/x.js",
            "index.html: loads //x.org/f.png",
            "b.html: a block of code that asks a server",
            "s.css: loads https://fonts.example.org/f.css",
        ):
            self.assertIn(fault, said)


if __name__ == "__main__":
    unittest.main()
