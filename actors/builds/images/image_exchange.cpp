#include "actors/builds/images/image_exchange.hpp"

#include "actors/builds/build_store.hpp"
#include "actors/builds/limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

void ask_for_offer(image_exchange_pointer self, const std::string& image);

image_arrival* arrival_of(image_exchange_pointer self,
                          const std::string& image) {
  auto& xs = self->state.arrivals;
  const auto found = xs.find(image);
  return found == xs.end() ? nullptr : &found->second;
}

void end_arrival(image_exchange_pointer self, const std::string& image,
                 const caf::error& why) {
  auto node = self->state.arrivals.extract(image);
  if (node.empty())
    return;
  const auto& offer = node.mapped().offer;
  for (auto& x : node.mapped().promises) {
    if (why)
      x.deliver(why);
    else
      x.deliver(
          image_brought{offer.image_id, offer.node, offer.offer.build.bytes});
  }
}

void on_loaded(image_exchange_pointer self, const std::string& image) {
  const auto* x = arrival_of(self, image);
  if (x == nullptr)
    return;
  self->state.config.context.publish_event(
      events::image_fetched, image,
      {{"node", x->offer.node},
       {"image_id", x->offer.image_id},
       {"bytes", x->offer.offer.build.bytes},
       {"took_ms", unix_now_ms() - x->began_unix_ms}});
  end_arrival(self, image, {});
}

/// What has come and is no such image is of no use to anybody, and who has
/// given it is named. An engine that does not take an image without its lowest
/// layers gets the whole of it.
void on_not_loaded(image_exchange_pointer self, const std::string& image,
                   const caf::error& error) {
  auto* x = arrival_of(self, image);
  if (x == nullptr)
    return;
  auto why = to_failure(error);
  if (why.code == error_code::engine_failed && !x->layers.empty()) {
    x->layers.clear();
    return ask_for_offer(self, image);
  }
  if (why.code == error_code::schema_violation) {
    why.message = "node '" + x->offer.node + "': " + why.message;
    self->request(self->state.parts.keeper, limits::build::disk,
                  drop_build{x->offer.offer.build.hash})
        .then([](const build_dropped&) {}, [](const caf::error&) {});
  }
  end_arrival(self, image, to_error(why));
}

void load(image_exchange_pointer self, const std::string& image) {
  auto& st = self->state;
  const auto& offer = arrival_of(self, image)->offer;
  const auto folder =
      build_store::kept_in(st.config.builds) / offer.offer.build.hash;
  self->request(worker_of(self, st.mover), limits::image::loading,
                load_image{offer.image_id, image, folder.string()})
      .then([self, image](const image_loaded&) { on_loaded(self, image); },
            [self, image](const caf::error& why) {
              on_not_loaded(self, image, why);
            });
}

/// Another node may give it.
void on_not_fetched(image_exchange_pointer self, const std::string& image,
                    const caf::error& why) {
  const auto* x = arrival_of(self, image);
  if (x == nullptr)
    return;
  if (to_failure(why).code != error_code::unreachable
      || x->attempts == limits::image::attempts)
    return end_arrival(self, image, why);
  ask_for_offer(self, image);
}

void fetch(image_exchange_pointer self, const std::string& image,
           const image_offered& offer) {
  auto* x = arrival_of(self, image);
  if (x == nullptr)
    return;
  x->offer = offer;
  self->request(self->state.parts.fetcher, limits::build::fetch,
                fetch_build{offer.offer.build, offer.cell, offer.offer.sources})
      .then(
          [self, image](const build_fetched&) {
            if (arrival_of(self, image) != nullptr)
              load(self, image);
          },
          [self, image](const caf::error& why) {
            on_not_fetched(self, image, why);
          });
}

void ask_for_offer(image_exchange_pointer self, const std::string& image) {
  auto* x = arrival_of(self, image);
  if (x == nullptr)
    return;
  ++x->attempts;
  const auto& st = self->state;
  self->request(st.parts.broker, limits::image::offer_answer,
                image_request{image, st.config.architecture, st.config.node,
                              x->layers})
      .then([self,
             image](const image_offered& offer) { fetch(self, image, offer); },
            [self, image](const caf::error& why) {
              end_arrival(self, image, why);
            });
}

void on_layers(image_exchange_pointer self, const std::string& image,
               std::vector<std::string> layers) {
  if (auto* x = arrival_of(self, image))
    x->layers = std::move(layers);
  ask_for_offer(self, image);
}

caf::result<image_brought> bring(image_exchange_pointer self,
                                 const std::string& image) {
  auto& st = self->state;
  if (!st.parts.broker)
    return fail(error_code::conflict, "the node is still starting");
  auto promise = self->make_response_promise<image_brought>();
  if (auto* known = arrival_of(self, image)) {
    known->promises.push_back(promise);
    return promise;
  }
  auto& fresh = st.arrivals[image];
  fresh.promises.push_back(promise);
  fresh.began_unix_ms = unix_now_ms();
  self->request(worker_of(self, st.looker), limits::image::list, list_layers{})
      .then(
          [self, image](layers_listed& x) {
            on_layers(self, image, std::move(x.layers));
          },
          // Then all of it comes.
          [self, image](const caf::error&) { on_layers(self, image, {}); });
  return promise;
}

caf::result<image_known> look_up(image_exchange_pointer self,
                                 const image_query& query) {
  auto promise = self->make_response_promise<image_known>();
  self->request(worker_of(self, self->state.looker), limits::image::query,
                query)
      .then([promise](const image_known& x) mutable { promise.deliver(x); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
  return promise;
}

/// A worker that has ended is made again when it is needed.
void on_down(image_exchange_pointer self, const caf::down_msg& down) {
  auto& st = self->state;
  for (auto* which : {&st.looker, &st.mover})
    if (*which && which->address() == down.source)
      *which = nullptr;
}

json describe(const image_exchange_state& st) {
  json coming = json::object();
  for (const auto& [image, x] : st.arrivals)
    coming[image] = x.offer.node;
  return {{"arrivals", std::move(coming)},
          {"departures", st.departures.size()},
          {"shared", st.shared.size()}};
}

} // namespace

const image_worker_actor& worker_of(image_exchange_pointer self,
                                    image_worker_actor& which) {
  if (!which) {
    which = self->state.config.make_worker(
        caf::actor_cast<image_exchange_actor>(self));
    watch_until_its_end(self, which);
  }
  return which;
}

image_exchange_actor::behavior_type
image_exchange(image_exchange_pointer self,
               const image_exchange_config& config) {
  self->state.config = config;
  if (config.stop_workers)
    self->attach_functor(config.stop_workers);
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_down(self, down); });
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [self](const bring_image& x) { return bring(self, x.image); },
      [self](const image_query& x) { return look_up(self, x); },
      [self](const image_sharing& x) { return share_image(self, x); },
      [self](const serve_images& x) { self->state.parts = x; },
  };
}

} // namespace roscell
