#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/engine_search.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/fake_engine.hpp"

#include <cerrno>
#include <fstream>

namespace roscell::test::wire {

namespace {

/// A client and the engine that a test plays.
struct engine_bench {
  explicit engine_bench(fake_engine::handler handle)
      : engine(folder / "s", std::move(handle)) {
    // nop
  }

  engine_answer ask(engine_request what) {
    inbox<engine_answer> answers;
    client.request(std::move(what),
                   [&](engine_answer x) { answers.put(std::move(x)); });
    return answers.take();
  }

  temp_folder folder;
  fake_engine engine;
  io_thread io;
  engine_client client{io.core(), folder / "s"};
};

engine_request ask_for(std::string target) {
  engine_request result;
  result.target = std::move(target);
  return result;
}

/// A streamed answer as it comes.
struct heard {
  inbox<std::string> said;
  bool enough = false;

  engine_stream_callbacks callbacks() {
    engine_stream_callbacks result;
    result.on_open = [this] { said.put("open"); };
    result.on_bytes = [this](std::string_view bytes) {
      said.put(std::string{bytes});
      return !enough;
    };
    result.on_end = [this](engine_answer x) {
      const auto* why = std::get_if<edge_error>(&x);
      said.put(why != nullptr
                   ? "error " + to_string(why->code)
                   : "end " + std::to_string(std::get<engine_reply>(x).status));
    };
    return result;
  }
};

} // namespace

TEST_CASE("an engine is asked with method, path and body") {
  inbox<engine_call_seen> seen;
  engine_bench b{[&](engine_caller& who, const engine_call_seen& what) {
    seen.put(what);
    who.reply(201, R"({"Id":"c"})");
  }};
  engine_request request;
  request.method = "POST";
  request.target = "/containers/create?name=" + percent_encode("a b/c");
  request.body = "{}";
  const auto reply = expect(b.ask(request));
  CHECK(reply.status == 201);
  CHECK(reply.ok());
  CHECK(reply.body == R"({"Id":"c"})");
  const auto what = seen.take();
  CHECK(what.method == "POST");
  CHECK(what.target == "/containers/create?name=a%20b%2Fc");
  CHECK(what.body == "{}");
}

TEST_CASE("a file is sent as it is") {
  inbox<engine_call_seen> seen;
  engine_bench b{[&](engine_caller& who, const engine_call_seen& what) {
    seen.put(what);
    who.reply(200, "");
  }};
  const std::string content(300'000, 'x');
  std::ofstream{b.folder / "tar"} << content;
  engine_request request;
  request.method = "POST";
  request.target = "/build";
  request.file = b.folder / "tar";
  CHECK(expect(b.ask(request)).status == 200);
  CHECK(seen.take().body == content);
  request.file = b.folder / "none";
  CHECK(expect_error(b.ask(request)).code == error_code::engine_failed);
}

TEST_CASE("an engine may refuse a file before it has read it") {
  temp_folder folder;
  io_thread io;
  const std::string content(8 << 20, 'x');
  std::ofstream{folder / "tar"} << content;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const auto path = folder / "s";
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::listen(fd, 1);
  engine_request request;
  request.method = "POST";
  request.target = "/build";
  request.file = folder / "tar";
  inbox<engine_answer> answers;
  engine_client{io.core(), path}.request(
      request, [&](engine_answer x) { answers.put(std::move(x)); });
  {
    const engine_caller caller{::accept(fd, nullptr, nullptr)};
    caller.reply(500, R"({"message":"no"})");
    CHECK(expect(answers.take()).status == 500);
  }
  ::close(fd);
}

TEST_CASE("errors name the socket and the remedy") {
  io_thread io;
  temp_folder folder;
  const auto path = folder / "none";
  inbox<engine_answer> answers;
  engine_client{io.core(), path}.request(
      ask_for("/"), [&](engine_answer x) { answers.put(std::move(x)); });
  const auto why = expect_error(answers.take());
  CHECK(why.code == error_code::unreachable);
  CHECK(why.message.find(path) != std::string::npos);
  CHECK(why.hint.find("start the engine") != std::string::npos);
  const auto denied = no_engine("/s", EACCES);
  CHECK(denied.code == error_code::unauthorized);
  CHECK(denied.hint.find("group docker") != std::string::npos);
  const auto found = find_engine({path, folder / "other"});
  CHECK(expect_error(found).message.find(path) != std::string::npos);
}

TEST_CASE("an engine's refusal is told in its own words") {
  CHECK(engine_refusal("x", {404, R"({"message":"No such image: a"})"}).message
        == "x: No such image: a");
  CHECK(engine_refusal("x", {500, R"({"cause":"c","message":"m"})"}).message
        == "x: m: c");
  CHECK(engine_refusal("x", {500, "plain\n"}).message == "x: plain");
  CHECK(engine_refusal("x", {500, ""}).message == "x: HTTP status 500");
  CHECK(engine_refusal("x", {500, "write: no space left on device"}).hint
        != "");
}

TEST_CASE("a long refusal is told by its beginning and its end") {
  const auto why =
      engine_refusal("x", {500, "3 errors" + std::string(10'000, '.')
                                    + "no space left on device"});
  CHECK(why.message.find("x: 3 errors") == 0);
  CHECK(why.message.find("no space left on device") != std::string::npos);
  CHECK(why.message.size() < 3000);
  CHECK(why.hint != "");
}

TEST_CASE("an engine that cannot give a GPU is told with the remedy") {
  CHECK(engine_refusal("x", {500, R"(could not select device driver "nvidia")"})
            .hint.find("nvidia-ctk runtime configure")
        != std::string::npos);
  CHECK(engine_refusal("x", {500, "unresolvable CDI devices nvidia.com/gpu=0"})
            .hint.find("nvidia-ctk cdi generate")
        != std::string::npos);
}

TEST_CASE("the remedy for an engine that is away is that engine's own") {
  const auto hint = [](const std::string& socket, int error) {
    return no_engine(socket, error).hint;
  };
  CHECK(hint("/run/podman/podman.sock", ECONNREFUSED)
        == "start the engine: systemctl start podman.socket");
  CHECK(hint("/run/user/1000/podman/podman.sock", ECONNREFUSED)
        == "start the engine: systemctl --user start podman.socket");
  CHECK(hint("/run/podman/podman.sock", EACCES).find("--user enable")
        != std::string::npos);
}

TEST_CASE("a streamed answer comes as it is sent") {
  engine_bench b{[](engine_caller& who, const engine_call_seen&) {
    who.open();
    who.chunk("one\n");
    who.end();
  }};
  heard h;
  const auto stream = b.client.stream(ask_for("/events"), h.callbacks());
  CHECK(h.said.take() == "open");
  CHECK(h.said.take() == "one\n");
  CHECK(h.said.take() == "end 200");
}

TEST_CASE("a stream that breaks is told, one that is refused has its status") {
  heard h;
  SECTION("broken") {
    engine_bench b{[](engine_caller& who, const engine_call_seen&) {
      who.open();
      who.chunk("one\n");
      who.hang_up();
    }};
    const auto stream = b.client.stream(ask_for("/events"), h.callbacks());
    CHECK(h.said.take() == "open");
    CHECK(h.said.take() == "one\n");
    CHECK(h.said.take() == "error unreachable");
  }
  SECTION("refused") {
    engine_bench b{[](engine_caller& who, const engine_call_seen&) {
      who.reply(404, "{}");
    }};
    const auto stream = b.client.stream(ask_for("/events"), h.callbacks());
    CHECK(h.said.take() == "end 404");
  }
  SECTION("who has enough ends it") {
    h.enough = true;
    engine_bench b{[](engine_caller& who, const engine_call_seen&) {
      who.open();
      who.chunk("one\n");
    }};
    const auto stream = b.client.stream(ask_for("/events"), h.callbacks());
    CHECK(h.said.take() == "open");
    CHECK(h.said.take() == "one\n");
    CHECK(h.said.take() == "end 200");
  }
}

TEST_CASE("a stream that is let go says nothing more and hangs up") {
  inbox<bool> gone;
  engine_bench b{[&](engine_caller& who, const engine_call_seen&) {
    who.open();
    who.chunk("one\n");
    who.read(); // Until the client hangs up.
    gone.put(true);
  }};
  heard h;
  {
    const auto stream = b.client.stream(ask_for("/events"), h.callbacks());
    CHECK(h.said.take() == "open");
    CHECK(h.said.take() == "one\n");
  }
  CHECK(gone.take());
  settle(b.io);
  CHECK(h.said.size() == 0);
}

TEST_CASE("an engine that does not answer is given up") {
  engine_bench b{[](engine_caller&, const engine_call_seen&) {}};
  auto request = ask_for("/");
  request.limit = 50ms;
  CHECK(expect_error(b.ask(request)).code == error_code::timeout);
}

TEST_CASE("an answer without an end is given up") {
  engine_bench b{[](engine_caller& who, const engine_call_seen&) {
    who.open();
    const std::string piece(1 << 20, 'x');
    for (size_t i = 0; i <= limits::engine::reply_bytes >> 20; ++i)
      who.chunk(piece);
    who.end();
  }};
  CHECK(expect_error(b.ask(ask_for("/"))).code == error_code::unreachable);
}

} // namespace roscell::test::wire
