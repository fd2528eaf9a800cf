#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// A command that an operator runs beside a skill instance: in its environment
/// and within its limits. What is said of it goes to the node of the instance
/// as any request that names a node, and each answer comes from there. Who has
/// asked for a command has to go on asking for its output: it ends otherwise.
namespace roscell {

/// Starts a command.
struct exec_request {
  static constexpr const char* type = "exec_request";
  std::string instance;
  std::string node; ///< That runs the instance; empty: the one that is asked.
  std::vector<std::string> command;
  bool terminal = false; ///< It gets one; its two outputs are one then.
  int64_t columns = 0;   ///< Of the terminal; 0: not known.
  int64_t rows = 0;
  /// Who asks, as the first node saw it: whatever a client says is replaced.
  std::string from;

  static constexpr auto fields() {
    return field_list{required("instance", &exec_request::instance),
                      optional("node", &exec_request::node),
                      required("command", &exec_request::command),
                      optional("terminal", &exec_request::terminal),
                      optional("columns", &exec_request::columns),
                      optional("rows", &exec_request::rows),
                      optional("from", &exec_request::from)};
  }
};

/// Reply: the command runs.
struct exec_started {
  static constexpr const char* type = "exec_started";
  std::string session; ///< Names it from now on: 16 hexadecimal digits.

  static constexpr auto fields() {
    return field_list{required("session", &exec_started::session)};
  }
};

/// Something for a command that runs.
struct exec_input {
  static constexpr const char* type = "exec_input";
  std::string session;
  std::string node;    ///< As in `exec_request`.
  int64_t offset = 0;  ///< Of the bytes in all that it has been given.
  std::string bytes;   ///< In base64.
  bool ended = false;  ///< Nothing comes after these.
  int64_t columns = 0; ///< The size that its terminal has now; 0: as before.
  int64_t rows = 0;
  bool hang_up = false; ///< Nobody is there any more: it is to end.

  static constexpr auto fields() {
    return field_list{required("session", &exec_input::session),
                      optional("node", &exec_input::node),
                      optional("offset", &exec_input::offset),
                      optional("bytes", &exec_input::bytes),
                      optional("ended", &exec_input::ended),
                      optional("columns", &exec_input::columns),
                      optional("rows", &exec_input::rows),
                      optional("hang_up", &exec_input::hang_up)};
  }
};

/// Reply: what comes next begins at `next_offset`. A command that reads nothing
/// for a while leaves it where it was: the same is to be given again.
struct exec_input_taken {
  static constexpr const char* type = "exec_input_taken";
  int64_t next_offset = 0;

  static constexpr auto fields() {
    return field_list{required("next_offset", &exec_input_taken::next_offset)};
  }
};

/// Asks for output from `offset` on, and says that all before has come. Waits
/// up to `wait_ms` for something to be there.
struct exec_output_query {
  static constexpr const char* type = "exec_output_query";
  std::string session;
  std::string node;    ///< As in `exec_request`.
  int64_t offset = 0;  ///< In all that the command has written.
  int64_t wait_ms = 0; ///< At most 5,000.

  static constexpr auto fields() {
    return field_list{required("session", &exec_output_query::session),
                      optional("node", &exec_output_query::node),
                      optional("offset", &exec_output_query::offset),
                      optional("wait_ms", &exec_output_query::wait_ms)};
  }
};

/// A part of what a command has written.
struct exec_output {
  static constexpr const char* type = "exec_output";
  std::string bytes;       ///< In base64; empty: nothing new.
  bool of_errors = false;  ///< They are of its standard error.
  int64_t next_offset = 0; ///< Where the next query goes on.
  bool ended = false;      ///< The command has, and these are its last bytes.
  int exit_code = 0;       ///< Of one that has; 128 + n after signal n.
  /// Why it was ended, one sentence; empty: it ended by itself.
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("bytes", &exec_output::bytes),
                      optional("of_errors", &exec_output::of_errors),
                      required("next_offset", &exec_output::next_offset),
                      required("ended", &exec_output::ended),
                      optional("exit_code", &exec_output::exit_code),
                      optional("reason", &exec_output::reason)};
  }
};

/// INTERNAL to the exec host: something has happened to a command.
struct exec_progress {
  std::string session;
  std::string bytes;        ///< That it has written.
  bool of_errors = false;   ///< To its standard error.
  bool input_taken = false; ///< All that it was given.
  bool ended = false;
  int exit_code = 0;
  std::string reason; ///< Why it was ended, or could not be run.

  static constexpr auto fields() {
    return field_list{required("session", &exec_progress::session),
                      required("bytes", &exec_progress::bytes),
                      required("of_errors", &exec_progress::of_errors),
                      required("input_taken", &exec_progress::input_taken),
                      required("ended", &exec_progress::ended),
                      required("exit_code", &exec_progress::exit_code),
                      required("reason", &exec_progress::reason)};
  }
};

} // namespace roscell
