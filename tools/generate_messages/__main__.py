"""Makes C++ structs of the messages of one ROS 2 package.

Writes FOLDER/roscell/ros2/PACKAGE.hpp and FOLDER/PACKAGE.cpp from files
PACKAGE/msg/TYPE.msg. ROOT is a folder of packages whose messages may be fields of
these. What is wrong is said as FILE:LINE: PROBLEM, and then nothing is written.
Usage: generate_messages --to FOLDER [--known ROOT]... FILE...
"""

import argparse
import pathlib
import re
import sys

from definition import MESSAGE, PACKAGE, DefinitionError, parse_message
from structs import FOLDER, header, source


def read(path):
    package = path.parent.parent.name
    if path.parent.name != "msg" or not re.fullmatch(PACKAGE, package) \
            or not re.fullmatch(MESSAGE + r"\.msg", path.name):
        raise DefinitionError(f"{path}: a definition lies in PACKAGE/msg/TYPE.msg")
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise DefinitionError(f"{path}: cannot be read: {error}") from None
    return parse_message(text, package, path.stem, path)


def in_order(messages, roots):
    """The messages, each behind those that are fields of it."""
    own = {f"{x.package}/{x.name}": x for x in messages}
    done, result = set(), []

    def add(message, around):
        name = f"{message.package}/{message.name}"
        if name in done:
            return
        for field in message.fields:
            needed, place = field.type.name, f"{message.path}:{field.line}"
            if needed in (*around, name):
                raise DefinitionError(f"{place}: {needed} would contain itself")
            if needed in own:
                add(own[needed], (*around, name))
            elif field.type.package and not known(field.type, roots):
                raise DefinitionError(f"{place}: there is no definition of {needed}")
        done.add(name)
        result.append(message)

    for message in messages:
        add(message, ())
    return result


def known(of, roots):
    package, name = of.name.split("/")
    return any((root / package / "msg" / f"{name}.msg").is_file() for root in roots)


def main():
    parser = argparse.ArgumentParser("generate_messages", description=__doc__)
    parser.add_argument("--to", type=pathlib.Path, required=True)
    parser.add_argument("--known", type=pathlib.Path, action="append", default=[])
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    options = parser.parse_args()
    try:
        messages = [read(path) for path in sorted(options.files)]
        packages = {x.package for x in messages}
        if len(packages) != 1:
            raise DefinitionError(f"one package at a time, not {sorted(packages)}")
        messages = in_order(messages, options.known)
    except DefinitionError as error:
        return str(error)
    package = packages.pop()
    folder = options.to / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{package}.hpp").write_text(header(package, messages), encoding="utf-8")
    (options.to / f"{package}.cpp").write_text(source(package, messages),
                                               encoding="utf-8")
    return 0


sys.exit(main())
