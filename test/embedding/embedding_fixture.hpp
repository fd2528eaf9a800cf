#pragma once

#include "messages/codec/json_codec.hpp"
#include "roscell/node.hpp"
#include "test/places.hpp"
#include "test/temp_folder.hpp"

#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/scoped_actor.hpp>

#include <catch2/catch.hpp>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

namespace roscell::test {

/// A coordinator on this host alone, with ports of its own.
inline node_setup setup_in(const std::filesystem::path& folder) {
  // The file of the user who runs the tests is none of theirs.
  ::setenv("ROSCELL_SITE_TOKEN", (folder / "site.token").c_str(), 1);
  node_setup result;
  result.node.name = "controller";
  result.node.coordinator = true;
  result.node.address = "127.0.0.1";
  result.node.http_port = 0;
  result.node.discovery_port = 0;
  result.node.runtime = "process";
  result.node.data_dir = folder / "data";
  result.node.shim = test::build_dir() / "bin/roscell-instance-shim";
  result.node.public_domain_id = static_cast<uint8_t>(100 + ::getpid() % 100);
  return result;
}

/// Ends of a step by the protocol "actor".
inline json actor_end(const std::string& name) {
  return {
      {"protocol", "actor"}, {"endpoint", name}, {"data_type", "text/plain"}};
}

inline std::string descriptor_of(const std::string& operation) {
  const json port{{"data_types", {"text/plain"}}, {"protocols", {"actor"}}};
  return json{{"operation", operation},
              {"engine", "actor"},
              {"input", port},
              {"output", port},
              {"models",
               {{{"name", "plain"},
                 {"deployments",
                  {{{"name", "here"},
                    {"architectures", {"amd64", "arm64"}},
                    {"resources",
                     {{"cpu", 0}, {"memory_mib", 1}, {"disk_mib", 0}}}}}}}}}}
      .dump();
}

/// Asks by messages, from an actor system that knows nothing of nodes.
class asker {
public:
  explicit asker(const embedded_node& node)
      : system_(config_), self_(system_), door_(node.door()) {}

  json ask(const json& request) {
    json result;
    self_
        ->request(door_, std::chrono::seconds{60}, node_request{request.dump()})
        .receive([&](const node_reply& x) { result = json::parse(x.json); },
                 [&](const caf::error& why) { FAIL(system_.render(why)); });
    return result;
  }

private:
  caf::actor_system_config config_;
  caf::actor_system system_;
  caf::scoped_actor self_;
  node_door_actor door_;
};

} // namespace roscell::test
