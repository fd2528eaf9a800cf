#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <string_view>

/// Standard output and standard error of this process.
namespace roscell::cli {

/// Whether somebody watches standard output, or standard error.
bool stdout_is_terminal();
bool stderr_is_terminal();

/// Colours and width that standard output can take now; neither if it is no
/// terminal, no colours under NO_COLOR or TERM=dumb.
text_style stdout_style();

/// `stdout_style` with the present time.
view_style view_style_now();

/// Writes to standard output, at once. Throws command_error if that fails,
/// such as on a full disk.
void print(std::string_view text);

/// Writes one line to standard error, at once.
void print_note(std::string_view line);

/// Writes lines with their ends to standard error, at once.
void print_text(std::string_view lines);

/// `line` cut to the width of the terminal, if standard output is one.
std::string shortened_line(const std::string& line);

/// From now on Ctrl-C and SIGTERM end the process at once, successfully: for
/// commands that would not end by themselves and leave nothing half done.
void end_quietly_on_interrupt();

/// A document for people who read JSON, with a line end.
std::string pretty(const json& document);

/// A document in one line, with a line end.
std::string compact(const json& document);

/// Tells of an error on standard error: "roscell: what", and its hint.
void print_error(const std::string& what, const std::string& hint = {});

/// What a program that has failed said last, if the details of an error have
/// it, to standard error.
void print_log_tail(const std::string& details);

/// `print_error` for the error reply of a node, with its code, every place that
/// it names, and what a program that has failed said last.
void print_refusal(const json& reply);

} // namespace roscell::cli
