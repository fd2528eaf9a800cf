#pragma once

#include "actors/requests/request_context.hpp"
#include "schemas/document.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

/// A request as an edge sees it: a checked document in, a reply out, by a call
/// that is made once.
using request_runner =
    std::function<void(const request_context&, const json& document,
                       std::function<void(std::variant<json, failure>)>)>;

/// A chain of handlers. Each one's output type is the next one's input type,
/// or it does not compile.
template <class Start, class End>
class pipeline {
public:
  using step = std::function<void(const request_context&, Start, outcome<End>)>;

  explicit pipeline(step run) : run_(std::move(run)) {}

  template <class Out>
  pipeline<Start, Out> then(const char* name, handler<End, Out> next) const {
    return pipeline<Start, Out>{
        [run = run_, name, next](const request_context& context, Start input,
                                 outcome<Out> done) {
          run(context, std::move(input),
              outcome<End>{[=](typename outcome<End>::value_type result) {
                if (auto* why = std::get_if<failure>(&result))
                  return done.fail(std::move(*why));
                if (auto* early = std::get_if<early_reply>(&result))
                  return done.conclude(std::move(early->reply));
                context.enter(name);
                next(context, std::get<End>(std::move(result)), done);
              }});
        }};
  }

  const step& run() const {
    return run_;
  }

private:
  step run_;
};

/// Begins a pipeline with the handler of its start type.
template <class Start, class Out>
pipeline<Start, Out> start_with(const char* name, handler<Start, Out> first) {
  return pipeline<Start, Out>{[name, first](const request_context& context,
                                            Start input, outcome<Out> done) {
    context.enter(name);
    first(context, std::move(input), std::move(done));
  }};
}

/// Which requests a node takes. To add one, register it in
/// actors/requests/handlers/registry.cpp.
class request_registry {
public:
  template <class Start, class End>
  void add(const pipeline<Start, End>& chain) {
    pipelines_[Start::type] = runner_of<Start, End>(chain.run());
  }

  template <class Start, class End>
  void add(handler<Start, End> dedicated) {
    handlers_[Start::type] = runner_of<Start, End>(
        start_with<Start, End>("handler", dedicated).run());
  }

  /// A pipeline by its start type first, then a dedicated handler, else null.
  const request_runner* find(const std::string& type) const {
    for (const auto* table : {&pipelines_, &handlers_})
      if (auto i = table->find(type); i != table->end())
        return &i->second;
    return nullptr;
  }

private:
  template <class Start, class End>
  static request_runner runner_of(typename pipeline<Start, End>::step run) {
    return [run](const request_context& context, const json& document,
                 std::function<void(std::variant<json, failure>)> done) {
      auto input = decode<Start>(document);
      if (auto* why = std::get_if<failure>(&input))
        return done(std::move(*why));
      run(context, std::get<Start>(std::move(input)),
          outcome<End>{[done](typename outcome<End>::value_type result) {
            if (auto* why = std::get_if<failure>(&result))
              done(std::move(*why));
            else if (auto* early = std::get_if<early_reply>(&result))
              done(std::move(early->reply));
            else
              done(message_json(std::get<End>(result)));
          }});
    };
  }

  std::map<std::string, request_runner> pipelines_;
  std::map<std::string, request_runner> handlers_;
};

/// Carries one request, a document that has passed its schema, through its
/// handlers and ends with it, so that whatever kills it fails that request
/// only: the next one gets a new actor. `ticket` is the request's in the
/// node's history, which the handlers go on to write. Messages:
/// messages/inside/requests.hpp.
handler_pipeline_actor::behavior_type
handler_pipeline(pipeline_pointer self, const request_runner& run,
                 const std::shared_ptr<const node_services>& services,
                 const std::shared_ptr<const json>& document,
                 request_history::ticket ticket);

/// Every request of a node: those of a coordination node include the cell's.
request_registry make_registry(bool coordinator);

} // namespace roscell
