"""Writes messages as C++ structs for include/roscell/ros2/fields.hpp."""

import json
import re

FOLDER = "roscell/ros2"
NUMBERS = {"float32": "float", "float64": "double", "bool": "bool",
           "byte": "std::uint8_t", "char": "std::uint8_t"}

# Names that C++, or the struct itself, needs; they get an underscore.
RESERVED = set("""
  alignas alignof and and_eq asm auto bitand bitor bool break case catch char class
  compl const constexpr const_cast continue decltype default delete do double
  dynamic_cast else enum explicit export extern false float for friend goto if inline
  int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private
  protected public register reinterpret_cast return short signed sizeof static
  static_assert static_cast struct switch template this thread_local throw true try
  typedef typeid typename union unsigned using virtual void volatile wchar_t while xor
  xor_eq fields std type_name""".split())


def usable(name):
    return name + "_" if name in RESERVED else name


def struct_name(message):
    """PoseStamped becomes pose_stamped, by the rule of ROS 2's own headers."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", message)
    return usable(re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower())


def item_type(of):
    if of.package:
        package, message = of.name.split("/")
        return f"{package}::{struct_name(message)}"
    if of.name == "string":
        return "std::string"
    return NUMBERS.get(of.name, f"std::{of.name}_t")


def member_type(of):
    item = item_type(of)
    if not of.is_array:
        return item
    if of.fixed:
        return f"std::array<{item}, {of.fixed}>"
    return f"std::vector<{item}>"


def literal(value):
    if isinstance(value, list):
        return "{" + ", ".join(map(literal, value)) + "}"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return str(value).lower()
    if value == -2 ** 63:
        return "-9223372036854775807 - 1"  # C++ has no smaller literal.
    return f"{value}U" if isinstance(value, int) and value >= 2 ** 63 else repr(value)


def default(field):
    """What stands behind the name of a member."""
    of = field.type
    if field.value is not None:
        return f" = {literal(field.value)}"
    if of.fixed:
        return "{}"
    if of.is_array or of.package or of.name == "string":
        return ""
    return " = false" if of.name == "bool" else " = 0"


def constant(field):
    kind = "const char*" if field.type.name == "string" else item_type(field.type)
    return (f"  static constexpr {kind} {usable(field.name)} = "
            f"{literal(field.value)};\n")


def entry(struct, field):
    """The field's place in the list of fields."""
    bounds = ""
    if field.type.bound or field.type.text_bound:
        items, text = (x or "ros2::unbounded" for x in (field.type.bound,
                                                  field.type.text_bound))
        bounds = f", {{{items}, {text}}}"
    return f'ros2::named("{field.name}", &{struct}::{usable(field.name)}{bounds})'


def struct(message):
    name = struct_name(message.name)
    entries = ",\n                 ".join(entry(name, x) for x in message.fields)
    return (
        f"/// {message.package}/msg/{message.name}\n"
        f"struct {name} {{\n"
        f"  static constexpr const char* type_name =\n"
        f'      "{message.package}/msg/{message.name}";\n'
        + "".join(map(constant, message.constants)) + "\n"
        + "".join(f"  {member_type(x.type)} {usable(x.name)}{default(x)};\n"
                  for x in message.fields)
        + "\n  template <class Visit>\n"
        "  static constexpr auto fields(Visit visit) {\n"
        f"    return visit({entries});\n"
        "  }\n};\n")


def header(package, messages):
    """The structs of a package, in an order in which each knows its parts."""
    used = sorted({x.type.package for m in messages for x in m.fields} - {None, package})
    includes = "".join(f'#include "{FOLDER}/{name}.hpp"\n' for name in ["fields", *used])
    return (f"// Made from the definitions of {package}.\n#pragma once\n\n"
            f"{includes}\n#include <array>\n#include <cstdint>\n#include <string>\n"
            f"#include <vector>\n\nnamespace roscell::ros2::{package} {{\n\n"
            "using ros2::operator==;\nusing ros2::operator!=;\n\n"
            + "\n".join(map(struct, messages))
            + f"\n}} // namespace roscell::ros2::{package}\n")


def source(package, messages):
    """Their functions for writing and reading, which are compiled once."""
    names = [f"{package}::{struct_name(x.name)}" for x in messages]
    return (f"// Made from the definitions of {package}.\n"
            f'#include "{FOLDER}/{package}.hpp"\n\n'
            f'#include "{FOLDER}/detail/codec.hpp"\n\nnamespace roscell::ros2 {{\n\n'
            + "".join(f"template std::string serialize(const {name}&);\n"
                      f"template {name} deserialize(std::string_view);\n"
                      for name in names)
            + "\n} // namespace roscell::ros2\n")
