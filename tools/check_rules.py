#!/usr/bin/env python3
"""Checks that the tests which docs/protocols.md names are there.

A rule names what holds it as `test/FOLDER/FILE`: "name of a test". Every
section must name some, and so must every row of a table with a column
"held by".
Usage: tools/check_rules.py
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "protocols.md"

TEXT = r'"(?:[^"\\]|\\.)*"'
CASE = re.compile(rf"TEST_CASE(?:_METHOD)?\((?:\s*[\w:]+,)?\s*((?:{TEXT}\s*)+)")
REFERENCE = re.compile(rf"`(test/[\w/.]+)`:\s*({TEXT}(?:,\s*{TEXT})*)")


def texts(source):
    return [x[1:-1] for x in re.findall(TEXT, source)]


def tests_in(path):
    """The names of the tests in a file, as their programs print them."""
    source = path.read_text()
    if path.suffix == ".sh":
        names = re.findall(r"^test_(\w+)\(\)", source, re.MULTILINE)
        return {name.replace("_", " ") for name in names}
    return {"".join(texts(x)) for x in CASE.findall(source)}


def references(text):
    """Pairs of file and name."""
    flat = re.sub(r"\s+", " ", text)
    for path, names in REFERENCE.findall(flat):
        for name in texts(names):
            yield path, name


def missing(text):
    known = {}
    for path, name in references(text):
        if path not in known:
            file = ROOT / path
            known[path] = tests_in(file) if file.is_file() else set()
        if name not in known[path]:
            yield f'{path} has no test "{name}"'


def unnamed(text):
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        title = section.splitlines()[0]
        if not list(references(section)):
            yield f"the section '{title}' names no test"
    held = False
    for line in text.splitlines():
        if not line.startswith("|"):
            held = False
        elif "held by" in line:
            held = True
        elif held and not set(line) <= set("|-: ") and not list(references(line)):
            yield f"a rule names no test: {line}"


def main():
    text = PAGE.read_text()
    problems = list(missing(text)) + list(unnamed(text))
    for problem in problems:
        print(f"rules: {PAGE.relative_to(ROOT)}: {problem}")
    if not problems:
        print("rules: each names a test that is there")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
