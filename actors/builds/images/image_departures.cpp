#include "actors/builds/images/image_exchange.hpp"
#include "actors/builds/limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/edge/io/crypto.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// What is left out may be something else for another reader.
std::string departure_key(const image_sharing& request) {
  sha256_sum layers;
  for (const auto& x : request.layers)
    layers.add_text(x);
  return request.image_id + ' ' + layers.hex();
}

template <class Result>
void end_departure(image_exchange_pointer self, const std::string& key,
                   const Result& result) {
  auto node = self->state.departures.extract(key);
  if (!node.empty())
    for (auto& x : node.mapped().promises)
      x.deliver(result);
}

void on_stored(image_exchange_pointer self, const std::string& key,
               const build_name& build) {
  auto& st = self->state;
  const auto found = st.departures.find(key);
  if (found == st.departures.end())
    return;
  const auto& x = found->second;
  st.config.context.publish_event(
      events::image_shared, x.request.image_id,
      {{"build", build.hash},
       {"bytes", build.bytes},
       {"took_ms", unix_now_ms() - x.began_unix_ms}});
  if (st.shared.size() == limits::image::remembered)
    st.shared.pop_front();
  st.shared.emplace_back(key, build);
  end_departure(self, key, image_shared{build});
}

void store(image_exchange_pointer self, const std::string& key,
           const image_saved& saved) {
  auto& st = self->state;
  const auto found = st.departures.find(key);
  if (found == st.departures.end())
    return;
  self->request(st.parts.keeper, limits::build::disk,
                take_build{saved.name, saved.manifest,
                           found->second.request.cell, saved.folder})
      .then([self, key](const build_held& x) { on_stored(self, key, x.name); },
            [self, key](const caf::error& why) {
              end_departure(self, key, why);
            });
}

void save(image_exchange_pointer self, const std::string& key) {
  auto& st = self->state;
  const auto found = st.departures.find(key);
  if (found == st.departures.end())
    return;
  const auto& request = found->second.request;
  self->request(worker_of(self, st.mover), limits::image::saving,
                save_image{request.image_id, request.layers,
                           static_cast<int64_t>(st.config.most_bytes)})
      .then([self, key](const image_saved& x) { store(self, key, x); },
            [self, key](const caf::error& why) {
              end_departure(self, key, why);
            });
}

/// What was saved before may be among the builds still.
void begin_departure(image_exchange_pointer self, const std::string& key) {
  auto& st = self->state;
  const auto known =
      std::find_if(st.shared.begin(), st.shared.end(),
                   [&](const auto& x) { return x.first == key; });
  if (known == st.shared.end())
    return save(self, key);
  const auto build = known->second;
  st.shared.erase(known);
  self->request(st.parts.keeper, limits::build::disk, build_query{build.hash})
      .then(
          [self, key, build](const build_held& x) {
            if (!x.whole)
              return save(self, key);
            self->state.shared.emplace_back(key, build);
            end_departure(self, key, image_shared{build});
          },
          [self, key](const caf::error&) { save(self, key); });
}

} // namespace

caf::result<image_shared> share_image(image_exchange_pointer self,
                                      const image_sharing& request) {
  auto& st = self->state;
  if (!st.parts.keeper)
    return fail(error_code::conflict, "the node is still starting");
  auto promise = self->make_response_promise<image_shared>();
  const auto key = departure_key(request);
  auto& x = st.departures[key];
  x.promises.push_back(promise);
  if (x.promises.size() > 1)
    return promise;
  x.request = request;
  x.began_unix_ms = unix_now_ms();
  begin_departure(self, key);
  return promise;
}

} // namespace roscell
