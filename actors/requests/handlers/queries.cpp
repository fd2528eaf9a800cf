#include "actors/requests/handlers/queries.hpp"

#include "actors/house/limits.hpp"

#include <utility>

namespace roscell {

namespace {

/// Hands the request to the actor that can answer it.
template <class Reply, class Handle, class Request>
void forward(const request_context& context, const Handle& whom,
             std::chrono::milliseconds timeout, Request request,
             const outcome<Reply>& done) {
  ask<Reply>(context, whom, timeout, std::move(request), done,
             [done](Reply reply) { done.deliver(std::move(reply)); });
}

/// A log may be waited for; the answer comes soon after that.
std::chrono::milliseconds log_timeout(const log_query& query) {
  return limits::log::answer + std::chrono::milliseconds{query.wait_ms};
}

} // namespace

void describe_node(const request_context& context, node_query query,
                   outcome<node_description> done) {
  forward(context, context.services->node, limits::local::answer, query, done);
}

void describe_local_instances(const request_context& context,
                              instance_query query,
                              outcome<instance_description> done) {
  forward(context, context.services->supervisor, limits::local::answer,
          std::move(query), done);
}

void list_local_skills(const request_context& context, skill_query query,
                       outcome<skill_list> done) {
  ask<node_description>(
      context, context.services->node, limits::local::answer, node_query{},
      done, [done, query](const node_description& node) {
        skill_list result;
        for (const auto& skill : node.skills)
          if (query.operation.empty()
              || skill.descriptor.operation == query.operation)
            result.skills.push_back(
                {skill, {node.identity.name}, {skill.added_unix_ms}});
        for (const auto& problem : node.refused_skills)
          result.refused.push_back({node.identity.name, problem});
        done.deliver(std::move(result));
      });
}

void read_local_log(const request_context& context, log_query query,
                    outcome<log_excerpt> done) {
  const auto timeout = log_timeout(query);
  forward(context, context.services->supervisor, timeout, std::move(query),
          done);
}

void describe_cell(const request_context& context, cell_query query,
                   outcome<cell_description> done) {
  forward(context, context.services->coordinator, limits::local::answer, query,
          done);
}

void list_cells(const request_context& context, cell_list_query query,
                outcome<cell_list> done) {
  forward(context, context.services->coordinator, limits::local::answer, query,
          done);
}

void describe_tasks(const request_context& context, task_query query,
                    outcome<task_description> done) {
  forward(context, context.services->coordinator, limits::local::answer,
          std::move(query), done);
}

void describe_instances(const request_context& context, instance_query query,
                        outcome<instance_description> done) {
  forward(context, context.services->coordinator, limits::local::answer,
          std::move(query), done);
}

void list_skills(const request_context& context, skill_query query,
                 outcome<skill_list> done) {
  forward(context, context.services->coordinator, limits::local::answer,
          std::move(query), done);
}

void read_log(const request_context& context, log_query query,
              outcome<log_excerpt> done) {
  const auto timeout = log_timeout(query);
  forward(context, context.services->coordinator, timeout, std::move(query),
          done);
}

void terminate_task(const request_context& context, task_termination request,
                    outcome<task_terminated> done) {
  forward(context, context.services->coordinator, limits::task::termination,
          std::move(request), done);
}

void challenge_registration(const request_context& context,
                            registration_query query,
                            outcome<registration_challenge> done) {
  forward(context, context.services->membership, limits::local::answer, query,
          done);
}

void switch_registration(const request_context& context,
                         registration_switch order,
                         outcome<switch_accepted> done) {
  forward(context, context.services->membership, limits::local::answer,
          std::move(order), done);
}

void form_cell(const request_context& context, cell_formation request,
               outcome<cell_formed> done) {
  forward(context, context.services->coordinator, limits::transfer::answer,
          std::move(request), done);
}

void release_node(const request_context& context, node_release request,
                  outcome<node_released> done) {
  forward(context, context.services->coordinator, limits::transfer::answer,
          std::move(request), done);
}

void transfer_node(const request_context& context, node_transfer request,
                   outcome<node_transferred> done) {
  forward(context, context.services->coordinator, limits::transfer::answer,
          std::move(request), done);
}

void describe_transfers(const request_context& context, transfer_query query,
                        outcome<transfer_description> done) {
  forward(context, context.services->coordinator, limits::local::answer,
          std::move(query), done);
}

} // namespace roscell
