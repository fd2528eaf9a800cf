#include "tools/roscell/daemon/waiting_answers.hpp"

#include "tools/roscell/exit_code.hpp"

#include <mutex>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

constexpr const char* remedy =
    "it starts as soon as that is there; `roscell doctor` checks this host, "
    "and SIGTERM ends the node";

template <class T>
T unless_failed(edge_result<T> result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    throw command_error{exit_refused, why->message, why->hint};
  return std::get<T>(std::move(result));
}

} // namespace

struct waiting_answers::shared_text {
  void set(const std::string& to) {
    const std::lock_guard guard{mutex};
    text = to;
  }

  std::string get() {
    const std::lock_guard guard{mutex};
    return text;
  }

  std::mutex mutex;
  std::string text;
};

waiting_answers::waiting_answers(const node_config& config)
    : lock_{unless_failed(directory_lock::take(config.data_dir))},
      missing_{std::make_shared<shared_text>()} {
  http_server_options options;
  options.address.clear();
  options.socket_path = config.socket.string();
  options.handler = [missing = missing_](const http_request& request,
                                         const responder& answer) {
    if (request.path == "/healthz")
      answer.reply(200, json_content, R"({"status":"ok"})");
    else
      answer.error(503, error_code::conflict,
                   "the node waits for its interface: " + missing->get(),
                   remedy);
  };
  server_ = unless_failed(http_server::start(io_, std::move(options)));
}

void waiting_answers::set_missing(const std::string& text) {
  missing_->set(text);
}

} // namespace roscell::cli
