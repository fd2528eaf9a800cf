#include "tools/roscell/exec/remote_command.hpp"

#include "actors/edge/exec/limits.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <chrono>

namespace roscell::cli {

namespace {

/// Longer than the nodes on the way wait for each other: they say why.
constexpr std::chrono::seconds begin_limit{40};
constexpr std::chrono::seconds answer_limit{25};
constexpr std::chrono::seconds farewell_limit{3};

} // namespace

remote_command::remote_command(const node_client& node,
                               const exec_request& what)
    : node_{node}, node_name_{what.node}, session_{node.ask(message_json(what),
                                                            begin_limit)
                                                       .get<exec_started>()
                                                       .session} {
  // nop
}

exec_input remote_command::input() const {
  exec_input result;
  result.session = session_;
  result.node = node_name_;
  return result;
}

void remote_command::give(std::string_view bytes, bool last) {
  do {
    const auto part = bytes.substr(0, limits::exec::part_bytes);
    auto request = input();
    request.offset = given_;
    request.bytes = to_base64(part);
    request.ended = last && part.size() == bytes.size();
    const auto taken = node_.ask(message_json(request), answer_limit)
                           .get<exec_input_taken>()
                           .next_offset;
    // A program that reads nothing leaves it where it was.
    if (taken < given_ + static_cast<int64_t>(part.size()))
      continue;
    given_ = taken;
    bytes.remove_prefix(part.size());
    if (request.ended)
      return;
  } while (last || !bytes.empty());
}

void remote_command::resize(terminal_size size) const {
  auto request = input();
  request.columns = size.columns;
  request.rows = size.rows;
  node_.ask(message_json(request), answer_limit);
}

void remote_command::hang_up() const noexcept {
  try {
    auto request = input();
    request.hang_up = true;
    node_.ask(message_json(request), farewell_limit);
  } catch (...) {
    // Its node ends it by itself, once nobody asks for its output.
  }
}

exec_output remote_command::ask(int64_t wait_ms) const {
  exec_output_query query;
  query.session = session_;
  query.node = node_name_;
  query.offset = seen_;
  query.wait_ms = wait_ms;
  return node_.ask(message_json(query), answer_limit).get<exec_output>();
}

exec_output remote_command::more() {
  auto result = ask(limits::exec::wait.count());
  const auto bytes = from_base64(result.bytes);
  if (!bytes)
    throw command_error{exit_refused,
                        "the output of the command is not of this version"};
  result.bytes = *bytes;
  seen_ = result.next_offset;
  return result;
}

void remote_command::stay() const {
  auto request = input();
  node_.ask(message_json(request), answer_limit);
}

} // namespace roscell::cli
