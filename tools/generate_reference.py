#!/usr/bin/env python3
"""Writes docs/reference.md, every member of a task request and of skill.json, and
docs/events.md, every event.

They are read off the schemas and off messages/event_kinds.hpp, so that they say
neither more nor less than what a node takes and publishes.
Usage: tools/generate_reference.py [--check]
--check writes nothing, and fails if a page is not what would be written.
"""

import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCHEMAS = ROOT / "schemas"
EVENTS = ROOT / "messages" / "event_kinds.hpp"

INTRODUCTION = """\
# Reference: every member of a task and of skill.json

Generated from `schemas/` by `tools/generate_reference.py`; corrections belong there. A member in **bold** has to be there. A
member that is not in these tables is refused, by its place and with the one that was probably meant: `roscell check FILE`
for a task, `roscell skill check FOLDER` for a skill. [operations.md](operations.md#tasks-new-task-check-run-restart-stop) and
[skills.md](skills.md) say how they are used.
"""

EVENTS_INTRODUCTION = """\
# Events

Generated from `messages/event_kinds.hpp` by `tools/generate_reference.py`; corrections belong there. `roscell events` prints
them, `GET /v1/events` streams them, and an embedding program gets them by `on_event`; the names in the last column that stand
in backticks are members of `data`. Which of them are kept, and how, is in [protocols.md](protocols.md#events).
"""

DOCUMENTS = [
    ("A task", "task_request.schema.json",
     "What `roscell run` and `roscell check` take, as JSON or YAML. `type` may be left out of a file."),
    ("skill.json", "skill_descriptor.schema.json",
     "The descriptor in the folder of a skill."),
]

# Definitions with members of their own that several places share.
TITLES = {
    "restart_policy": "restart",
    "node_loss_policy": "on_node_loss",
    "health_policy": "health",
    "stream_bounds": "health: inputs, outputs",
    "resource_request": "resources",
    "step_endpoint": "an input or output",
    "task_step": "a step (`pipeline[]`)",
    "declared_parameter": "a declared parameter",
}


