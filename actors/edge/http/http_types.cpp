#include "actors/edge/http/http_types.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace roscell {

namespace {

/// What a second answer to one request gets.
class closed_stream : public http_stream {
public:
  bool write(std::string) override {
    return false;
  }

  void on_closed(std::function<void()> callback) override {
    if (callback)
      callback();
  }

  void close() override {
    // nop
  }

  void break_off() override {
    // nop
  }
};

} // namespace

/// Lets one answer through.
struct responder::once {
  explicit once(std::shared_ptr<reply_sink> to) : sink(std::move(to)) {
    // nop
  }

  once(const once&) = delete;
  once& operator=(const once&) = delete;

  ~once() {
    if (!answered)
      sink->reply({500, json_content,
                   error_body(error_code::internal,
                              "the request was dropped without an answer")});
  }

  bool take() {
    return !answered.exchange(true);
  }

  std::shared_ptr<reply_sink> sink;
  std::atomic<bool> answered{false};
};

responder::responder(std::shared_ptr<reply_sink> sink)
    : once_(std::make_shared<once>(std::move(sink))) {
  // nop
}

void responder::reply(int status, std::string content_type,
                      std::string body) const {
  if (once_->take())
    once_->sink->reply({status, std::move(content_type), std::move(body)});
}

void responder::error(int status, error_code code, std::string_view message,
                      std::string_view hint) const {
  reply(status, json_content, error_body(code, message, hint));
}

std::shared_ptr<http_stream> responder::stream(std::string content_type) const {
  if (once_->take())
    return once_->sink->stream(std::move(content_type));
  return std::make_shared<closed_stream>();
}

std::string error_body(error_code code, std::string_view message,
                       std::string_view hint, std::string_view where) {
  using json = nlohmann::json;
  const json body{{"type", "error"},
                  {"error",
                   {{"code", to_word(code)},
                    {"message", message},
                    {"where", where},
                    {"hint", hint}}}};
  return body.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace roscell
