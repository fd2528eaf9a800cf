#!/usr/bin/env python3
"""Runs clang-tidy on the sources of the product, one for each core at a time.

Sources that are compiled together are looked at together, which reads the
headers of CAF once for all of them. What passed is not looked at again until a
source, a header of ours that it includes, or the configuration changes.
Usage: tools/tidy.py BUILD_DIR
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("dds", "messages", "schemas", "actors", "skills", "client",
           "embedding", "tools")
PRECOMPILED = re.compile(r"-Winvalid-pch|-include \S+/cmake_pch\.hxx")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def closure(source):
    """The source and every header of ours that it includes, however deep."""
    seen, open_files = set(), [source]
    while open_files:
        path = open_files.pop()
        if path in seen or not path.is_file():
            continue
        seen.add(path)
        text = path.read_text(encoding="utf-8")
        open_files += [root / name for name in INCLUDE.findall(text)
                       for root in (ROOT, ROOT / "include")]
    return sorted(seen)


def fingerprint(source):
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    for path in closure(source):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def without_precompiled(build, folder):
    """A compilation database without precompiled headers: clang would read all of
    them as text for each source, and a source says itself what it needs."""
    commands = json.loads((pathlib.Path(build) / "compile_commands.json")
                          .read_text(encoding="utf-8"))
    for command in commands:
        command["command"] = PRECOMPILED.sub("", command["command"])
    (pathlib.Path(folder) / "compile_commands.json").write_text(
        json.dumps(commands), encoding="utf-8")
    return commands


def lint(build, source, stamps):
    stamp = stamps / fingerprint(source)
    if stamp.exists():
        return True, ""
    # A unity source includes sources on purpose; the flag is of GCC only.
    run = subprocess.run(
        ["clang-tidy", "-p", build, "--quiet",
         "--checks=-bugprone-suspicious-include",
         "--extra-arg=-Wno-unknown-warning-option",
         "--extra-arg=-Wno-error", str(source)],
        capture_output=True, text=True, check=False)
    if run.returncode == 0:
        stamp.touch()
    return run.returncode == 0, run.stdout


def is_product(path, build):
    """Whether a source, or a unity source in the build folder, is no test."""
    roots = (ROOT / folder for folder in FOLDERS)
    made = (pathlib.Path(build).resolve() / folder for folder in FOLDERS)
    return any(root in path.parents for root in roots) or (
        path.name.startswith("unity_")
        and any(root in path.parents for root in made))


def main():
    build = sys.argv[1]
    stamps = pathlib.Path(
        os.environ.get("ROSCELL_TIDY_STAMPS", ROOT / ".cache" / "tidy"))
    stamps.mkdir(parents=True, exist_ok=True)
    folder = tempfile.TemporaryDirectory()
    commands = without_precompiled(build, folder.name)
    sources = sorted({pathlib.Path(c["file"]) for c in commands
                      if is_product(pathlib.Path(c["file"]), build)})
    bad = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, (good, text) in zip(
                sources, pool.map(lambda s: lint(folder.name, s, stamps), sources)):
            if not good:
                bad += 1
                print(f"{source.relative_to(ROOT)}:\n{text}")
    print(f"clang-tidy: {len(sources) - bad} clean, {bad} with findings")
    return 1 if bad else 0


sys.exit(main())
