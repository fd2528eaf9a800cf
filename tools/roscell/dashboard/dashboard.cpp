#include "actors/edge/http/http_server.hpp"
#include "actors/edge/io/crypto.hpp"
#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/dashboard/open_page.hpp"
#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/service_signals.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <variant>

namespace roscell::cli {

namespace {

/// Nobody guesses it.
constexpr size_t secret_bytes = 16;

struct dashboard_options {
  connection_options connection;
  uint16_t port = 0;
  bool no_browser = false;
};

void require_coordinator(const node_client& node) {
  if (node.get("/v1/node").get<node_description>().role
      != node_role::coordinator)
    throw command_error{exit_usage, "only a coordinator has a dashboard",
                        "name it with --to; `roscell status` shows its "
                        "address"};
}

std::unique_ptr<http_server> serve(io_thread& io, const http_endpoint& node,
                                   const std::string& secret, uint16_t port) {
  http_server_options options;
  options.port = port;
  options.path_secret = secret;
  options.hosts = {"127.0.0.1", "localhost"};
  options.public_paths = {};
  options.handler = make_forwarding(io.core(), node, dashboard_pages());
  auto made = http_server::start(io, std::move(options));
  if (const auto* why = std::get_if<edge_error>(&made))
    throw command_error{exit_usage, why->message,
                        why->hint.empty() ? "choose another --port"
                                          : why->hint};
  return std::get<std::unique_ptr<http_server>>(std::move(made));
}

int show_dashboard(const dashboard_options& options) {
  stop_signals signals;
  const node_client node{options.connection};
  require_coordinator(node);
  const auto secret = to_hex(random_bytes(secret_bytes));
  io_thread io;
  const auto server = serve(io, node.endpoint(), secret, options.port);
  const auto url = "http://127.0.0.1:" + std::to_string(server->port()) + "/"
                   + secret + "/dashboard/";
  print(url + "\n");
  std::optional<opened_page> page;
  if (!options.no_browser)
    print_note(page.emplace(url).has_begun()
                   ? "if no page comes, open this address in a browser on this "
                     "machine"
                   : "no browser was found here: open this address in one on "
                     "this machine");
  print_note("Ctrl-C ends it");
  signals.wait();
  return exit_done;
}

} // namespace

void add_dashboard_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<dashboard_options>();
  auto* command = app.add_subcommand(
      "dashboard", "Show the cell in a browser, until Ctrl-C.");
  command->footer(
      "The page is served on this machine's 127.0.0.1 only, at an address with "
      "a secret that is\nanother one each time; who has the address acts as "
      "you do. From elsewhere:\n`ssh -L PORT:127.0.0.1:PORT HOST`.\n\n"
      "Examples:\n  roscell dashboard\n"
      "  roscell dashboard --to 192.168.1.10 --token-file token --no-browser");
  add_connection_options(*command, options->connection);
  command
      ->add_option("--port", options->port,
                   "TCP port of this machine; 0: any free one")
      ->option_text("PORT [0]");
  command->add_flag("--no-browser", options->no_browser,
                    "Only print the address; start no browser");
  command->callback([&chosen, options] {
    chosen = [options] { return show_dashboard(*options); };
  });
}

} // namespace roscell::cli
