#include "test/actors/edge/session/session_fixture.hpp"

namespace roscell::test::wire {

session_callbacks session_ear::callbacks() {
  session_callbacks result;
  result.on_frame = [this](std::string text, std::function<void()> done) {
    if (keep_undone)
      undone.put(done);
    frames.put(std::move(text));
    if (!keep_undone)
      done();
  };
  result.on_closed = [this](const session_end& end) { ends.put(end); };
  return result;
}

acceptor_fixture::acceptor_fixture(session_options options, std::string token,
                                   http_limits limits, std::string on)
    : address(std::move(on)) {
  http_server_options server_options;
  server_options.address = address;
  server_options.port = 0;
  server_options.token = bearer;
  server_options.limits = limits;
  server_options.handler = [](const http_request&, const responder& answer) {
    answer.reply(200, "text/plain", "hello");
  };
  server = expect(http_server::start(io, std::move(server_options)));
  session_acceptor acceptor;
  acceptor.identity = base_node;
  acceptor.site = std::move(token);
  acceptor.options = std::move(options);
  acceptor.on_session = [this](established_session session) {
    sessions.put(std::move(session));
  };
  acceptor.on_refused = [this](const std::string&, const edge_error& why) {
    refusals.put(why);
  };
  server->accept_sessions(std::move(acceptor));
}

session_result acceptor_fixture::join(session_options options,
                                      std::string token,
                                      joiner_identity identity) {
  inbox<session_result> outcome;
  connect_session(
      io, target(), std::move(identity), std::move(token), std::move(options),
      [&](session_result result) { outcome.put(std::move(result)); });
  return outcome.take();
}

session_pair::session_pair(session_options of_acceptor, bool started,
                           session_options of_joiner)
    : acceptor_fixture(std::move(of_acceptor)),
      joiner(expect(join(std::move(of_joiner)))), acceptor(sessions.take()) {
  if (started)
    start();
}

void session_pair::start() {
  joiner.link->start(at_joiner.callbacks());
  acceptor.link->start(at_acceptor.callbacks());
}

} // namespace roscell::test::wire
