#include "tools/roscell/tasks/task_file.hpp"

#include "schemas/document.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/read_file.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <utility>
#include <variant>

namespace roscell::cli {

json task_file::request() const {
  auto result = request_at.empty() ? document : document.at("request");
  if (result.is_object())
    result["type"] = "task_request";
  return result;
}

task_file read_task_file(const std::string& name) {
  task_file result{name, read_file(name), {}, {}};
  auto parsed = parse_document(result.text, format_of(name, result.text));
  if (auto* why = std::get_if<failure>(&parsed))
    throw wrong_document{std::move(result), std::move(*why)};
  result.document = std::get<json>(std::move(parsed));
  if (result.document.is_object() && result.document.contains("request"))
    result.request_at = "/request";
  return result;
}

namespace {

/// The marks, or the rejected candidates, say what is wrong, so the hint that
/// they are there says nothing. What else may be done stands behind it.
std::string hint_beside(const failure& why, bool has_rejected) {
  if (why.code == error_code::schema_violation)
    return {};
  if (!has_rejected)
    return why.hint;
  const auto more = why.hint.find("; ");
  return more == std::string::npos ? "" : why.hint.substr(more + 2);
}

void show_places(const wrong_document& e, const json& reply) {
  const auto marks = marked_errors(e.file.name, e.file.text, reply);
  const auto rejected = rejected_in(e.why);
  if (!rejected.empty())
    print_text(rejected_view(rejected, stdout_style()));
  if (marks.empty())
    return print_refusal(reply);
  print_text(marks);
  print_log_tail(e.why.details);
  const auto hint = hint_beside(e.why, !rejected.empty());
  if (!hint.empty())
    print_note("hint: " + printable(hint));
}

} // namespace

int show_wrong_document(const wrong_document& e, bool as_json) {
  const auto reply = error_reply(e.why);
  if (as_json)
    print(pretty(reply));
  else
    show_places(e, reply);
  return exit_code_of_refusal(reply);
}

} // namespace roscell::cli
