#include "actors/requests/rest.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/shifted_times.hpp"
#include "actors/core/watching.hpp"
#include "actors/requests/access/role_table.hpp"
#include "actors/requests/metrics/scrape.hpp"
#include "actors/requests/request_outline.hpp"
#include "actors/requests/rest_routes.hpp"
#include "actors/requests/rest_streams.hpp"
#include "messages/event_kinds.hpp"

#include <caf/typed_event_based_actor.hpp>

#include <chrono>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// Who it is, is known; he may not.
constexpr int status_forbidden = 403;

failure node_ended() {
  return {error_code::unreachable,
          "the node ended before it had answered",
          {},
          "ask again, with the same request, once it runs"};
}

/// One HTTP request that waits for the router.
struct rest_exchange_state {
  static constexpr const char* name = "rest-exchange";
};

using exchange_pointer =
    introspected_actor::stateful_pointer<rest_exchange_state>;

void finish_exchange(exchange_pointer self, const responder& answer,
                     const failure& why) {
  answer.error(http_status(why.code), why.code, why.message, why.hint);
  self->quit();
}

/// Calls it with the code of a refusal; empty: it was done.
using outcome_noter = std::function<void(const std::string& refusal)>;

void ask_router(exchange_pointer self, const request_router_actor& router,
                const json_request& what, const responder& answer,
                const outcome_noter& note) {
  // A router that ends leaves its requests unanswered.
  watch_until_own_end(self, router);
  self->set_down_handler([self, answer](const caf::down_msg&) {
    finish_exchange(self, answer, node_ended());
  });
  self->request(router, limits::request::router,
                route_request{what.text, what.only, what.from})
      .then(
          [self, answer, note](const request_routed& done) {
            note(done.refusal);
            const int status = done.refusal.empty()
                                   ? 200
                                   : http_status(error_code_from(done.refusal));
            answer.reply(status, json_content,
                         with_times_shifted(done.text, to_wall_clock()));
            self->quit();
          },
          [self, answer, note](const caf::error& why) {
            note(std::string{to_word(to_failure(why).code)});
            finish_exchange(self, answer, to_failure(why));
          });
}

/// Writes down that somebody has asked for it, and what came of it.
outcome_noter noter_of(const rest_services& services,
                       const request_outline& asked, const std::string& from) {
  if (!services.services || !services.services->audit
      || !is_remarkable(asked.type))
    return [](const std::string&) {};
  return [audit = services.services->audit, asked,
          from](const std::string& refusal) {
    caf::anon_send(audit, note_change{from, asked.type, asked.subject,
                                      refusal.empty() ? "done" : refusal});
  };
}

introspected_actor::behavior_type rest_exchange(exchange_pointer self,
                                                const rest_services& services,
                                                const json_request& what,
                                                const responder& answer) {
  const auto asked = outline_of(what.text);
  const auto note = noter_of(services, asked, what.from);
  if (const auto why = refuse_by_type(what.role, asked.type)) {
    note(std::string{to_word(why->code)});
    services.context.publish_event(
        events::request_refused, asked.type,
        {{"code", why->code}, {"message", why->message}, {"from", what.from}});
    answer.error(status_forbidden, why->code, why->message, why->hint);
    self->quit();
  } else {
    ask_router(self, services.router, what, answer, note);
  }
  return {
      [](const state_query&) { return state_of(json::object()); },
  };
}

/// Whoever can open the Unix socket, or has an identity that may ask for it,
/// may see it; null: it is no page.
const web_page* page_for(const rest_services& services,
                         const http_request& request) {
  if (!services.pages || (!request.local && request.role.empty())
      || request.method != "GET")
    return nullptr;
  const auto found = services.pages->find(request.path);
  return found == services.pages->end() ? nullptr : &found->second;
}

/// Starts what a route asks for.
struct route_starter {
  caf::actor_system& system;
  const rest_services& services;
  const responder& answer;

  void operator()(const json_request& x) const {
    spawn(system, services.context, rest_exchange, services, x, answer);
  }

  void operator()(const event_stream_request& x) const {
    if (!x.follow)
      return send_kept_events(system, services.context, answer,
                              kept_events_query{x.since});
    start_event_stream(system, services.context,
                       answer.stream(event_stream_content), x.since);
  }

  void operator()(const past_events_request& x) const {
    send_kept_events(system, services.context, answer, x.query);
  }

  void operator()(const log_stream_request& x) const {
    spawn(system, services.context, log_stream, services.router, x, answer);
  }

  void operator()(const health_check&) const {
    answer.reply(200, json_content, R"({"status":"ok"})");
  }

  void operator()(const metrics_request& x) const {
    start_scrape(system, services.services, answer, x.format);
  }

  void operator()(const build_request& x) const {
    if (services.services && services.services->keeper)
      return start_build_exchange(system, services.context,
                                  services.services->keeper, x, answer);
    (*this)(failure{error_code::conflict, "this node keeps no builds"});
  }

  void operator()(const failure& why) const {
    answer.reply(http_status(why.code), json_content, error_reply(why).dump());
  }
};

} // namespace

http_handler make_rest_handler(caf::actor_system& system,
                               const rest_services& services) {
  return [&system, services](const http_request& request,
                             const responder& answer) {
    if (const auto why = refuse_by_role(request))
      answer.error(status_forbidden, why->code, why->message, why->hint);
    else if (const auto* page = page_for(services, request))
      answer.reply(200, std::string{page->content_type},
                   std::string{page->body});
    else
      std::visit(route_starter{system, services, answer}, route_of(request));
  };
}

} // namespace roscell
