#include "actors/builds/build_fetcher.hpp"

#include "actors/builds/limits.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

using build_fetcher_self =
    build_fetcher_actor::stateful_pointer<build_fetcher_state>;
using asked_kind = asked_source::kind;

void pump(build_fetcher_self self, const std::string& hash);
void ask_next_for_manifest(build_fetcher_self self, const std::string& hash);

running_fetch* fetch_of(build_fetcher_self self, const std::string& hash) {
  const auto found = self->state.fetches.find(hash);
  return found == self->state.fetches.end() ? nullptr : &found->second;
}

const build_source* source_of(const running_fetch& fetch,
                              const std::string& node) {
  for (const auto& x : fetch.order.sources)
    if (x.node == node)
      return &x;
  return nullptr;
}

/// Questions that are still under way find no fetch.
void end_fetch(build_fetcher_self self, const std::string& hash,
               const caf::error& why) {
  auto node = self->state.fetches.extract(hash);
  for (auto& x : node.mapped().promises) {
    if (why)
      x.deliver(why);
    else
      x.deliver(build_fetched{hash});
  }
}

void publish_end(build_fetcher_self self, const running_fetch& fetch) {
  json given = json::object();
  for (const auto& [source, pieces] : fetch.table->given())
    given[source] = pieces;
  self->state.config.context.publish_event(
      events::build_fetched, fetch.order.name.hash,
      {{"bytes", fetch.order.name.bytes},
       {"took_ms", unix_now_ms() - fetch.began_unix_ms},
       {"pieces", std::move(given)}});
}

void complete(build_fetcher_self self, const std::string& hash) {
  if (const auto* fetch = fetch_of(self, hash); fetch->table)
    publish_end(self, *fetch);
  end_fetch(self, hash, {});
}

/// A source that is asked no more is named, for somebody may have to mend it.
void publish_lost(build_fetcher_self self, const std::string& hash,
                  const std::string& source, const std::string& why) {
  self->state.config.context.publish_event(
      events::build_source_lost, hash, {{"source", source}, {"reason", why}});
}

/// Those of the table that are lost since there were `before` of them.
void publish_losses(build_fetcher_self self, const std::string& hash,
                    size_t before) {
  const auto& lost = fetch_of(self, hash)->table->lost();
  for (auto i = before; i < lost.size(); ++i)
    publish_lost(self, hash, lost[i].source, lost[i].why);
}

void strand(build_fetcher_self self, const std::string& hash) {
  const auto& fetch = *fetch_of(self, hash);
  std::string why = fetch.last_problem;
  if (fetch.table)
    for (const auto& x : fetch.table->lost())
      why += (why.empty() ? "" : "; ") + x.source + ": " + x.why;
  end_fetch(self, hash,
            fail(error_code::unreachable,
                 "no node gives the build "
                     + hash.substr(0, limits::build::shown_digits)
                     + (why.empty() ? "" : ": " + why),
                 "", "what has come of it is kept; try again"));
}

void ask(build_fetcher_self self, const asked_source& what,
         const std::string& target, std::chrono::milliseconds timeout) {
  auto& st = self->state;
  const auto* source = source_of(*fetch_of(self, what.hash), what.source);
  if (source == nullptr)
    return;
  const auto number = ++st.last_question;
  st.questions[number] = what;
  st.questions[number].at = self->clock().now();
  st.config.ask(self,
                {number, *source, "/v1/builds/" + what.hash + target, timeout});
}

void ask_what_is_there(build_fetcher_self self, const std::string& hash,
                       const std::string& source, int64_t beyond) {
  ask(self, {hash, source, asked_kind::pieces_there, 0, beyond, {}},
      "?beyond=" + std::to_string(beyond), limits::build::more_call);
}

void begin_pieces(build_fetcher_self self, const std::string& hash,
                  const build_held& held) {
  auto* fetch = fetch_of(self, hash);
  if (held.whole)
    return complete(self, hash);
  const auto seed = std::hash<std::string>{}(self->state.config.node + hash);
  fetch->table.emplace(held.pieces, seed);
  for (const auto& x : fetch->order.sources) {
    fetch->table->add_source(x.node);
    ask_what_is_there(self, hash, x.node, -1);
  }
}

