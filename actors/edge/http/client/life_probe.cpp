#include "actors/edge/http/client/http_exchange.hpp"

#include <utility>

namespace roscell {

namespace {

/// A server that ends the connection or sends nonsense lives.
bool is_sign_of_life(const http_outcome& outcome) {
  const auto* why = std::get_if<http_failure>(&outcome);
  return why == nullptr
         || (why->what != http_failure::kind::timeout
             && why->what != http_failure::kind::no_connection);
}

} // namespace

life_probe::life_probe(std::shared_ptr<io_core> core, http_call question,
                       std::chrono::milliseconds pause,
                       std::function<void()> on_silent)
    : core_(std::move(core)), question_(std::move(question)), pause_(pause),
      on_silent_(std::move(on_silent)), timer_(core_->context()) {
  // nop
}

void life_probe::wait() {
  ++waits_;
  timer_.expires_after(pause_);
  timer_.async_wait([self = weak_from_this()](boost::system::error_code ec) {
    if (const auto probe = self.lock(); probe && !ec)
      probe->ask();
  });
}

void life_probe::ask() {
  call_http(core_, question_,
            [self = weak_from_this(), waits = waits_](auto outcome) {
              // Bytes that came meanwhile are an answer, too.
              if (const auto probe = self.lock();
                  probe && probe->waits_ == waits)
                probe->on_answer(outcome);
            });
}

void life_probe::on_answer(const http_outcome& outcome) {
  if (is_sign_of_life(outcome))
    wait();
  else
    on_silent_();
}

} // namespace roscell
