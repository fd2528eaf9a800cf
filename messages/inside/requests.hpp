#pragma once

#include "messages/actors.hpp"

#include <map>
#include <string>
#include <vector>

/// What requests from outside become inside a node: the ROUTER and its
/// pipelines are told these, and who relays requests, and the NODE.
namespace roscell {

/// A request as it came in at an edge.
struct route_request {
  std::string text; ///< Bytes from outside, not checked yet.
  std::string only; ///< The one type that is allowed; empty: any.
  std::string from; ///< Who asks, for people to read: "user root", an address.

  static constexpr auto fields() {
    return field_list{required("text", &route_request::text),
                      required("only", &route_request::only),
                      optional("from", &route_request::from)};
  }
};

/// The answer: a reply or an error, as JSON text.
struct request_routed {
  std::string text;
  /// Code of a refusal; empty when the request was done.
  std::string refusal;

  static constexpr auto fields() {
    return field_list{required("text", &request_routed::text),
                      required("refusal", &request_routed::refusal)};
  }
};

/// A request that a member of the cell is to answer itself.
struct relay_request {
  std::string node;
  std::string text; ///< JSON of the request, checked.

  static constexpr auto fields() {
    return field_list{required("node", &relay_request::node),
                      required("text", &relay_request::text)};
  }
};

/// Who answers requests that do not come in at an edge: to the COORDINATOR,
/// what its members ask on behalf of their users; to the MEMBERSHIP, what its
/// coordinator asks; to the CONTAINER SUPERVISOR, what programs wish.
struct use_router {
  request_router_actor router;

  static constexpr auto fields() {
    return field_list{required("router", &use_router::router)};
  }
};

/// Begins the work on the request that the pipeline was made for.
struct process_request {
  static constexpr auto fields() {
    return field_list{};
  }
};

struct request_processed {
  std::string text; ///< JSON of the reply.

  static constexpr auto fields() {
    return field_list{required("text", &request_processed::text)};
  }
};

/// What can change of a node that runs. Each part of it takes what is its own.
struct use_settings {
  std::vector<std::string> skill_dirs; ///< Besides the usual ones.
  std::map<std::string, std::string> labels;
  std::vector<std::string> devices; ///< Offered besides those found.
  double cpu_floor = 0;

  static constexpr auto fields() {
    return field_list{required("skill_dirs", &use_settings::skill_dirs),
                      required("labels", &use_settings::labels),
                      required("devices", &use_settings::devices),
                      required("cpu_floor", &use_settings::cpu_floor)};
  }
};

/// Ends the node in order: leaves the cell, closes the edges, keeps instances.
struct stop_node {
  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