void take_manifest(build_fetcher_self self, const asked_source& asked,
                   const std::string& text) {
  auto& st = self->state;
  const auto& order = fetch_of(self, asked.hash)->order;
  self->request(st.config.keeper, limits::build::disk,
                offer_build{order.name, text, order.cell})
      .then(
          [self, hash = asked.hash](const build_held& held) {
            if (const auto* fetch = fetch_of(self, hash);
                fetch != nullptr && !fetch->table)
              begin_pieces(self, hash, held);
          },
          [self, asked](const caf::error& why) {
            auto* fetch = fetch_of(self, asked.hash);
            if (fetch == nullptr)
              return;
            const auto what = to_failure(why);
            if (what.code != error_code::schema_violation)
              return end_fetch(self, asked.hash, why);
            fetch->last_problem = asked.source + ": " + what.message;
            publish_lost(self, asked.hash, asked.source, what.message);
            ask_next_for_manifest(self, asked.hash);
          });
}

void ask_next_for_manifest(build_fetcher_self self, const std::string& hash) {
  auto& fetch = *fetch_of(self, hash);
  if (fetch.asked_for_manifest == fetch.order.sources.size())
    return strand(self, hash);
  const auto& source = fetch.order.sources[fetch.asked_for_manifest++];
  ask(self, {hash, source.node, asked_kind::manifest, 0}, "/manifest",
      limits::build::piece_call);
}

/// What a source says that it has; nothing if it says no such thing.
std::optional<std::vector<bool>> read_pieces(const std::string& body) {
  const auto document = parse_document(body);
  const auto* answer = std::get_if<json>(&document);
  if (answer == nullptr || !answer->is_object())
    return std::nullopt;
  const auto pieces = answer->find("pieces");
  if (pieces == answer->end() || !pieces->is_string())
    return std::nullopt;
  std::vector<bool> result;
  for (const char c : pieces->get_ref<const std::string&>())
    result.push_back(c == '1');
  return result;
}

void take_what_is_there(build_fetcher_self self, const asked_source& asked,
                        const std::string& body) {
  auto& table = *fetch_of(self, asked.hash)->table;
  const auto pieces = read_pieces(body);
  if (!pieces)
    return table.drop_source(asked.source, "it does not say what it has");
  table.announce(asked.source, *pieces);
  const auto count = std::count(pieces->begin(), pieces->end(), true);
  if (count <= asked.beyond
      && self->clock().now() - asked.at < limits::build::least_wait)
    return table.drop_source(asked.source, "it does not wait for more");
  if (static_cast<size_t>(count) < pieces->size())
    ask_what_is_there(self, asked.hash, asked.source,
                      count + count / limits::build::part_of_news);
}

void publish_progress(build_fetcher_self self, running_fetch& fetch) {
  const auto now = self->clock().now();
  if (now < fetch.next_progress)
    return;
  fetch.next_progress = now + limits::build::progress;
  self->state.config.context.publish_event(
      events::build_fetching, fetch.order.name.hash,
      {{"pieces", fetch.table->pieces_here()},
       {"of", fetch.table->here().size()}});
}

void take_piece(build_fetcher_self self, const asked_source& asked,
                std::string bytes) {
  const fetch_table::question question{asked.piece, asked.source};
  self->state.config.context.count(metric::builds_received_bytes,
                                   {asked.source},
                                   static_cast<double>(bytes.size()));
  self->request(self->state.config.keeper, limits::build::disk,
                store_piece{asked.hash, static_cast<int64_t>(asked.piece),
                            std::move(bytes)})
      .then(
          [self, question, hash = asked.hash](const build_held& held) {
            auto* fetch = fetch_of(self, hash);
            if (fetch == nullptr || !fetch->table)
              return;
            fetch->table->take(question);
            if (held.whole)
              return complete(self, hash);
            publish_progress(self, *fetch);
            pump(self, hash);
          },
          [self, question, hash = asked.hash](const caf::error& why) {
            auto* fetch = fetch_of(self, hash);
            if (fetch == nullptr || !fetch->table)
              return;
            const auto what = to_failure(why);
            if (what.code != error_code::schema_violation)
              return end_fetch(self, hash, why);
            const auto lost = fetch->table->lost().size();
            fetch->table->blame(question, what.message);
            publish_losses(self, hash, lost);
            pump(self, hash);
          });
}

/// Asks for what can be asked now, and looks again when some of it is slow.
void pump(build_fetcher_self self, const std::string& hash) {
  auto& st = self->state;
  auto& table = *fetch_of(self, hash)->table;
  if (table.stranded())
    return strand(self, hash);
  const auto now = self->clock().now();
  for (const auto& x : table.next(now))
    ask(self, {hash, x.source, asked_kind::piece, x.piece},
        "/pieces/" + std::to_string(x.piece), limits::build::piece_call);
  st.timer.set(self, now + limits::build::slow);
}

