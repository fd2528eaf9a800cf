#!/usr/bin/env python3
"""Prints where the time of a run of the tests went, and what failed.

Reads the lines that tools/testing/results.sh describes. A part's wall time is
the time during which any of its commands ran; parts run beside each other, so
the sum of these is more than the run's. The last line counts the cases. The exit
code is 0 if something passed and nothing failed.
Usage: tools/testing/summary.py RESULTS BEGIN_SECONDS
"""

import sys
import time

PARTS = ("install", "lint", "build", "unit", "system", "fuzz-build", "fuzz", "tidy")
SLOWEST = 20


def covered(spans):
    """The seconds that are in any of these spans of (begin, end)."""
    total, reached = 0.0, 0.0
    for begin, end in sorted(spans):
        total += max(0.0, end - max(begin, reached))
        reached = max(reached, end)
    return total


def read(path):
    cases, spans, cores = [], {}, {}
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            kind, part, *rest = line.rstrip("\n").split("\t")
            if kind == "case":
                name, seconds, outcome, reason = rest
                cases.append((part, name, float(seconds), outcome, reason))
            else:
                begin, end, ms = map(float, rest)
                spans.setdefault(part, []).append((begin, end))
                cores[part] = cores.get(part, 0.0) + ms / 1000
    return cases, spans, cores


def print_parts(cases, spans, cores, wall):
    print(f"\n{'part':<12}{'wall (s)':>10}{'CPU (s)':>10}{'passed':>9}"
          f"{'failed':>9}{'skipped':>9}")
    for part in [x for x in PARTS if x in spans] + sorted(set(spans) - set(PARTS)):
        counts = [sum(c[0] == part and c[3] == outcome for c in cases)
                  for outcome in ("ok", "FAILED", "SKIPPED")]
        print(f"{part:<12}{covered(spans[part]):>10.1f}{cores[part]:>10.1f}"
              + "".join(f"{x:>9}" for x in counts))
    print(f"{'all':<12}{wall:>10.1f}{sum(cores.values()):>10.1f}")


def print_slowest(cases):
    print(f"\nthe {SLOWEST} slowest tests (s)")
    tests = [c for c in cases if c[0] in ("unit", "system")]
    for part, name, seconds, _, _ in sorted(tests, key=lambda c: -c[2])[:SLOWEST]:
        print(f"{seconds:>8.1f}  {part:<7} {name}")


def main():
    cases, spans, cores = read(sys.argv[1])
    print_parts(cases, spans, cores, time.time() - float(sys.argv[2]))
    print_slowest(cases)
    print()
    for outcome in ("SKIPPED", "FAILED"):
        for part, name, _, how, reason in cases:
            if how == outcome:
                print(f"{outcome:<8} {part}: {name}{': ' if reason else ''}{reason}")
    count = {x: sum(c[3] == x for c in cases) for x in ("ok", "FAILED", "SKIPPED")}
    print(f"{count['ok']} passed, {count['FAILED']} failed, {count['SKIPPED']} skipped")
    return 0 if count["ok"] and not count["FAILED"] else 1


sys.exit(main())
