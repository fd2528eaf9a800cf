#!/usr/bin/env python3
"""Runs clang-tidy on the sources of the product, one for each core at a time.

Sources that are compiled together are looked at together, which reads the
headers of CAF once for all of them. What passed is not looked at again, in any
clone of this user, until a file that its compiler has read, its command or the
configuration changes. Which files that are is known by the build, hence
everything must have been built.

First come the sources that a change touches: what differs from the upstream
branch or, where nothing does, what the last four hours of commits have brought.
"""

import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("dds", "messages", "schemas", "actors", "skills", "client",
           "embedding", "tools")
PRECOMPILED = re.compile(r"-Winvalid-pch|-include (\"[^\"]*/cmake_pch\.hxx\""
                         r"|\S+/cmake_pch\.hxx)")
OUTPUT = re.compile(r" -o (\S+)")
RECENT_S = 4 * 3600


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", help="the build folder")
    parser.add_argument("--touched", action="store_true",
                        help="leave the sources alone that the change does not touch")
    parser.add_argument("--begin-until", type=float, metavar="TIME",
                        help="begin none of those later than this, in seconds of the epoch")
    parser.add_argument("--base", metavar="COMMIT",
                        help="what the change is a change of")
    return parser.parse_args()


def git(*words):
    run = subprocess.run(["git", "-C", ROOT, *words], capture_output=True,
                         text=True, check=False)
    return run.stdout.strip() if run.returncode == 0 else ""


def changed_files(base):
    """Paths that differ from the base, or None if nobody knows."""
    base = base or git("merge-base", "HEAD", "@{upstream}")
    head = git("rev-parse", "HEAD")
    if not base or (base == head and not git("status", "--porcelain")):
        date = git("show", "-s", "--format=%ct", "HEAD")
        base = date and git("rev-list", "-1", f"--before={int(date) - RECENT_S}", "HEAD")
    if not base:
        return None
    names = git("diff", "--name-only", base) + "\n" + git(
        "ls-files", "--others", "--exclude-standard")
    return {ROOT / name for name in names.splitlines()}


def files_read(build):
    """For each object of the build, the files of ours that its compiler read."""
    text = subprocess.run(["ninja", "-C", build, "-t", "deps"], text=True,
                          capture_output=True, check=True).stdout
    read, current = {}, None
    for line in text.splitlines():
        if line.startswith(" "):
            path = pathlib.Path(os.path.normpath(build / line.strip()))
            if ROOT in path.parents and "cmake_pch" not in path.name:
                current.add(path)
        elif ":" in line:
            current = read.setdefault(line.split(":")[0], set())
    return read


def fingerprint(command, files):
    """Of all that a finding can depend on, wherever the tree is."""
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    digest.update(command["command"].replace(str(ROOT), "").encode())
    for path in sorted(files):
        digest.update(path.read_bytes().replace(str(ROOT).encode(), b""))
    return digest.hexdigest()


def without_precompiled(build, folder):
    """A compilation database without precompiled headers: clang would read all of
    them as text for each source, and a source says itself what it needs."""
    commands = json.loads((build / "compile_commands.json")
                          .read_text(encoding="utf-8"))
    for command in commands:
        command["command"] = PRECOMPILED.sub("", command["command"])
    (pathlib.Path(folder) / "compile_commands.json").write_text(
        json.dumps(commands), encoding="utf-8")
    return commands


def is_product(path, build):
    """Whether a source, or a unity source in the build folder, is no test."""
    roots = (ROOT / folder for folder in FOLDERS)
    made = (build / folder for folder in FOLDERS)
    return any(root in path.parents for root in roots) or (
        path.name.startswith("unity_")
        and any(root in path.parents for root in made))


def lint(folder, source):
    """What clang-tidy says of a source, empty if it is content."""
    # A unity source includes sources on purpose; the flag is of GCC only.
    run = subprocess.run(
        ["clang-tidy", "-p", folder, "--quiet",
         "--checks=-bugprone-suspicious-include",
         "--extra-arg=-Wno-unknown-warning-option",
         "--extra-arg=-Wno-error", str(source)],
        capture_output=True, text=True, check=False)
    return "" if run.returncode == 0 else run.stdout + run.stderr


def plan(build, folder, base):
    """The sources to look at as (touched, source, stamp), touched ones first, and
    how many have passed before."""
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()
    stamps = pathlib.Path(os.environ.get("ROSCELL_TIDY_STAMPS", cache / "roscell" / "tidy"))
    stamps.mkdir(parents=True, exist_ok=True)
    read, changed = files_read(build), changed_files(base)
    jobs, passed = {}, 0
    for command in without_precompiled(build, folder):
        source = pathlib.Path(command["file"])
        if not is_product(source, build) or source in jobs:
            continue
        files = read.get(OUTPUT.search(command["command"])[1], set()) | {source}
        stamp = stamps / fingerprint(command, files)
        if stamp.exists():
            passed += 1
        else:
            jobs[source] = (changed is None or bool(files & changed), source, stamp)
    return sorted(jobs.values(), key=lambda x: (not x[0], x[1])), passed


def main():
    options = arguments()
    build = pathlib.Path(options.build).resolve()
    bad, clean, left = 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        jobs, passed = plan(build, folder, options.base)

        def look_at(job):
            touched, source, stamp = job
            late = options.begin_until and time.time() > options.begin_until
            if not touched and (options.touched or late):
                return source, None
            said = lint(folder, source)
            if not said:
                stamp.touch()
            return source, said

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for source, said in pool.map(look_at, jobs):
                left += said is None
                clean += said == ""
                if said:
                    bad += 1
                    print(f"{source.relative_to(ROOT)}:\n{said}")
    print(f"clang-tidy: {clean} clean, {bad} with findings, {passed} clean before, "
          f"{left} not looked at")
    return 1 if bad else 0


sys.exit(main())
