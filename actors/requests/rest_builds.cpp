#include "actors/requests/rest_builds.hpp"

#include "actors/builds/limits.hpp"
#include "actors/core/watching.hpp"
#include "actors/requests/rest_routes.hpp"

#include <caf/typed_event_based_actor.hpp>

#include <charconv>
#include <utility>

namespace roscell {

namespace {

constexpr const char* bytes_content = "application/octet-stream";

/// One request about a build that waits for the keeper.
struct build_exchange_state {
  static constexpr const char* name = "build-exchange";
};

using build_exchange_self =
    introspected_actor::stateful_pointer<build_exchange_state>;

bool is_sha256(const std::string& text) {
  constexpr size_t digits = 64;
  return text.size() == digits
         && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::optional<int64_t> whole_number(const std::string& text) {
  int64_t result = 0;
  const auto* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, result);
  if (text.empty() || read.ec != std::errc{} || read.ptr != end || result < 0)
    return std::nullopt;
  return result;
}

failure bad_part(const std::string& what) {
  return {error_code::schema_violation,
          "a build is asked for by its hash of 64 hexadecimal digits, its "
          "pieces by whole numbers: "
              + what + " is none"};
}

std::string text_of(const http_request& request, const char* name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? std::string{} : found->second;
}

std::variant<build_request, failure> read_query(const http_request& request,
                                                const std::string& hash) {
  const auto beyond = text_of(request, "beyond");
  if (beyond.empty())
    return build_request{build_query{hash}};
  const auto count = whole_number(beyond);
  if (!count && beyond != "-1")
    return bad_part("'beyond'");
  return build_request{build_query{hash, true, count.value_or(-1)}};
}

std::variant<build_request, failure> read_offer(const http_request& request,
                                                const std::string& hash) {
  const auto manifest = text_of(request, "manifest");
  const auto bytes = whole_number(text_of(request, "bytes"));
  if (!is_sha256(manifest))
    return bad_part("'manifest'");
  if (!bytes)
    return bad_part("'bytes'");
  return build_request{offer_build{{hash, manifest, *bytes}, request.body, ""}};
}

void answer_held(const responder& answer, const build_held& held) {
  std::string pieces;
  for (const bool x : held.pieces)
    pieces += x ? '1' : '0';
  answer.reply(200, json_content,
               json{{"pieces", pieces}, {"whole", held.whole}}.dump());
}

void answer_failure(const responder& answer, const caf::error& why) {
  const auto what = to_failure(why);
  answer.reply(http_status(what.code), json_content, error_reply(what).dump());
}

template <class Reply, class Message, class OnReply>
void ask_keeper(build_exchange_self self, const build_keeper_actor& keeper,
                std::chrono::milliseconds timeout, const Message& what,
                const responder& answer, OnReply on_reply) {
  self->request(keeper, timeout, what)
      .then(
          [self, answer, on_reply](Reply& reply) {
            on_reply(answer, reply);
            self->quit();
          },
          [self, answer](const caf::error& why) {
            answer_failure(answer, why);
            self->quit();
          });
}

/// Sends what is asked to the keeper, and the answer to the client.
struct build_asker {
  build_exchange_self self;
  const build_keeper_actor& keeper;
  const responder& answer;

  void operator()(const piece_query& x) const {
    ask_keeper<piece_read>(self, keeper, limits::build::disk, x, answer,
                           [](const responder& to, piece_read& read) {
                             to.reply(200, bytes_content,
                                      std::move(read.bytes));
                           });
  }

  void operator()(const offer_build& x) const {
    ask_keeper<build_held>(self, keeper, limits::build::disk, x, answer,
                           answer_held);
  }

  void operator()(const store_piece& x) const {
    ask_keeper<build_held>(self, keeper, limits::build::disk, x, answer,
                           answer_held);
  }

  /// Where nothing more comes for long it is said what is there.
  void operator()(const build_query& x) const {
    if (!x.wait)
      return ask_keeper<build_held>(self, keeper, limits::build::disk, x,
                                    answer, answer_held);
    self->request(keeper, limits::build::more, x)
        .then(
            [self = self, answer = answer](const build_held& held) {
              answer_held(answer, held);
              self->quit();
            },
            [self = self, keeper = keeper, answer = answer,
             hash = x.hash](const caf::error&) {
              build_asker{self, keeper, answer}(build_query{hash});
            });
  }
};

introspected_actor::behavior_type
build_exchange(build_exchange_self self, const build_keeper_actor& keeper,
               const build_request& what, const responder& answer) {
  watch_until_own_end(self, keeper);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  std::visit(build_asker{self, keeper, answer}, what);
  return {
      [](const state_query&) { return state_of(json::object()); },
  };
}

} // namespace

std::optional<std::variant<build_request, failure>>
build_route(const http_request& request, const std::vector<std::string>& path) {
  constexpr size_t hash_at = 2;
  constexpr size_t what_at = 3;
  constexpr size_t number_at = 4;
  const bool posts = request.method == "POST";
  if (path.size() <= hash_at || path[0] != "v1" || path[1] != "builds")
    return std::nullopt;
  const auto& hash = path[hash_at];
  if (!is_sha256(hash))
    return bad_part("'" + hash + "'");
  if (path.size() == what_at)
    return posts ? std::nullopt : std::optional{read_query(request, hash)};
  if (path.size() == number_at && path[what_at] == "manifest")
    return posts ? read_offer(request, hash) : build_request{piece_query{hash}};
  if (path.size() != number_at + 1 || path[what_at] != "pieces")
    return std::nullopt;
  const auto number = whole_number(path[number_at]);
  if (!number)
    return bad_part("'" + path[number_at] + "'");
  if (posts)
    return build_request{store_piece{hash, *number, request.body}};
  return build_request{piece_query{hash, *number}};
}

void start_build_exchange(caf::actor_system& system,
                          const actor_context& context,
                          const build_keeper_actor& keeper,
                          const build_request& what, const responder& answer) {
  spawn(system, context, build_exchange, keeper, what, answer);
}

} // namespace roscell
