#include "actors/builds/source_questions.hpp"

#include "actors/edge/disk/limits.hpp"
#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/io/socket_address.hpp"

#include <caf/send.hpp>

#include <utility>
#include <variant>

namespace roscell {

namespace {

/// On the io thread: turns an outcome into a message.
source_answered answer_of(uint64_t question, const http_call& what,
                          http_outcome outcome) {
  source_answered result;
  result.question = question;
  auto reply = to_edge_result(std::move(outcome), what);
  if (const auto* why = std::get_if<edge_error>(&reply)) {
    result.why = {why->code, why->message, "", why->hint, ""};
    return result;
  }
  result.status = std::get<http_reply>(reply).status;
  result.body = std::move(std::get<http_reply>(reply).body);
  return result;
}

} // namespace

std::function<void(const build_fetcher_actor&, const source_question&)>
source_asker(std::shared_ptr<io_core> io, std::string from,
             std::shared_ptr<site_identity> identity) {
  return [io = std::move(io), from = std::move(from),
          identity = std::move(identity)](const build_fetcher_actor& whom,
                                          const source_question& question) {
    const auto to = parse_socket_address(question.source.address);
    if (!to) {
      source_answered answer;
      answer.question = question.number;
      answer.why = {error_code::unreachable,
                    "'" + question.source.address + "' is no address", "", "",
                    ""};
      return caf::anon_send(whom, std::move(answer));
    }
    http_call what;
    what.to.address = to->address;
    what.to.port = to->port;
    what.from = from;
    what.to.identity = identity;
    what.to.token = question.source.permit;
    what.target = question.target;
    what.timeout = question.timeout;
    what.max_reply_bytes = limits::build::manifest_bytes;
    call_http(
        io, what, [whom, what, number = question.number](http_outcome outcome) {
          caf::anon_send(whom, answer_of(number, what, std::move(outcome)));
        });
  };
}

} // namespace roscell
