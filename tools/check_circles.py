#!/usr/bin/env python3
"""Folders that stand beside each other include each other in one direction
only: no circle may lead from one back to itself, however long. What is below a
folder counts as part of it. Names each include that is part of a circle.
Usage: tools/check_circles.py"""
import collections
import os
import re
import subprocess
import sys

PRODUCT = ['actors', 'client', 'dds', 'embedding', 'include', 'messages',
           'schemas', 'skills', 'tools']

# Each is one unit cut into folders for its readers; none is to be added. A
# coordinator's moves and updates end and start steps of tasks, and all act on
# its state; a session begins as an HTTP request, and its probes share the
# heartbeat's port; a codec is compiled with the families that are read by it.
ONE_UNIT = [
    {'actors/cell/moves', 'actors/cell/sets', 'actors/cell/state',
     'actors/cell/streams', 'actors/cell/tasks', 'actors/cell/updates'},
    {'actors/edge/http', 'actors/edge/reach', 'actors/edge/session'},
    {'messages/codec', 'messages/inside', 'messages/insight'},
]


def includes():
    """(file, included file) of all sources of the product."""
    listed = subprocess.check_output(
        ['git', 'ls-files', '-co', '--exclude-standard', *PRODUCT], text=True)
    files = {x for x in listed.split()
             if x.endswith(('.hpp', '.cpp')) and os.path.exists(x)}
    for file in sorted(files):
        with open(file, encoding='utf-8') as source:
            for name in re.findall(r'#include ["<]([^">]+)[">]', source.read()):
                for path in (name, 'include/' + name):
                    if path in files:
                        yield file, path


def siblings(file, included):
    """The two folders beside each other that the files are in; none if one of
    the files' folders holds the other one."""
    ours, theirs = (os.path.dirname(x).split('/') for x in (file, included))
    for depth, (x, y) in enumerate(zip(ours, theirs)):
        if x != y:
            return '/'.join(ours[:depth + 1]), '/'.join(theirs[:depth + 1])
    return None


def reached_from(start, edges):
    found, ahead = set(), [start]
    while ahead:
        for folder in edges[ahead.pop()] - found:
            found.add(folder)
            ahead.append(folder)
    return found


def main():
    edges, reasons = collections.defaultdict(set), collections.defaultdict(list)
    for file, included in includes():
        pair = siblings(file, included)
        if pair:
            edges[pair[0]].add(pair[1])
            reasons[pair].append(f'{file} includes {included}')
    reached = {x: reached_from(x, edges) for x in list(edges)}
    circles = {frozenset(y for y in around if x in reached.get(y, ()))
               for x, around in reached.items() if x in around}
    known = set(map(frozenset, ONE_UNIT))
    for circle in sorted(circles - known, key=sorted):
        print('law: these folders include each other in a circle:',
              *sorted(circle))
        for pair in sorted(reasons):
            if circle.issuperset(pair):
                print(*reasons[pair], sep='\n')
    for gone in sorted(known - circles, key=sorted):
        print('law: tools/check_circles.py lists what is no circle any more:',
              *sorted(gone))
    return 0 if circles == known else 1


if __name__ == '__main__':
    sys.exit(main())
