#include "actors/edge/session/address_probe.hpp"

#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/reach/udp_question.hpp"
#include "actors/edge/session/limits.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <cerrno>
#include <utility>
#include <variant>

namespace roscell {

namespace {

/// What is gathered. Io thread only.
struct address_probing {
  server_probed result;
  size_t open = 0;
  std::function<void(server_probed)> done;

  void finish_one() {
    if (--open == 0)
      done(std::move(result));
  }
};

port_answer meaning_of(const http_failure& why) {
  using kind = http_failure::kind;
  switch (why.what) {
  case kind::timeout:
    return port_answer::silent;
  case kind::no_connection:
    return why.system_error == ECONNREFUSED ? port_answer::closed
           : why.system_error == ETIMEDOUT  ? port_answer::silent
                                            : port_answer::unreachable;
  default:
    return port_answer::unauthenticated_peer;
  }
}

/// What an unauthenticated peer has said, if it is what a node says.
std::vector<node_hello> read_hello(const std::string& body) {
  auto parsed = parse_document(body);
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || validate_message(*document, {message_kind::reply}))
    return {};
  auto hello = decode<node_hello>(*document);
  if (auto* x = std::get_if<node_hello>(&hello))
    return {std::move(*x)};
  return {};
}

probed_port to_port(uint16_t port, const http_outcome& outcome) {
  probed_port result;
  result.port = port;
  if (const auto* why = std::get_if<http_failure>(&outcome)) {
    result.answer = meaning_of(*why);
    return result;
  }
  result.hello = read_hello(std::get<http_reply>(outcome).body);
  result.answer = result.hello.empty() ? port_answer::unauthenticated_peer
                                       : port_answer::found;
  return result;
}

} // namespace

void ask_for_hello(const std::shared_ptr<io_core>& core,
                   const socket_address& node,
                   const std::shared_ptr<site_identity>& identity,
                   std::function<void(probed_port)> done) {
  http_call what;
  what.to.address = node.address;
  what.to.port = node.port;
  what.to.identity = identity;
  what.target = hello_path;
  what.timeout = limits::membership::probed_port;
  call_http(core, what,
            [port = node.port, done = std::move(done)](
                const http_outcome& outcome) { done(to_port(port, outcome)); });
}

void probe_address(const std::shared_ptr<io_core>& core,
                   const std::string& local_address,
                   const socket_address& server,
                   const std::shared_ptr<site_identity>& identity,
                   std::function<void(server_probed)> done) {
  const auto all = std::make_shared<address_probing>();
  all->done = std::move(done);
  std::vector<uint16_t> ports{server.port};
  if (const auto usual = http_endpoint{}.port; usual != server.port)
    ports.push_back(usual);
  all->result.tcp.resize(ports.size());
  all->open = ports.size() + 1;
  for (size_t i = 0; i < ports.size(); ++i)
    ask_for_hello(core, {server.address, ports[i]}, identity,
                  [all, i](probed_port x) {
                    all->result.tcp[i] = std::move(x);
                    all->finish_one();
                  });
  ask_discovery_port(core, local_address, server,
                     limits::membership::probed_port,
                     [all](const udp_answer& x) {
                       all->result.discovery = x.answer;
                       all->finish_one();
                     });
}

} // namespace roscell
