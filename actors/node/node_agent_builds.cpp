#include "actors/builds/limits.hpp"
#include "actors/node/node_agent.hpp"
#include "messages/failure.hpp"

#include <caf/typed_response_promise.hpp>

#include <utility>

namespace roscell {

namespace {

using refusal = std::function<void(const caf::error&)>;

void read_folders(node_agent_pointer self, const std::function<void()>& done,
                  const refusal& refuse) {
  self->request(self->state.builds.watcher, limits::build::disk, read_skills{})
      .then([done](const skills_read&) { done(); },
            [refuse](const caf::error& why) { refuse(why); });
}

/// A build that has come is a skill once its folder has been read.
void use_fetched(node_agent_pointer self, const std::string& hash,
                 const std::function<void()>& done, const refusal& refuse) {
  self->request(self->state.builds.keeper, limits::build::disk, use_build{hash})
      .then([self, done,
             refuse](const build_held&) { read_folders(self, done, refuse); },
            [refuse](const caf::error& why) { refuse(why); });
}

caf::error fetches_nothing(const std::string& node) {
  return fail(error_code::conflict,
              "node '" + node + "' gets no builds from others");
}

} // namespace

void with_build(node_agent_pointer self, const instance_deployment& request,
                const std::function<void()>& done,
                const std::function<void(const caf::error&)>& refuse) {
  const auto& st = self->state;
  if (request.fetch.build.hash.empty())
    return done();
  if (!st.builds.fetcher)
    return refuse(fetches_nothing(st.config.node));
  self->request(st.builds.fetcher, limits::build::fetch,
                fetch_build{request.fetch.build, request.spec.cell,
                            request.fetch.sources})
      .then(
          [self, done, refuse, hash = request.fetch.build.hash](
              const build_fetched&) { use_fetched(self, hash, done, refuse); },
          [refuse](const caf::error& why) { refuse(why); });
}

caf::result<build_kept> keep_build(node_agent_pointer self,
                                   const build_keeping& request) {
  const auto& st = self->state;
  if (!st.builds.fetcher)
    return fetches_nothing(st.config.node);
  auto promise = self->make_response_promise<build_kept>();
  const auto refuse = [promise](const caf::error& why) mutable {
    promise.deliver(why);
  };
  const auto& hash = request.offer.build.hash;
  const std::function<void()> answer = [promise, hash]() mutable {
    promise.deliver(build_kept{hash});
  };
  // One that is pinned stays so until the cell releases it.
  const auto pin = [self, request, answer, refuse] {
    if (!request.pinned)
      return answer();
    self->request(self->state.builds.keeper, limits::build::disk,
                  pin_build{request.offer.build.hash, true, request.cell})
        .then([answer](const build_held&) { answer(); }, refuse);
  };
  self->request(
          st.builds.fetcher, limits::build::fetch,
          fetch_build{request.offer.build, request.cell, request.offer.sources})
      .then([pin](const build_fetched&) { pin(); }, refuse);
  return promise;
}

caf::result<build_released> release_build(node_agent_pointer self,
                                          const build_release& request) {
  const auto& st = self->state;
  if (!st.builds.keeper)
    return fetches_nothing(st.config.node);
  auto promise = self->make_response_promise<build_released>();
  const auto answer = [promise, hash = request.hash]() mutable {
    promise.deliver(build_released{hash});
  };
  const auto refuse = [promise](const caf::error& why) mutable {
    promise.deliver(why);
  };
  self->request(st.builds.keeper, limits::build::disk, drop_build{request.hash})
      .then([self, answer, refuse](
                const build_dropped&) { read_folders(self, answer, refuse); },
            refuse);
  return promise;
}

} // namespace roscell
