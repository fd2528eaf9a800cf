#include <roscell/client.hpp>

#include <iostream>

/// Prints what happens in the cell of a node, until the node goes away.
/// Usage: watcher /path/of/node.sock
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: watcher /path/of/node.sock\n";
    return 2;
  }
  const roscell::client node{{argv[1], "", 0, ""}};
  try {
    std::cout << node.get("/v1/tasks") << '\n';
    node.follow_events(0, [](const roscell::node_event& x) {
      std::cout << x.sequence << ' ' << x.what << ' ' << x.subject << std::endl;
      return true;
    });
  } catch (const roscell::client_error& error) {
    std::cerr << "watcher: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
