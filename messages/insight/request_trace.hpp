#pragma once

#include "messages/codec/described.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// The way of a request through the coordinator that worked on it.
namespace roscell {

/// Asks for the latest requests that were worked on. Kept are the last 100.
struct request_trace_query {
  static constexpr const char* type = "request_trace_query";
  std::string subject; ///< The task or node they were about; empty: any.

  static constexpr auto fields() {
    return field_list{optional("subject", &request_trace_query::subject)};
  }
};

/// An actor that a handler has asked something.
struct trace_question {
  std::string actor;    ///< Its name.
  std::string node;     ///< Empty: an actor of this node.
  int64_t begin_us = 0; ///< Since the request came.
  int64_t span_us = -1; ///< Until its answer; negative: there was none.
  bool refused = false; ///< The answer was an error.

  static constexpr auto fields() {
    return field_list{required("actor", &trace_question::actor),
                      optional("node", &trace_question::node),
                      required("begin_us", &trace_question::begin_us),
                      optional("span_us", &trace_question::span_us),
                      optional("refused", &trace_question::refused)};
  }
};

/// A link of the pipeline that has worked on the request.
struct trace_hop {
  std::string handler;
  int64_t begin_us = 0; ///< Since the request came.
  int64_t span_us = -1; ///< Until the next hop, or the end; negative: it works.
  std::vector<trace_question> asked;
  int64_t dropped = 0; ///< Questions beyond those that are kept.

  static constexpr auto fields() {
    return field_list{required("handler", &trace_hop::handler),
                      required("begin_us", &trace_hop::begin_us),
                      optional("span_us", &trace_hop::span_us),
                      required("asked", &trace_hop::asked),
                      optional("dropped", &trace_hop::dropped)};
  }
};

struct request_trace {
  std::string request; ///< Message type.
  std::string subject; ///< The task or node it is about; may be empty.
  int64_t came_unix_ms = 0;
  int64_t span_us = -1; ///< Until the answer; negative: it is worked on.
  /// The code of its error; empty: it was done, or is worked on.
  std::string refusal;
  std::vector<trace_hop> hops;

  static constexpr auto fields() {
    return field_list{required("request", &request_trace::request),
                      optional("subject", &request_trace::subject),
                      required("came_unix_ms", &request_trace::came_unix_ms),
                      optional("span_us", &request_trace::span_us),
                      optional("refusal", &request_trace::refusal),
                      required("hops", &request_trace::hops)};
  }
};

/// Reply to `request_trace_query`, the oldest first.
struct request_traces {
  static constexpr const char* type = "request_traces";
  std::vector<request_trace> requests;

  static constexpr auto fields() {
    return field_list{required("requests", &request_traces::requests)};
  }
};

/// Asks why a task is where it is, or why it was refused. Kept are the last
/// 100 decisions, since the coordinator's start.
struct task_placement_query {
  static constexpr const char* type = "task_placement_query";
  std::string task;

  static constexpr auto fields() {
    return field_list{required("task", &task_placement_query::task)};
  }
};

/// Reply to `task_placement_query`: what was decided when the task was asked
/// for the last time.
struct task_placement {
  static constexpr const char* type = "task_placement";
  std::string task;
  int64_t decided_unix_ms = 0;
  std::string plan;    ///< JSON of a `task_plan`; empty: it was refused.
  std::string refusal; ///< JSON of the `error` then, else empty.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_placement::task),
        required("decided_unix_ms", &task_placement::decided_unix_ms),
        raw_json("plan", &task_placement::plan),
        raw_json("refusal", &task_placement::refusal)};
  }
};

} // namespace roscell