class Reference:
    def __init__(self):
        self.files = {}
        self.lines = []
        self.told = set()
        self.open = []

    def schema(self, file):
        if file not in self.files:
            self.files[file] = json.loads((SCHEMAS / file).read_text())
        return self.files[file]

    def resolve(self, rule, file):
        """The rule that is meant, the file that it is in, and its name there.
        What is said beside a reference counts before what is said there."""
        name = None
        while "$ref" in rule:
            place, _, pointer = rule["$ref"].partition("#")
            file = place or file
            name = pointer.split("/")[-1]
            target = self.schema(file)
            for part in pointer.strip("/").split("/"):
                target = target[part]
            # The description of a definition with a pattern says its rule.
            words = {"words": target["description"]} if "pattern" in target else {}
            rule = {**target, **words,
                    **{k: v for k, v in rule.items() if k != "$ref"}}
        return rule, file, name

    def value(self, rule, file):
        """What it may be, in a few words."""
        rule, file, name = self.resolve(rule, file)
        if "const" in rule:
            return f"`{rule['const']}`"
        if "enum" in rule:
            words = rule["enum"]
            return " ".join(f"`{x}`" for x in words)
        if "oneOf" in rule:
            found = []
            for choice in rule["oneOf"]:
                words = self.value(choice, file)
                if words not in found:
                    found.append(words)
            return ", or ".join(found)
        kind = rule.get("type")
        if isinstance(kind, list):
            return ", ".join(kind)
        if kind == "array":
            return self.amount(rule, self.value(rule.get("items", {}), file))
        if kind == "object":
            return self.object_words(rule, file, name)
        if kind in ("integer", "number"):
            return kind + self.bounds(rule)
        if kind == "string":
            return self.text_words(rule)
        return kind or "any value"

    def object_words(self, rule, file, name):
        if "properties" in rule:
            if name in TITLES:
                self.later(name, rule, file)
                title = TITLES[name]
                return f"[{title.replace('`', '')}](#{anchor(title)})"
            return "object"
        names = self.resolve(rule.get("propertyNames", {}), file)[0]
        inner = self.value(rule.get("additionalProperties", {}), file)
        size = f", at most {rule['maxProperties']}" if "maxProperties" in rule else ""
        return f"object{size}: {'text' if not names else 'name'} → {inner}"

    @staticmethod
    def amount(rule, words):
        least, most = rule.get("minItems", 0), rule.get("maxItems")
        if most is None:
            return f"list of: {words}"
        return f"list, {least} to {most}: {words}" if least else f"list, at most {most}: {words}"

    @staticmethod
    def bounds(rule):
        least, most = rule.get("minimum"), rule.get("maximum")
        if least is None or abs(least) >= 1e300:
            return ""
        return f", {number(least)} to {number(most)}"

    @staticmethod
    def text_words(rule):
        said = rule.get("words", rule.get("description", ""))
        if "pattern" in rule and not said.endswith("."):
            return said
        if "maxLength" in rule:
            return f"text, at most {rule['maxLength']} characters"
        return "text"

    def later(self, name, rule, file):
        if name not in self.told:
            self.told.add(name)
            self.open.append((TITLES[name], rule, file))

    def meaning(self, rule, file):
        said = rule.get("description")
        whole = self.resolve(rule, file)[0]
        return said or whole.get("description", "")

    def rows(self, rule, file, prefix=""):
        required = set(rule.get("required", []))
        for name, member in rule["properties"].items():
            whole, where, known = self.resolve(member, file)
            path = prefix + name
            shown = f"**`{path}`**" if name in required else f"`{path}`"
            value, meaning = self.value(member, file), self.meaning(member, file)
            yield shown, value, "" if meaning == value else meaning
            inner, inner_file, mark = whole, where, "."
            if whole.get("type") == "array":
                inner, inner_file, known = self.resolve(whole.get("items", {}), where)
                mark = "[]."
            if "properties" in inner and known not in TITLES:
                yield from self.rows(inner, inner_file, path + mark)

    def table(self, rule, file):
        self.lines += ["| member | what it may be | meaning |", "|---|---|---|"]
        for row in self.rows(rule, file):
            self.lines.append("| " + " | ".join(cell(x) for x in row) + " |")
        self.lines.append("")

    def document(self, title, file, words):
        self.lines += [f"## {title}", "", words, ""]
        self.table(self.schema(file), file)
        while self.open:
            title, rule, where = self.open.pop(0)
            self.lines += [f"### {title}", "", rule["description"], ""]
            self.table(rule, where)


def number(x):
    return str(int(x)) if float(x).is_integer() else str(x)


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def anchor(title):
    """As GitHub makes it of a heading."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def reference_page():
    reference = Reference()
    for title, file, words in DOCUMENTS:
        reference.document(title, file, words)
    return INTRODUCTION + "\n" + "\n".join(reference.lines).rstrip() + "\n"


def events_page():
    """The sections of the list are its lines of comment that stand alone."""
    lines = [EVENTS_INTRODUCTION]
    entry = r'^// (?P<title>[^\n]*)\.$|event_kind (?P<name>\w+)\{(?P<texts>.*?)\};'
    for x in re.finditer(entry, EVENTS.read_text().split("namespace events {")[1], re.DOTALL | re.MULTILINE):
        if x["title"]:
            lines += [f"## {x['title']}", "", "| event | subject | published by | what has happened |", "|---|---|---|---|"]
            continue
        texts = re.split(r'",\s*"', re.sub(r'"\s*\n\s*"', "", x["texts"]).strip()[1:-1])
        if len(texts) != 4:
            sys.exit(f"{EVENTS.name}: {x['name']} is not {texts}")
        lines.append("| " + " | ".join([f"`{texts[0]}`", *map(cell, texts[1:])]) + " |")
    return re.sub(r"\n(## )", r"\n\n\1", "\n".join(lines)).replace("\n\n\n", "\n\n") + "\n"


PAGES = {ROOT / "docs" / "reference.md": reference_page, ROOT / "docs" / "events.md": events_page}


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    for page, text_of in PAGES.items():
        text = text_of()
        if not sys.argv[1:]:
            page.write_text(text)
        elif not page.is_file() or page.read_text() != text:
            sys.exit(f"docs/{page.name} is not what the sources say; "
                     "tools/generate_reference.py writes it anew")


if __name__ == "__main__":
    main()
