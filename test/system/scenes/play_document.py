#!/usr/bin/env python3
"""Does what a page of documentation tells its reader to do.

Each fenced block is done in order, in the working directory:
  - `console`: the commands after `$ ` are given to one shell, as by a person,
    and what they print must be what the page shows. A block with a
    `roscell node` is a terminal of its own, which goes on in the background
    once it has printed what the page shows. It gets Ctrl-C where the text before
    a block says so, or at the end.
  - `sh`: lines that are pasted into that shell as they are. They must succeed.
  - another language: a file with that content. The last path in backticks
    before the block is its name.
Numbers, times, ids and the width of columns may differ; a line `...` stands for
any lines. A command that shows nothing must succeed.

Usage: play_document.py PAGE [--section TITLE] [--replace OLD=NEW]
         [--instead COMMAND=COMMAND] [--alike WORD,WORD]
"""

import argparse
import os
import pathlib
import re
import selectors
import signal
import subprocess
import sys
import time

# Compilers may be among the commands, on a busy machine.
DEADLINE_S = 300
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
END = "played"


class Mismatch(Exception):
    """The page and the world differ."""


def loosened(line, alike):
    """What of a line is the same each time and on each machine."""
    line = re.sub(r"[0-9a-f]{8,}", "#", line)
    line = re.sub(r"\d+(\.\d+)?(e[-+]?\d+)?(ms|s|min|h|d)?\b", "#", line)
    for word in alike:
        line = re.sub(rf"\b{word}\b", "@", line)
    return " ".join(line.split())


def fits(shown, printed, alike):
    """Whether the printed lines are the shown ones."""
    if not shown:
        return not printed
    if shown[0].strip() == "...":
        return any(
            fits(shown[1:], printed[i:], alike) for i in range(len(printed) + 1)
        )
    return (
        bool(printed)
        and loosened(shown[0], alike) == loosened(printed[0], alike)
        and fits(shown[1:], printed[1:], alike)
    )


def require(command, shown, printed, alike):
    if not fits(shown, printed, alike):
        raise Mismatch(
            f"$ {command}\n-- the page shows:\n"
            + "\n".join(shown)
            + "\n-- printed was:\n"
            + "\n".join(printed)
        )


def commands_in(block):
    """Pairs of a command and the lines that the page shows of its output."""
    result = []
    lines = iter(block.splitlines())
    for line in lines:
        if not line.startswith("$ "):
            result[-1][1].append(line)
            continue
        command = line[2:]
        here = re.search(r"<< '?(\w+)'?$", command)
        while command.endswith("\\"):
            command += "\n" + next(lines)
        while here and command.splitlines()[-1] != here.group(1):
            command += "\n" + next(lines)
        result.append((command, []))
    return result


class Shell:
    """A bash that gets commands one after the other."""

    def __init__(self):
        self.process = subprocess.Popen(
            ["bash"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        os.set_blocking(self.process.stdout.fileno(), False)
        self.unread = b""

    def say(self, text):
        self.process.stdin.write((text + "\n").encode())
        self.process.stdin.flush()

    def lines_until(self, is_end):
        """Reads lines until one is the end, which is returned with them."""
        result = []
        wait = selectors.DefaultSelector()
        wait.register(self.process.stdout, selectors.EVENT_READ)
        end = time.monotonic() + DEADLINE_S
        while True:
            while b"\n" in self.unread:
                line, self.unread = self.unread.split(b"\n", 1)
                result.append(line.decode())
                if is_end(result):
                    return result
            if not wait.select(max(0, end - time.monotonic())):
                raise Mismatch("in time was only printed:\n" + "\n".join(result))
            more = os.read(self.process.stdout.fileno(), 65536)
            if not more:
                raise Mismatch("it ended, and printed:\n" + "\n".join(result))
            self.unread += more

    def run(self, command, shown, alike, must=False):
        # A file that something else writes is read once it is long enough.
        if command.startswith("cat ") and "<" not in command:
            command = f"tail -n +1 -F {command[4:]} | head -n {len(shown)}"
        if must:
            command = "set -e -o pipefail\n" + command + "\nset +e +o pipefail"
        self.say(f"{command}\necho {END} $?")
        printed = self.lines_until(lambda lines: lines[-1].startswith(END))
        code = int(printed.pop().split()[1])
        require(command, shown, printed, alike)
        if code != 0 and not shown:
            raise Mismatch(f"$ {command}\nended with {code}")

    def run_on(self, command, shown, alike):
        """A command that goes on after it has printed what is shown."""
        self.say("exec " + command)
        try:
            printed = self.lines_until(lambda lines: len(lines) == len(shown))
        except Mismatch as e:
            raise Mismatch(f"$ {command}\n{e}") from e
        require(command, shown, printed, alike)

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(DEADLINE_S)
        if code != 0:
            raise Mismatch(f"after Ctrl-C a node ended with {code}")

    def kill(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)


class Player:
    """Plays a page."""

    def __init__(self, instead, alike):
        self.instead = instead
        self.alike = alike
        self.shell = Shell()
        self.terminals = []

    def play(self, page):
        done = 0
        for block in FENCE.finditer(page):
            language, content = block.groups()
            if "Ctrl-C" in page[done : block.start()]:
                self.end()
            done = block.end()
            if language == "console":
                self.play_console(content)
            elif language == "sh":
                self.shell.run(content.rstrip(), ["..."], self.alike, must=True)
            else:
                before = page[: block.start()].rstrip().rsplit("\n\n", 1)[-1]
                path = pathlib.Path(re.findall(r"`([\w./-]+/[\w./-]+)`", before)[-1])
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(content)

    def play_console(self, block):
        shell = self.shell
        if re.search(r"^\$ roscell node ", block, re.MULTILINE):
            shell = Shell()
            self.terminals.append(shell)
        for command, shown in commands_in(block):
            command = self.instead.get(command, command)
            if command.startswith("roscell node "):
                shell.run_on(command, shown, self.alike)
            else:
                shell.run(command, shown, self.alike)

    def end(self):
        while self.terminals:
            self.terminals.pop().interrupt()

    def kill(self):
        for shell in [self.shell, *self.terminals]:
            shell.kill()


def pair(text):
    old, new = text.split("=", 1)
    return old, new


def section_of(page, title):
    """The part under a heading, up to the next one."""
    match = re.search(
        rf"^## {re.escape(title)}$(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL
    )
    if not match:
        raise Mismatch(f"there is no section '{title}'")
    return match.group(1)


def main():
    options = argparse.ArgumentParser(usage=__doc__)
    options.add_argument("page", type=pathlib.Path)
    options.add_argument("--section")
    options.add_argument("--replace", type=pair, action="append", default=[])
    options.add_argument("--instead", type=pair, action="append", default=[])
    options.add_argument("--alike", type=lambda x: x.split(","), default=[])
    given = options.parse_args()
    page = given.page.read_text()
    player = Player(dict(given.instead), given.alike)
    try:
        if given.section:
            page = section_of(page, given.section)
        for old, new in given.replace:
            page = page.replace(old, new)
        player.play(page)
        player.end()
    except Mismatch as e:
        sys.exit(f"{given.page}: {e}")
    finally:
        player.kill()


main()
