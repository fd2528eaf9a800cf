#include "tools/roscell/dashboard/pages.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/http/limits.hpp"
#include "client/cell_model.hpp"
#include "client/columns.hpp"

#include <string_view>
#include <utility>
#include <variant>

namespace roscell::cli {

const std::string& described_script() {
  static const auto text =
      "export const COLUMNS = " + described_columns().dump()
      + ";\nexport const STALE = " + json(stale_answers()).dump() + ";\n";
  return text;
}

const web_pages& dashboard_pages() {
  static const auto all = [] {
    auto result = page_files();
    result["/dashboard/described.js"] = {"text/javascript; charset=utf-8",
                                         described_script()};
    return result;
  }();
  return all;
}

namespace {

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size()
         && text.substr(text.size() - end.size()) == end;
}

std::string encoded_path(std::string_view path) {
  std::string result;
  for (size_t begin = 1; begin <= path.size();) {
    const auto end = std::min(path.find('/', begin), path.size());
    result += "/" + percent_encode(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

std::string target_of(const http_request& request) {
  auto result = encoded_path(request.path);
  char before = '?';
  for (const auto& [key, value] : request.query) {
    result += before + percent_encode(key) + "=" + percent_encode(value);
    before = '&';
  }
  return result;
}

http_call call_for(const http_endpoint& node, const http_request& request) {
  http_call result;
  result.to = node;
  result.method = request.method;
  result.target = target_of(request);
  result.body = request.body;
  result.timeout = limits::request::router;
  result.max_reply_bytes = limits::http::client_reply_bytes;
  return result;
}

/// Whether the reply has no end.
bool is_stream(const http_request& request) {
  const auto follows = [&](bool otherwise) {
    const auto found = request.query.find("follow");
    return found == request.query.end() ? otherwise : found->second != "0";
  };
  return (request.path == "/v1/events" && follows(true))
         || (ends_with(request.path, "/logs") && follows(false));
}

void pass_on(const http_call& call, const responder& answer,
             const http_outcome& outcome) {
  if (const auto* reply = std::get_if<http_reply>(&outcome))
    return answer.reply(reply->status, reply->content_type, reply->body);
  const auto why = describe_http_failure(std::get<http_failure>(outcome), call);
  answer.error(502, why.code, why.message, why.hint);
}

/// A stream on its way from the node to the browser. It lives until the
/// browser's end of it is over.
struct passage {
  http_subscription from;
  std::shared_ptr<http_stream> to;
};

void pass_stream(const std::shared_ptr<io_core>& core, http_call call,
                 const responder& answer, const char* content_type) {
  call.endless = true;
  auto way = std::make_shared<passage>();
  http_callbacks calls;
  calls.on_open = [way, answer, content_type] {
    way->to = answer.stream(content_type);
    // The two hold each other until here.
    way->to->on_closed([way] { way->from = {}; });
  };
  calls.on_bytes = [way](std::string_view bytes) {
    return way->to->write(std::string{bytes});
  };
  calls.on_end = [way, call, answer](const http_outcome& outcome) {
    if (!way->to)
      pass_on(call, answer, outcome);
    else if (std::holds_alternative<http_reply>(outcome))
      way->to->close();
    else
      way->to->break_off();
  };
  way->from = subscribe_http(core, call, std::move(calls));
}

} // namespace

http_handler make_forwarding(const std::shared_ptr<io_core>& core,
                             const http_endpoint& node,
                             const web_pages& pages) {
  return [core, node, &pages](const http_request& request,
                              const responder& answer) {
    const auto page = pages.find(request.path);
    if (request.method == "GET" && page != pages.end())
      return answer.reply(200, std::string{page->second.content_type},
                          std::string{page->second.body});
    if (request.path.rfind("/v1/", 0) != 0)
      return answer.error(404, error_code::unknown_type,
                          request.path + " is no page of the dashboard",
                          "it begins at /dashboard/");
    const auto call = call_for(node, request);
    if (is_stream(request))
      return pass_stream(core, call, answer,
                         request.path == "/v1/events" ? event_stream_content
                                                      : "text/plain");
    call_http(core, call, [call, answer](const http_outcome& outcome) {
      pass_on(call, answer, outcome);
    });
  };
}

} // namespace roscell::cli
