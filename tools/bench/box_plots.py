#!/usr/bin/env python3
"""Draws box plots of frame times, with waiting, from the JSON lines that
strategies_bench.sh prints: a group a scene, a box a strategy, from the 25th to
the 75th percentile with the median, whiskers from the 5th to the 95th.

Usage: box_plots.py < LINES > PICTURE.svg
"""

import json
import math
import sys

WIDTH, HEIGHT = 760, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 16, 40, 64
COLOURS = ["#4477aa", "#ee6677", "#228833"]  # Told apart by the colour-blind.


def read(lines):
    rows = [json.loads(line) for line in lines if line.strip()]
    return [row for row in rows if row.get("bench") == "strategies" and "scene" in row]


def scale(rows):
    """Milliseconds to a height, by their logarithm: waiting spans decades."""
    low = math.floor(math.log10(min(row["p5_ms"] for row in rows)))
    high = math.ceil(math.log10(max(row["p95_ms"] for row in rows)))
    span = HEIGHT - TOP - BOTTOM
    return low, high, lambda ms: TOP + span * (high - math.log10(ms)) / (high - low)


def line(x1, y1, x2, y2, colour, width=1):
    return (f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
            f'stroke="{colour}" stroke-width="{width}"/>')


def text(x, y, words, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>'


def box(row, x, width, y, colour):
    top, bottom = y(row["p75_ms"]), y(row["p25_ms"])
    return [line(x, y(row["p95_ms"]), x, y(row["p5_ms"]), colour),
            line(x - width / 4, y(row["p95_ms"]), x + width / 4, y(row["p95_ms"]), colour),
            line(x - width / 4, y(row["p5_ms"]), x + width / 4, y(row["p5_ms"]), colour),
            f'<rect x="{x - width / 2:.1f}" y="{top:.1f}" width="{width:.1f}" '
            f'height="{max(bottom - top, 1):.1f}" fill="{colour}" fill-opacity="0.35" '
            f'stroke="{colour}"/>',
            line(x - width / 2, y(row["median_ms"]), x + width / 2, y(row["median_ms"]),
                 colour, 2)]


def axes(low, high, y):
    parts = []
    for power in range(low, high + 1):
        at = y(10 ** power)
        parts += [line(LEFT, at, WIDTH - RIGHT, at, "#bbbbbb"),
                  text(LEFT - 8, at + 4, f"{10 ** power:g}", "end")]
    parts.append(f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" '
                 'text-anchor="middle">time per frame with waiting, ms</text>')
    return parts


def draw(rows):
    low, high, y = scale(rows)
    scenes = sorted({row["scene"] for row in rows})
    strategies = sorted({row["strategy"] for row in rows})
    group = (WIDTH - LEFT - RIGHT) / len(scenes)
    width = group / (2 * len(strategies))
    parts = axes(low, high, y)
    for row in rows:
        scene, strategy = scenes.index(row["scene"]), strategies.index(row["strategy"])
        x = LEFT + group * (scene + (strategy + 1) / (len(strategies) + 1))
        parts += box(row, x, width, y, COLOURS[strategy % len(COLOURS)])
    for i, scene in enumerate(scenes):
        tags = max(row["tags"] or 0 for row in rows if row["scene"] == scene)
        parts.append(text(LEFT + group * (i + 0.5), HEIGHT - BOTTOM + 20, f"{tags} tags"))
    for i, strategy in enumerate(strategies):
        x = LEFT + 40 + i * 200
        parts += [f'<rect x="{x}" y="{HEIGHT - 28}" width="12" height="12" '
                  f'fill="{COLOURS[i % len(COLOURS)]}"/>',
                  text(x + 18, HEIGHT - 18, strategy.replace("_", " "), "start")]
    body = "\n".join(parts)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
            'font-family="sans-serif" font-size="12">\n'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>\n{body}\n</svg>')


def main():
    rows = read(sys.stdin)
    if not rows:
        sys.exit("box_plots.py: no figures of scenes come in")
    print(draw(rows))


if __name__ == "__main__":
    main()
