#!/usr/bin/env python3
"""Checks that the tests which docs/protocols.md names are there.

One table there says for each rule what holds it, as `test/FOLDER/FILE`: "name of
a test". It must speak of every section, and of every row of a table of failures.
And that each deliberate fault, test/faults/*.patch, can still be built in.
Usage: tools/check_rules.py
"""

import pathlib
import re
import subprocess
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


def rows_of(text, headers):
    """The rows of the tables whose first column has one of these headers."""
    wanted = False
    for line in text.splitlines():
        cells = [x.strip() for x in line.strip("|").split("|")]
        if not line.startswith("|"):
            wanted = False
        elif cells[0] in headers:
            wanted = True
        elif wanted and not set(line) <= set("|-: "):
            yield cells


def unheld(text):
    """Sections and failures of which the table says nothing."""
    rules = {row[0]: row[-1] for row in rows_of(text, ["rule"])}
    for rule, held_by in rules.items():
        if not list(references(held_by)):
            yield f"the rule '{rule}' names no test"
    named = {match[1] for match in map(re.compile(r"\*\*(.*)\*\*").match, rules) if match}
    for title in re.findall(r"^## (.*)", text, re.MULTILINE):
        failures = [row[0] for row in rows_of(section(text, title), ["what", "what breaks"])]
        if title != "What holds these rules" and not failures and title not in named:
            yield f"no rule of the section '{title}' is in the table"
        yield from (f"'{x}' is not in the table" for x in failures if x not in rules)


def section(text, title):
    return re.split(r"^## ", text.split(f"## {title}\n")[1], maxsplit=1, flags=re.MULTILINE)[0]


def outdated_faults():
    """Patches that do not apply to the sources as they are."""
    for path in sorted((ROOT / "test" / "faults").glob("*.patch")):
        check = subprocess.run(["git", "apply", "--check", path], cwd=ROOT,
                               capture_output=True, check=False)
        if check.returncode != 0:
            yield f"{path.relative_to(ROOT)} does not apply any more"


def main():
    text = PAGE.read_text()
    problems = [f"{PAGE.relative_to(ROOT)}: {x}"
                for x in list(missing(text)) + list(unheld(text))]
    problems += outdated_faults()
    for problem in problems:
        print(f"rules: {problem}")
    if not problems:
        print("rules: each names a test that is there, and each fault can be tried")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
