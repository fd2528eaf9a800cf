#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/pull_refusal.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

using continuation = std::function<void()>;

void fail_base(engine_runtime_pointer self, const std::string& key,
               const std::string& why, const std::string& hint) {
  if (const auto* work = find_work(self, key))
    fail_work(self, key, build_failure(self->state, *work, why, hint));
}

/// Instances that wait hear how it gets on.
void report_step(engine_runtime_pointer self, image_work& work,
                 std::string step) {
  work.step = std::move(step);
  report_build_steps(self);
}

/// The engine knows it. By a digest only who has pulled it does.
void go_on(engine_runtime_pointer self, const std::string& key,
           const std::string& id, const continuation& then) {
  auto* work = find_work(self, key);
  if (work == nullptr)
    return;
  work->has_base = true;
  work->silent_at.reset();
  if (!parse_image_reference(work->request.base_image).digest.empty())
    work->base = id;
  then();
}

void look_for(engine_runtime_pointer self, const std::string& name,
              const std::function<void(const engine_answered&)>& then) {
  engine_request request;
  request.target = "/images/" + image_path(name) + "/json";
  ask_engine(self, std::move(request), then);
}

std::string id_in(const engine_answered& x) {
  const auto id = text_at(object_of(x), "Id");
  return id.find(':') == std::string::npos && !id.empty() ? "sha256:" + id : id;
}

void on_pulled(engine_runtime_pointer self, const std::string& key,
               const continuation& then, const engine_answered& x) {
  auto* work = find_work(self, key);
  if (work == nullptr)
    return;
  work->build = {};
  const auto image = work->request.base_image;
  const auto& engine = self->state.config.setting.engine;
  if (is_lost(x))
    return fail_base(self, key, x.why.message, x.why.hint);
  if (!is_good(x) || !work->error.empty()) {
    const auto why =
        pull_refusal(engine, image, is_good(x) ? work->error : x.body);
    return fail_base(self, key, why.message, why.hint);
  }
  look_for(self, image, [=](const engine_answered& found) {
    if (!is_good(found)) {
      const auto why =
          pull_refusal(engine, image, "it was pulled, and is not there");
      return fail_base(self, key, why.message, why.hint);
    }
    self->state.config.context.publish_event(
        events::image_pulled, image,
        {{"registry", parse_image_reference(image).registry},
         {"image_id", id_in(found)}});
    go_on(self, key, id_in(found), then);
  });
}

void pull(engine_runtime_pointer self, const std::string& key,
          const std::string& login, const continuation& then) {
  auto& work = *find_work(self, key);
  const auto about = parse_image_reference(work.request.base_image);
  engine_request request;
  request.method = "POST";
  request.target =
      "/images/create?fromImage=" + percent_encode(about.name) + "&tag="
      + percent_encode(about.digest.empty() ? about.tag : about.digest);
  if (!login.empty())
    request.headers["X-Registry-Auth"] = login;
  request.limit = limits::engine::build;
  report_step(self, work,
              "pulls " + work.request.base_image + " from " + about.registry);
  work.silent_at = self->clock().now() + limits::engine::pull_silence;
  self->state.timer.set(self, *work.silent_at);
  auto opened =
      stream_lines(self, std::move(request), [=](const engine_answered& x) {
        on_pulled(self, key, then, x);
      });
  work.call = opened.call;
  work.build = std::move(opened.stream);
}

/// From its registry, with what this host's user has logged in there with.
void begin_pull(engine_runtime_pointer self, const std::string& key,
                const continuation& then) {
  const auto* work = find_work(self, key);
  if (work == nullptr)
    return;
  const auto& image = work->request.base_image;
  if (!parse_image_reference(image).id.empty())
    return fail_base(self, key, "no node has the image " + image,
                     "an id is in no registry: name the image in skill.json");
  ask_packer<login_found>(self, key, limits::engine::plan, find_login{image},
                          [=](image_work&, const login_found& x) {
                            pull(self, key, x.header, then);
                          });
}

/// From a node whose engine has it: in a cell without internet a registry would
/// be waited for in vain.
void bring(engine_runtime_pointer self, const std::string& key,
           const continuation& then) {
  auto& work = *find_work(self, key);
  const auto image = work.request.base_image;
  const auto& images = self->state.config.images;
  if (!images)
    return begin_pull(self, key, then);
  report_step(self, work, "asks the cell for " + image);
  self->request(images, limits::engine::bring, bring_image{image})
      .then([=](const image_brought& x) { go_on(self, key, x.image_id, then); },
            [=](const caf::error& why) {
              self->state.config.context.publish_event(
                  events::image_not_fetched, image,
                  {{"reason", to_failure(why).message}});
              begin_pull(self, key, then);
            });
}

/// By a name of ours, if its own is a digest.
void look_for_pinned(engine_runtime_pointer self, const std::string& key,
                     const continuation& then) {
  const auto image = find_work(self, key)->request.base_image;
  const auto name = name_in_engine(image);
  if (name == image)
    return bring(self, key, then);
  look_for(self, name, [=](const engine_answered& x) {
    if (find_work(self, key) == nullptr)
      return;
    if (is_good(x))
      return go_on(self, key, id_in(x), then);
    bring(self, key, then);
  });
}

} // namespace

void find_base(engine_runtime_pointer self, const std::string& key,
               continuation then) {
  look_for(self, find_work(self, key)->request.base_image,
           [=](const engine_answered& x) {
             if (find_work(self, key) == nullptr)
               return;
             if (is_good(x))
               return go_on(self, key, id_in(x), then);
             if (x.status != 404)
               return fail_work(
                   self, key,
                   engine_failure("cannot look for the base image", x));
             look_for_pinned(self, key, then);
           });
}

void end_silent_pulls(engine_runtime_pointer self) {
  const auto now = self->clock().now();
  std::vector<std::string> silent;
  for (const auto& [key, work] : self->state.works) {
    if (work.silent_at && now >= *work.silent_at)
      silent.push_back(key);
    else if (work.silent_at)
      self->state.timer.set(self, *work.silent_at);
  }
  for (const auto& key : silent) {
    const auto why = pull_silence(self->state.config.setting.engine,
                                  find_work(self, key)->request.base_image);
    fail_base(self, key, why.message, why.hint);
  }
}

} // namespace roscell
