"""Reads definitions of ROS 2 messages: text of .msg files."""

import math
import re
from typing import NamedTuple, Optional

INTEGERS = {"byte": 8, "char": 8, "uint8": 8, "uint16": 16, "uint32": 32,
            "uint64": 64, "int8": -8, "int16": -16, "int32": -32, "int64": -64}
FLOATS = ("float32", "float64")
PRIMITIVES = (*INTEGERS, *FLOATS, "bool", "string")

PACKAGE = r"[a-z][a-z0-9_]*"
MESSAGE = r"[A-Z][A-Za-z0-9]*"
FIELD = re.compile(r"[a-z](_?[a-z0-9])*")
CONSTANT = re.compile(r"[A-Z](_?[A-Z0-9])*")
TYPE = re.compile(r"(?P<name>[\w/]+)(<=(?P<text>\d+))?"
                  r"(?P<array>\[((?P<bound><=)?(?P<count>\d+))?\])?")
NESTED = re.compile(rf"(?:(?P<package>{PACKAGE})/)?(?:msg/)?(?P<message>{MESSAGE})")


class DefinitionError(Exception):
    """What is wrong with a definition, and where: `FILE:LINE: problem`."""


class Type(NamedTuple):
    """The type of a field."""
    name: str                     # float64, string, geometry_msgs/Pose
    text_bound: Optional[int]     # Most bytes of a string.
    is_array: bool = False
    fixed: Optional[int] = None   # Items of an array of fixed length.
    bound: Optional[int] = None   # Most items of a sequence.

    @property
    def package(self):
        return self.name.split("/")[0] if "/" in self.name else None


class Field(NamedTuple):
    """A field, or a constant, which always has a value."""
    type: Type
    name: str
    value: object                 # None: the type's own default.
    line: int


class Message(NamedTuple):
    package: str
    name: str
    fields: list
    constants: list
    path: str


def parse_type(text, package):
    match = TYPE.fullmatch(text)
    if not match:
        raise ValueError(f"'{text}' is no type")
    name, count = match["name"], match["count"] and int(match["count"])
    if name == "wstring":
        raise ValueError("wstring is not supported: DDS implementations write it "
                         "differently; take string, which is UTF-8")
    nested = NESTED.fullmatch(name)
    if name not in PRIMITIVES:
        if not nested:
            raise ValueError(f"'{name}' is no type")
        name = f"{nested['package'] or package}/{nested['message']}"
    if match["text"] and name != "string":
        raise ValueError(f"only a string has a length: '{text}'")
    if count == 0:
        raise ValueError(f"an array of nothing: '{text}'")
    return Type(name, match["text"] and int(match["text"]), bool(match["array"]),
                None if match["bound"] else count, count if match["bound"] else None)


def parse_integer(name, text):
    value, bits = int(text, 0), INTEGERS[name]
    least, most = (0, 2 ** bits) if bits > 0 else (-2 ** (-bits - 1), 2 ** (-bits - 1))
    if not least <= value < most:
        raise ValueError
    return value


def parse_one(name, text):
    """A value of a primitive type. Throws ValueError, with or without a text."""
    if name in INTEGERS:
        return parse_integer(name, text)
    if name in FLOATS:
        value = float(text)
        if not math.isfinite(value):
            raise ValueError
        return value
    if name == "bool":
        return {"true": True, "1": True, "false": False, "0": False}[text.lower()]
    if text[:1] in ("'", '"'):
        if len(text) < 2 or text[-1] != text[0]:
            raise ValueError
        return text[1:-1].replace("\\" + text[0], text[0])
    return text


def split_items(text):
    """The items of `[1, 2]`, where a quoted one may hold a comma."""
    if text[:1] != "[" or text[-1:] != "]":
        raise ValueError
    items = re.findall(r"""\s*("(?:\\.|[^"])*"|'(?:\\.|[^'])*'|[^,]+)\s*(?:,|$)""",
                       text[1:-1])
    return [item.strip() for item in items]


def parse_value(of, text):
    """The value that `text` stands for, a list for an array. Throws ValueError."""
    try:
        if of.name not in PRIMITIVES:
            raise ValueError
        if not of.is_array:
            return parse_one(of.name, text)
        items = [parse_one(of.name, item) for item in split_items(text)]
        if of.fixed not in (None, len(items)) or len(items) > (of.bound or len(items)):
            raise ValueError
        return items
    except (ValueError, KeyError):
        raise ValueError(f"'{text}' is no value of this type") from None


def parse_line(text, package, line):
    """A field or constant, and which of both."""
    type_text, _, rest = text.partition(" ")
    of, rest = parse_type(type_text, package), rest.strip()
    name, equals, value = (x.strip() for x in rest.partition("="))
    if equals and CONSTANT.fullmatch(name):
        if of.is_array or of.name not in PRIMITIVES:
            raise ValueError("a constant is a number, a truth value or a string")
        return Field(of, name, parse_value(of, value), line), True
    name, _, value = rest.partition(" ")
    if not FIELD.fullmatch(name):
        raise ValueError(f"'{name}' is no name of a field: lower case, digits and "
                         "single underscores")
    value = value.strip()
    return Field(of, name, parse_value(of, value) if value else None, line), False


def parse_message(text, package, name, path):
    """Reads one definition. Throws DefinitionError."""
    result = Message(package, name, [], [], path)
    for number, line in enumerate(text.splitlines(), 1):
        line = line.partition("#")[0].replace("\t", " ").strip()
        if not line:
            continue
        try:
            entry, is_constant = parse_line(line, package, number)
            entries = result.constants if is_constant else result.fields
            if entry.name in (x.name for x in entries):
                raise ValueError(f"'{entry.name}' is there twice")
            entries.append(entry)
        except ValueError as error:
            raise DefinitionError(f"{path}:{number}: {error}") from None
    if not result.fields:
        # No message is empty in ROS 2, on the wire neither.
        result.fields.append(Field(Type("uint8", None),
                                   "structure_needs_at_least_one_member", None, 0))
    return result