void pump_all(build_fetcher_self self) {
  std::vector<std::string> running;
  for (const auto& [hash, x] : self->state.fetches)
    if (x.table)
      running.push_back(hash);
  for (const auto& hash : running)
    pump(self, hash);
}

void on_no_answer(build_fetcher_self self, const asked_source& asked,
                  const std::string& why) {
  auto& fetch = *fetch_of(self, asked.hash);
  if (asked.what == asked_kind::manifest) {
    fetch.last_problem = asked.source + ": " + why;
    return ask_next_for_manifest(self, asked.hash);
  }
  const auto lost = fetch.table->lost().size();
  if (asked.what == asked_kind::piece)
    fetch.table->fail({asked.piece, asked.source}, why);
  else
    fetch.table->drop_source(asked.source, why);
  publish_losses(self, asked.hash, lost);
  pump(self, asked.hash);
}

/// What a refusal says, as far as it can be read.
std::string reason_of(const source_answered& x) {
  if (x.status == 0)
    return x.why.message;
  return "it answers with status " + std::to_string(x.status);
}

void on_answer(build_fetcher_self self, source_answered& x) {
  constexpr int64_t good = 200;
  auto node = self->state.questions.extract(x.question);
  if (node.empty())
    return;
  const auto& asked = node.mapped();
  const auto* fetch = fetch_of(self, asked.hash);
  if (fetch == nullptr
      || fetch->table.has_value() == (asked.what == asked_kind::manifest))
    return;
  if (x.status != good)
    return on_no_answer(self, asked, reason_of(x));
  if (asked.what == asked_kind::manifest)
    return take_manifest(self, asked, x.body);
  if (asked.what == asked_kind::piece)
    return take_piece(self, asked, std::move(x.body));
  const auto lost = fetch->table->lost().size();
  take_what_is_there(self, asked, x.body);
  publish_losses(self, asked.hash, lost);
  pump(self, asked.hash);
}

/// What has come of it earlier is gone on with.
void begin_fetch(build_fetcher_self self, const std::string& hash) {
  self->request(self->state.config.keeper, limits::build::disk,
                build_query{hash})
      .then(
          [self, hash](const build_held& held) {
            if (fetch_of(self, hash) != nullptr)
              begin_pieces(self, hash, held);
          },
          [self, hash](const caf::error&) {
            if (fetch_of(self, hash) != nullptr)
              ask_next_for_manifest(self, hash);
          });
}

/// More sources for a fetch that runs.
void add_sources(build_fetcher_self self, const fetch_build& x) {
  const auto& hash = x.name.hash;
  auto& fetch = *fetch_of(self, hash);
  for (const auto& source : x.sources) {
    if (source_of(fetch, source.node) != nullptr
        || fetch.order.sources.size() == limits::build::sources)
      continue;
    fetch.order.sources.push_back(source);
    if (!fetch.table)
      continue;
    fetch.table->add_source(source.node);
    ask_what_is_there(self, hash, source.node, -1);
  }
}

caf::result<build_fetched> fetch(build_fetcher_self self,
                                 const fetch_build& x) {
  auto& st = self->state;
  const auto& hash = x.name.hash;
  auto promise = self->make_response_promise<build_fetched>();
  if (auto* known = fetch_of(self, hash)) {
    known->promises.push_back(promise);
    add_sources(self, x);
    return promise;
  }
  running_fetch fresh;
  fresh.order = x;
  fresh.began_unix_ms = unix_now_ms();
  fresh.promises.push_back(promise);
  st.fetches.emplace(hash, std::move(fresh));
  begin_fetch(self, hash);
  return promise;
}

} // namespace

build_fetcher_actor::behavior_type
build_fetcher(build_fetcher_self self, const build_fetcher_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        json fetches = json::object();
        for (const auto& [hash, x] : self->state.fetches)
          fetches[hash] = x.table ? x.table->pieces_here() : 0;
        return state_of({{"fetches", std::move(fetches)}});
      },
      [self](const fetch_build& x) { return fetch(self, x); },
      // A piece is large: it is moved, not copied.
      [self](source_answered& x) { on_answer(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          pump_all(self);
      },
  };
}

} // namespace roscell
