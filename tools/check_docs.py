#!/usr/bin/env python3
"""Checks that the pages of the tree name what is there.

  - Each link of a page leads to a file of the tree and, behind a '#', to a
    heading of that page.
  - Each path in backticks of the maps (docs/where.md, CONTRIBUTING.md) is there;
    a path ends in '/', or has a '/' and an ending. TYPE stands for any name.
  - CMake, debian/changelog and CHANGELOG.md name the same version.

Usage: tools/check_docs.py
"""

import pathlib
import re
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
MAPS = ("docs/where.md", "CONTRIBUTING.md")

FENCE = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)", re.MULTILINE)
PATH = re.compile(r"`((?:[\w.-]+/)+(?:[\w-]+(?:\.\w+)+)?)`")


def pages():
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
        cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / x for x in listed.split("\0") if x and (ROOT / x).is_file()]


def anchors(page):
    """What the headings of a page are called in a link, as GitHub calls them."""
    result = set()
    for title in HEADING.findall(FENCE.sub("", page.read_text())):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        name = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
        count = 0
        while name + (f"-{count}" if count else "") in result:
            count += 1
        result.add(name + (f"-{count}" if count else ""))
    return result


def broken_links(page):
    text = CODE.sub("", FENCE.sub("", page.read_text()))
    for link in LINK.findall(text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = urllib.parse.unquote(link).partition("#")
        target = (page.parent / path) if path else page
        if not target.exists():
            yield f"the link '{link}' leads to no file"
        elif anchor and target.suffix == ".md" and anchor not in anchors(target):
            yield f"the link '{link}' leads to no heading of that page"


def gone_paths(page):
    for path in PATH.findall(page.read_text()):
        if "TYPE" not in path and not (ROOT / path).exists():
            yield f"'{path}' is not there; name the file that has this now"


def first_version(path, pattern):
    found = re.search(pattern, (ROOT / path).read_text(), re.MULTILINE)
    return found.group(1) if found else "none"


def versions():
    return {path: first_version(path, pattern) for path, pattern in [
        ("CMakeLists.txt", r"project\(roscell VERSION ([\d.]+)"),
        ("debian/changelog", r"^roscell \(([\d.]+)\)"),
        ("CHANGELOG.md", r"^## \[?(\d[\d.]*)"),
    ]}


def main():
    problems = [(page.relative_to(ROOT), x) for page in pages() for x in broken_links(page)]
    problems += [(page, x) for page in MAPS for x in gone_paths(ROOT / page)]
    said = versions()
    if len(set(said.values())) > 1:
        problems.append(("CHANGELOG.md", "versions differ: " + ", ".join(
            f"{path} has {version}" for path, version in said.items())))
    for where, problem in problems:
        print(f"docs: {where}: {problem}")
    if not problems:
        print("docs: each link, and each path of the maps, leads somewhere")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
