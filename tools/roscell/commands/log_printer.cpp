#include "tools/roscell/commands/log_printer.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/requests/rest_streams.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <string_view>
#include <utility>

namespace roscell::cli {

log_printer::log_printer(const log_request& request, const node_client& node,
                         log_query subject, const std::string& prefix)
    : request_{request}, node_{node}, subject_{std::move(subject)},
      lines_{prefix, stdout_is_terminal() ? log_reader::terminal
                                          : log_reader::program} {
  // nop
}

void log_printer::run() {
  if (subject_.previous && request_.tail > 0)
    print_end();
  else if (subject_.previous || (request_.tail == 0 && !request_.follow))
    print_all();
  else
    node_.follow(stream_path(), [this](std::string_view line) {
      print(lines_.add(std::string{line} + "\n"));
      return true;
    });
  print(lines_.finish());
}

log_excerpt log_printer::ask(const log_query& query) const {
  return node_.ask(message_json(query), log_limit).get<log_excerpt>();
}

/// Prints all that is there now, part by part. What is logged meanwhile is left
/// out: a skill that logs faster than we print would keep us forever.
void log_printer::print_all() {
  auto last_line = subject_;
  last_line.tail_lines = 1;
  const auto end = ask(last_line).next_offset;
  timed_log timed;
  auto next = subject_;
  next.times = request_.times;
  for (int64_t offset = 0; offset < end;) {
    next.offset = offset;
    const auto part = ask(next);
    if (part.next_offset <= offset)
      return;
    print(lines_.add(timed.add(part)));
    offset = part.next_offset;
  }
}

/// Nothing comes after it.
void log_printer::print_end() {
  auto query = subject_;
  query.tail_lines = static_cast<int64_t>(request_.tail);
  query.times = request_.times;
  timed_log timed;
  print(lines_.add(timed.add(ask(query))));
}

std::string log_printer::stream_path() const {
  auto path = "/v1/instances/" + percent_encode(subject_.instance) + "/logs";
  path += request_.tail == 0 ? "?offset=0"
                             : "?tail=" + std::to_string(request_.tail);
  path += request_.times ? "&times=1" : "";
  return request_.follow ? path + "&follow=1" : path;
}

} // namespace roscell::cli
