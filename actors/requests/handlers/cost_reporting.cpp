#include "actors/requests/handlers/insight.hpp"

#include "actors/core/answer_limits.hpp"
#include "schemas/document.hpp"

#include <memory>
#include <utility>

namespace roscell {

namespace {

node_cost cost_of_this_node(const request_context& context) {
  const auto& services = *context.services;
  return {services.name, services.costs->windows(context.self->clock().now()),
          ""};
}

/// What a node says of itself, and of nobody else.
std::variant<node_cost, failure> parsed_cost(const std::string& text) {
  const auto parsed = parse_document(text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return *why;
  auto report = decode<cost_report>(std::get<json>(parsed));
  if (auto* why = std::get_if<failure>(&report))
    return std::move(*why);
  auto& nodes = std::get<cost_report>(report).nodes;
  if (nodes.size() != 1)
    return failure{error_code::schema_violation,
                   "it tells of " + std::to_string(nodes.size()) + " nodes"};
  return std::move(nodes.front());
}

/// What the nodes of the cell have answered. Lives as long as the requests that
/// hold it.
class cell_costing : public std::enable_shared_from_this<cell_costing> {
public:
  cell_costing(const request_context& context, outcome<cost_report> done)
      : context_(context), done_(std::move(done)) {}

  void begin() {
    auto self = shared_from_this();
    context_.call<cell_description>(
        context_.services->coordinator, limits::local::answer, cell_query{},
        [self](const cell_description& cell) { self->ask_all(cell.nodes); },
        [self](const caf::error& why) { self->done_.fail(why); });
  }

private:
  void ask_all(const std::vector<registry_row>& rows) {
    // One more, so that it does not end before all have been asked.
    open_ = 1;
    for (const auto& row : rows) {
      if (result_.nodes.size() == max_costed_nodes)
        break;
      if (row.identity.name == context_.services->name)
        result_.nodes.push_back(cost_of_this_node(context_));
      else
        ask(row.identity.name);
    }
    finish_one();
  }

  void ask(const std::string& name) {
    const auto i = result_.nodes.size();
    result_.nodes.push_back({name, {}, ""});
    ++open_;
    auto self = shared_from_this();
    context_.call<request_routed>(
        context_.services->coordinator,
        *relayed_limit(cost_query::type) + relay_margin,
        relay_request{name, message_json(cost_query{}).dump()},
        [self, i](const request_routed& reply) {
          self->take(i, parsed_cost(reply.text));
        },
        [self, i](const caf::error& why) { self->take(i, to_failure(why)); },
        name);
  }

  /// Its name is the one that the cell knows it by.
  void take(size_t i, std::variant<node_cost, failure> reported) {
    auto& node = result_.nodes[i];
    if (auto* why = std::get_if<failure>(&reported))
      node.problem = std::move(why->message);
    else
      node = {node.node, std::move(std::get<node_cost>(reported).windows), ""};
    finish_one();
  }

  void finish_one() {
    if (--open_ == 0)
      done_.deliver(std::move(result_));
  }

  request_context context_;
  outcome<cost_report> done_;
  cost_report result_;
  size_t open_ = 0;
};

} // namespace

void report_cost(const request_context& context, cost_query query,
                 outcome<cost_report> done) {
  if (!query.cell || !context.services->coordinator)
    return done.deliver({{cost_of_this_node(context)}});
  std::make_shared<cell_costing>(context, std::move(done))->begin();
}

} // namespace roscell
