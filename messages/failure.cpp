#include "messages/failure.hpp"

#include <caf/exit_reason.hpp>
#include <caf/message.hpp>
#include <caf/sec.hpp>

#include <array>
#include <string>
#include <utility>

namespace roscell {

void to_json(json& j, error_code code) {
  j = to_word(code);
}

void from_json(const json& j, error_code& code) {
  code = error_code_from(j.get_ref<const std::string&>());
}

json error_reply(const failure& why) {
  json body = why;
  if (auto details = body.find("details"); details != body.end()) {
    json extra = std::move(*details);
    body.erase(details);
    body.update(extra);
  }
  return {{"type", "error"}, {"error", std::move(body)}};
}

failure failure_from(const json& reply) {
  auto body = reply.find("error");
  if (body == reply.end() || !body->is_object())
    return {error_code::internal, "the peer sent no error where one was due"};
  json rest = *body;
  const auto text = [&rest](const char* name) {
    const auto found = rest.find(name);
    return found != rest.end() && found->is_string() ? found->get<std::string>()
                                                     : std::string{};
  };
  failure result;
  result.code = error_code_from(text("code"));
  result.message = text("message");
  result.where = text("where");
  result.hint = text("hint");
  for (auto known : {"code", "message", "where", "hint"})
    rest.erase(known);
  if (!rest.empty())
    result.details = rest.dump();
  return result;
}

caf::error to_error(const failure& why) {
  return caf::make_error(why.code, why.message, why.where, why.hint,
                         why.details);
}

namespace {

failure from_caf(const caf::error& err) {
  using caf::sec;
  if (err == sec::request_timeout)
    return {error_code::timeout, "no answer came in time", "",
            "try again; `roscell nodes` shows who is active"};
  if (err == sec::request_receiver_down)
    return {error_code::internal, "the part that worked on this has failed", "",
            "send the request again"};
  return {error_code::internal, "unexpected error " + caf::to_string(err)};
}

} // namespace

failure to_failure(const caf::error& err) {
  if (err.category() != caf::atom("roscell"))
    return from_caf(err);
  failure result{static_cast<error_code>(err.code())};
  const auto& context = err.context();
  if (context.match_elements<std::string, std::string, std::string,
                             std::string>()) {
    result.message = context.get_as<std::string>(0);
    result.where = context.get_as<std::string>(1);
    result.hint = context.get_as<std::string>(2);
    result.details = context.get_as<std::string>(3);
  }
  return result;
}

caf::error fail(error_code code, std::string message, std::string where,
                std::string hint) {
  return to_error(
      {code, std::move(message), std::move(where), std::move(hint), {}});
}

namespace {

/// In the order of `error_code`, which starts at 1.
constexpr std::array<std::string_view, 18> words{
    "malformed_json",
    "unknown_type",
    "schema_violation",
    "unknown_node",
    "unknown_cell",
    "unknown_task",
    "task_exists",
    "unknown_operation",
    "unknown_model",
    "unknown_deployment",
    "no_feasible_allocation",
    "conflict",
    "engine_failed",
    "unreachable",
    "timeout",
    "unauthorized",
    "unresolved",
    "internal",
};

} // namespace

std::string_view to_word(error_code code) {
  return words.at(static_cast<size_t>(code) - 1);
}

error_code error_code_from(std::string_view word) {
  for (size_t i = 0; i < words.size(); ++i)
    if (words[i] == word)
      return static_cast<error_code>(i + 1);
  return error_code::internal;
}

std::string to_string(error_code code) {
  return std::string{to_word(code)};
}

} // namespace roscell
