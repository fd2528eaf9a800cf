#include "actors/edge/engine/build_context.hpp"
#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/engine/image_packer.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

std::string key_of(const prepare_image& request) {
  return request.skill + ' ' + request.base_image;
}

template <class Result>
void conclude(engine_runtime_pointer self, const std::string& key,
              const Result& result) {
  auto& works = self->state.works;
  const auto i = works.find(key);
  if (i == works.end())
    return;
  auto work = std::move(i->second);
  works.erase(i);
  std::error_code ignored;
  if (!work.context.empty())
    std::filesystem::remove(work.context, ignored);
  if (work.packer)
    caf::anon_send_exit(work.packer, caf::exit_reason::user_shutdown);
  for (auto& x : work.waiters)
    x.promise.deliver(result);
}

/// A plan holds as long as the libraries of this host that go into the image
/// are what they were: an upgrade makes another image.
bool has_plan(const engine_runtime_state& st, const std::string& key) {
  const auto i = st.plans.find(key);
  return i != st.plans.end() && are_unchanged(i->second.made_of);
}

std::string joined(const std::deque<std::string>& lines) {
  std::string result;
  for (const auto& line : lines)
    result += line + '\n';
  return result;
}

} // namespace

image_work* find_work(engine_runtime_pointer self, const std::string& key) {
  const auto i = self->state.works.find(key);
  return i != self->state.works.end() ? &i->second : nullptr;
}

void conclude_work(engine_runtime_pointer self, const std::string& key,
                   const image_prepared& result) {
  if (const auto* work = find_work(self, key))
    for (const auto& x : work->waiters)
      self->state.named[x.instance] = result.image;
  conclude(self, key, result);
}

void fail_work(engine_runtime_pointer self, const std::string& key,
               const caf::error& why) {
  conclude(self, key, why);
}

caf::error build_failure(const engine_runtime_state& st, const image_work& work,
                         const std::string& why, const std::string& hint) {
  const auto what =
      "the image of '" + work.request.operation + "' cannot be built: " + why;
  const json details{{"log_tail", joined(work.log)}};
  return to_error(
      {error_code::engine_failed,
       what,
       {},
       hint.empty() && !work.has_base
           ? "the base image must be on this host or in a registry that it "
             "reaches: "
                 + st.config.setting.engine + " pull " + work.request.base_image
           : hint,
       details.dump(-1, ' ', false, json::error_handler_t::replace)});
}

