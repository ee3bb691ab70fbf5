#!/usr/bin/env python3
"""Draws sentences to be read cold: `docs/draw.py SEED [COUNT]` prints sentences of pages and help, then first lines of rustdoc."""

import random
import re
import subprocess
import sys

seed, count = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 40
files = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split("\n")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def sentences(path):
    """Returns the sentences of a page or a help text, without code, tables and headings."""
    text = re.sub(r"```.*?```|\A---\n.*?\n---\n", "", read(path), flags=re.S)
    text = re.sub(r"^[#|!<].*$", "", text, flags=re.M)
    if path.endswith(".snap"):
        text = re.sub(r"^(?:---.*|exit \d+|source:.*|expression:.*|\$.*|error:.*|.*[Uu]sage:.*|(?:Examples| ).*\$?sensitol .*)$", "", text, flags=re.M)
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:- |\d\. ))|\n(?=\s+-)", text):
        line = re.sub(r"\s+", " ", re.sub(r"\]\([^)]*\)", "]", paragraph)).strip()
        yield from (part for part in re.split(r"(?<=[.!?]) (?=[A-Z`*])", line) if len(part.split()) > 3)


def first_lines(path):
    """Returns the first sentence of every block of rustdoc."""
    for block in re.findall(r"((?:^[ \t]*//[/!].*\n)+)", read(path), flags=re.M):
        line = re.sub(r"\s+", " ", re.sub(r"^\s*//[/!] ?", "", block, flags=re.M).split("\n\n")[0]).strip()
        yield re.split(r"(?<=[.:]) (?=[A-Z`])", line)[0]


pages = [path for path in files if re.match(r"docs/.*\.md$|README\.md$|.*snapshots/documents__help.*\.snap$", path)]
code = [path for path in files if re.match(r"(src|crates/[a-z]+/src)/.*\.rs$", path)]
for paths, drawn in ((pages, sentences), (code, first_lines)):
    # Equal lines, such as an option of several commands, count once.
    found = list({line: path for path in paths for line in drawn(path)}.items())
    print(f"# {count} of {len(found)}, seed {seed}")
    for line, path in random.Random(seed).sample(found, count):
        print(f"- {line}  ({path})")
