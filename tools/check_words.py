#!/usr/bin/env python3
"""Names words that are gone: in identifiers, names of files, and some phrases.

tools/gone_words.tsv lists them, with what stands instead and with names that are
kept because they are stored, cross a wire or are an embedding program's. A single
word of a sentence is not looked at, as most of them are ordinary ones.
Usage: tools/check_words.py
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = ROOT / "tools" / "gone_words.tsv"

CODE = re.compile(
    r"//[^\n]*|/\*.*?\*/"
    r'|R"(?P<end>[^(\s"]*)\(.*?\)(?P=end)"'
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'(?:[^'\\\n]|\\[^\n]){1,4}'"
    r"|\#\s*include[^\n]*"
    r"|(?P<name>[A-Za-z_]\w*)",
    re.DOTALL)
# Where a sentence goes on in the next line: of a comment, a text or a page.
LINE_BREAK = re.compile(r'"\s*\n\s*"|\s*\n\s*(?:///?<?|#|\*|>)?\s*')

# What is said of earlier versions, and what has been written by them.
OF_THE_PAST = re.compile(
    r"^(docs/glossary\.md|docs/upgrade\.md|docs/decisions\.md|CHANGELOG\.md|debian/changelog"
    r"|tools/gone_words\.tsv|test/(data|faults|fuzz/seeds|schemas/examples)/"
    r"|schemas/[^/]*\.json|skills/ros2/messages/)")


class Words:
    def __init__(self):
        self.names, self.phrases, self.kept = {}, {}, set()
        for line in LIST.read_text().splitlines():
            if line and not line.startswith("#"):
                kind, word, instead = line.split("\t")
                if kind == "kept":
                    self.kept.add(word)
                else:
                    {"name": self.names, "phrase": self.phrases}[kind][word] = instead
        self.longest = max(name.count("_") for name in self.names) + 1
        spaced = (re.escape(x) for x in self.phrases)
        self.phrase = re.compile(r"\b(" + "|".join(spaced) + r")\b")

    def gone_in(self, name):
        """The first word that is gone of a name whose parts stand between underscores."""
        if name in self.kept:
            return None
        parts = [x for x in re.split(r"[_.\-]", name.lower()) if x]
        for i in range(len(parts)):
            for size in range(self.longest, 0, -1):
                word = "_".join(parts[i:i + size])
                if word in self.names:
                    return word
        return None


def tracked():
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
    for name in names.decode().split("\0"):
        if name and (ROOT / name).is_file() and not OF_THE_PAST.search(name):
            yield name


def in_path(words, path):
    if path in words.kept:
        return
    for part in path.split("/"):
        if word := words.gone_in(part):
            yield f"{path}: a file's name has '{word}', say {words.names[word]}"
            return


def in_identifiers(words, path, text):
    seen = set()
    for match in CODE.finditer(text):
        name = match["name"]
        if not name or name in seen:
            continue
        seen.add(name)
        if word := words.gone_in(name):
            line = text.count("\n", 0, match.start()) + 1
            yield f"{path}:{line}: '{name}' has '{word}', say {words.names[word]}"


def in_phrases(words, path, text):
    flat = LINE_BREAK.sub(" ", text)
    for phrase in sorted({match[1] for match in words.phrase.finditer(flat)}):
        yield f"{path}: '{phrase}', say {words.phrases[phrase]}"


def gone_from(words, path):
    yield from in_path(words, path)
    try:
        text = (ROOT / path).read_text()
    except UnicodeDecodeError:
        return
    if path.endswith((".cpp", ".hpp", ".h")):
        yield from in_identifiers(words, path, text)
    if path.endswith((".cpp", ".hpp", ".h", ".md", ".sh", ".py", ".js", ".html")):
        yield from in_phrases(words, path, text)


def main():
    words = Words()
    found = [x for path in tracked() for x in gone_from(words, path)]
    for x in found:
        print(f"words: {x}")
    if not found:
        print("words: none is back that is gone")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
