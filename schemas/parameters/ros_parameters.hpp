#pragma once

#include "schemas/parameters/declared_parameter.hpp"

#include <string>
#include <vector>

/// Values as a ROS 2 program takes them: `-p NAME:=VALUE`, which rcl reads as
/// YAML and types by its form, or `NAME:=VALUE` of a launch file, which is text
/// that launch reads as YAML where it becomes a parameter.
namespace roscell {

enum class ros_reader { program, launch_file };

/// Why a value cannot be given so; empty: it can. rcl knows no objects, no
/// lists in lists, of mixed types or without an item, and neither knows null;
/// no argument of a program has a NUL.
std::string ros_problem(const json& value, ros_reader reader);

/// The same for all of an object. Pointers begin with `place`.
std::vector<schema_error> ros_errors(const json& values, ros_reader reader,
                                     const std::string& place);

/// The text of a value without a problem, in the type that is declared: 2 for a
/// number is "2.0". Where nothing is declared but a default, the form of that
/// counts. Text for a launch file is in quotes if YAML would take it for
/// something else.
/// @param declared null: nothing is known of it.
std::string ros_text(const json& value, const declared_parameter* declared,
                     ros_reader reader);

} // namespace roscell