namespace {

void find_image(engine_runtime_pointer self, const std::string& key);

void on_built(engine_runtime_pointer self, const std::string& key,
              const engine_answered& x) {
  auto* work = find_work(self, key);
  if (work == nullptr)
    return;
  work->build = {};
  if (is_lost(x))
    return conclude(
        self, key,
        build_failure(self->state, *work, x.why.message, x.why.hint));
  if (!is_good(x) || !work->error.empty()) {
    const auto why = engine_refusal(
        "the engine says", is_good(x) ? engine_reply{x.status, work->error}
                                      : engine_reply{x.status, x.body});
    return conclude(self, key,
                    build_failure(self->state, *work, why.message, why.hint));
  }
  const auto spent = std::chrono::duration_cast<std::chrono::milliseconds>(
      self->clock().now() - work->began);
  self->state.config.context.publish_event(
      events::image_built, work->image,
      {{"operation", work->request.operation}, {"ms", spent.count()}});
  clean_images(self);
  conclude_work(self, key, image_prepared{work->image});
}

void build(engine_runtime_pointer self, const std::string& key) {
  auto& work = *find_work(self, key);
  engine_request request;
  request.method = "POST";
  // What a base image does in a build sees the network as an instance does.
  request.target = "/build?rm=1&forcerm=1&networkmode=host"
                   "&dockerfile=Dockerfile&t="
                   + percent_encode(work.image);
  request.file = work.context;
  request.limit = limits::engine::build;
  work.began = self->clock().now();
  auto opened =
      stream_lines(self, std::move(request),
                   [=](const engine_answered& x) { on_built(self, key, x); });
  work.call = opened.call;
  work.build = std::move(opened.stream);
}

void pack(engine_runtime_pointer self, const std::string& key) {
  ask_packer<image_packed>(self, key, limits::engine::pack,
                           pack_image{find_work(self, key)->base},
                           [=](image_work& work, const image_packed& x) {
                             work.context = x.file;
                             build(self, key);
                           });
}

void plan(engine_runtime_pointer self, const std::string& key) {
  auto& st = self->state;
  auto& work = *find_work(self, key);
  work.packer = spawn_blocking(self->system(), st.config.context, image_packer,
                               st.config.data_dir / "build", st.config.logins,
                               caf::actor_cast<engine_runtime_actor>(self));
  ask_packer<image_planned>(self, key, limits::engine::plan, work.request,
                            [=](image_work&, const image_planned& x) {
                              self->state.plans[key] = {x.image, x.made_of};
                              find_image(self, key);
                            });
}

/// Takes the image if it is there, and makes it if it is not.
void find_image(engine_runtime_pointer self, const std::string& key) {
  auto& work = *find_work(self, key);
  work.image = self->state.plans.at(key).image;
  engine_request request;
  request.target = "/images/" + work.image + "/json";
  ask_engine(self, std::move(request), [=](const engine_answered& x) {
    auto* found = find_work(self, key);
    if (found == nullptr)
      return;
    if (is_good(x))
      return conclude_work(self, key, image_prepared{found->image});
    if (x.status != 404)
      return conclude(self, key,
                      engine_failure("cannot look for the image", x));
    if (!found->packer)
      return plan(self, key);
    find_base(self, key, [=] { pack(self, key); });
  });
}

/// The step that a line of a build tells of; empty: it tells of none.
std::string step_of(const json& line) {
  auto text = text_at(line, "stream");
  if (text.empty())
    text = text_at(line, "status") + " " + text_at(line, "progress");
  const auto end = text.find_last_not_of(" \r\n");
  text.resize(end == std::string::npos ? 0 : end + 1);
  return text.substr(0, limits::engine::build_line_bytes);
}

/// Whether a line tells of more than the engine's own bookkeeping.
bool is_step(const std::string& line) {
  return line.rfind(" --->", 0) != 0 && line.rfind("Removing ", 0) != 0;
}

void report_build_step(engine_runtime_pointer self, image_work& work) {
  auto& st = self->state;
  const auto step = std::exchange(work.step, {});
  work.next_status = self->clock().now() + limits::engine::build_status;
  st.config.context.publish_event(events::image_building, work.image,
                                  {{"step", step}});
  notification notified;
  notified.status = step;
  for (const auto& x : work.waiters)
    self->send(st.listener, status_notification(x.instance, notified, false));
}

} // namespace

caf::result<image_prepared> prepare(engine_runtime_pointer self,
                                    const prepare_image& request) {
  const auto key = key_of(request);
  auto promise = self->make_response_promise<image_prepared>();
  auto* work = find_work(self, key);
  const bool is_first = work == nullptr;
  if (is_first) {
    work = &self->state.works[key];
    work->request = request;
  }
  work->waiters.push_back({request.instance, promise});
  if (is_first && has_plan(self->state, key))
    find_image(self, key);
  else if (is_first)
    plan(self, key);
  return promise;
}

void on_build_lines(engine_runtime_pointer self, image_work& work,
                    const std::vector<std::string>& lines) {
  for (const auto& text : lines) {
    const auto line = json::parse(text, nullptr, false);
    if (!line.is_object())
      continue;
    const auto step = step_of(line);
    if (auto error = text_at(line, "error"); !error.empty())
      work.error = error;
    if (work.silent_at)
      work.silent_at = self->clock().now() + limits::engine::pull_silence;
    if (step.empty())
      continue;
    work.has_base = work.has_base || step.rfind("Step 2/", 0) == 0
                    || step.rfind("STEP 2/", 0) == 0;
    work.log.push_back(step);
    if (work.log.size() > limits::engine::kept_build_lines)
      work.log.pop_front();
    if (is_step(step))
      work.step = step;
  }
  report_build_steps(self);
}

void report_build_steps(engine_runtime_pointer self) {
  const auto now = self->clock().now();
  for (auto& [key, work] : self->state.works) {
    if (!work.step.empty() && now >= work.next_status)
      report_build_step(self, work);
    else if (!work.step.empty())
      self->state.timer.set(self, work.next_status);
  }
}

} // namespace roscell
