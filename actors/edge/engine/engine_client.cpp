#include "actors/edge/engine/engine_client.hpp"

#include "actors/edge/engine/engine_exchange.hpp"
#include "actors/edge/io/utf8.hpp"
#include "actors/house/limits.hpp"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

using json = nlohmann::json;

std::string text_of(const json& document, const char* name) {
  const auto i = document.find(name);
  return i != document.end() && i->is_string() ? i->get<std::string>()
                                               : std::string{};
}

std::string words_of(const std::string& body) {
  const auto document = json::parse(body, nullptr, false);
  if (!document.is_object())
    return body;
  auto result = text_of(document, "message");
  const auto cause = text_of(document, "cause");
  if (!cause.empty() && result.find(cause) == std::string::npos)
    result += (result.empty() ? "" : ": ") + cause;
  return result;
}

} // namespace

engine_stream::engine_stream(std::shared_ptr<io_core> core,
                             std::shared_ptr<engine_exchange> exchange)
    : core_(std::move(core)), exchange_(std::move(exchange)) {
  // nop
}

engine_stream& engine_stream::operator=(engine_stream&& other) noexcept {
  if (this != &other) {
    cancel();
    core_ = std::move(other.core_);
    exchange_ = std::move(other.exchange_);
  }
  return *this;
}

engine_stream::~engine_stream() {
  cancel();
}

void engine_stream::cancel() noexcept {
  if (exchange_)
    core_->post([exchange = std::move(exchange_)] { exchange->cancel(); });
  exchange_ = nullptr;
}

engine_client::engine_client(std::shared_ptr<io_core> core, std::string socket)
    : core_(std::move(core)), socket_(std::move(socket)) {
  // nop
}

void engine_client::request(
    engine_request what, std::function<void(engine_answer)> on_answer) const {
  auto exchange = std::make_shared<engine_exchange>(
      core_, socket_, std::move(what),
      engine_stream_callbacks{{}, {}, std::move(on_answer)});
  core_->post([exchange] { exchange->start(); });
}

engine_stream engine_client::stream(engine_request what,
                                    engine_stream_callbacks calls) const {
  auto exchange = std::make_shared<engine_exchange>(
      core_, socket_, std::move(what), std::move(calls));
  core_->post([exchange] { exchange->start(); });
  return {core_, exchange};
}

edge_error engine_refusal(const std::string& what, const engine_reply& reply) {
  auto words =
      valid_utf8(words_of(reply.body).substr(0, limits::engine::words_bytes));
  while (!words.empty() && (words.back() == '\n' || words.back() == '.'))
    words.pop_back();
  if (words.empty())
    words = "HTTP status " + std::to_string(reply.status);
  const bool full = words.find("no space left") != std::string::npos;
  return {error_code::engine_failed, what + ": " + words,
          full ? "free space on the engine's disk: docker system df" : ""};
}

edge_error no_engine(const std::string& socket, int error_number) {
  const auto where = "the container engine on '" + socket + "'";
  switch (error_number) {
  case ENOENT:
    return {error_code::unreachable,
            "no container engine: there is no socket '" + socket + "'",
            "start the engine (systemctl start docker), or name its socket: "
            "--runtime docker:SOCKET"};
  case EACCES:
  case EPERM:
    return {error_code::unauthorized, "no permission to use " + where,
            "add the node's user to the group docker (sudo usermod -aG docker "
            "USER), or start the node as root"};
  case ECONNREFUSED:
    return {error_code::unreachable,
            "nobody listens: " + where + " does not run",
            "start the engine: systemctl start docker"};
  default:
    return {error_code::unreachable,
            "cannot reach " + where + ": "
                + std::generic_category().message(error_number),
            "is the engine running? systemctl status docker"};
  }
}

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
                       || (c >= '0' && c <= '9') || c == '-' || c == '_'
                       || c == '.' || c == '~';
    if (plain)
      result += c;
    else
      (((result += '%') += digits[byte >> 4]) += digits[byte & 15]);
  }
  return result;
}

} // namespace roscell
