#include "actors/cell/image_offers.hpp"

#include "actors/builds/limits.hpp"
#include "actors/cell/state/build_offers.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// One offer from its request to its answer.
struct image_offering {
  image_request request;
  image_holders holders;
  size_t asked = 0; ///< Nodes that have not answered yet.
  image_choice choice;
  size_t tried = 0; ///< Of the nodes in `choice`.
  std::string last_problem;
  caf::typed_response_promise<image_offered> promise;
};

using offering_ptr = std::shared_ptr<image_offering>;

void refuse_offer(const offering_ptr& x, const failure& why) {
  x->promise.deliver(to_error(why));
}

/// Who reads goes on with what it has where several nodes give it.
void conclude_offer(coordinator_pointer self, const offering_ptr& x,
                    const std::string& source, const build_name& build) {
  auto& st = self->state;
  st.images.add_source(x->choice.image_id, build.hash, source);
  const auto& reader = x->request.node;
  image_offered result{
      x->choice.image_id, source, st.setup.cell,
      offer_from(st, build, reader, st.images.of_build(build.hash))};
  st.images.add_reader(build.hash, reader);
  x->promise.deliver(std::move(result));
}

/// Has the next node that has the image make a build of it.
void ask_to_share(coordinator_pointer self, const offering_ptr& x) {
  auto& st = self->state;
  const auto& nodes = x->choice.nodes;
  if (x->tried == std::min(nodes.size(), limits::image::sources_tried))
    return refuse_offer(x, {error_code::unreachable,
                            "no node gives the image '" + x->request.image
                                + "': " + x->last_problem});
  const auto node = nodes[x->tried++];
  const auto* entry = st.registry.find_name(node);
  if (entry == nullptr || !entry->agent) {
    x->last_problem = node + ": it is away";
    return ask_to_share(self, x);
  }
  self->request(
          entry->agent, limits::image::sharing_answer,
          image_sharing{x->choice.image_id, st.setup.cell, x->request.layers})
      .then(
          [self, x, node](const image_shared& reply) {
            conclude_offer(self, x, node, reply.build);
          },
          [self, x, node](const caf::error& why) {
            x->last_problem = node + ": " + to_failure(why).message;
            ask_to_share(self, x);
          });
}

void on_known(coordinator_pointer self, const offering_ptr& x,
              const std::string& node, const std::string& image_id) {
  x->holders[node] = image_id;
  if (--x->asked > 0)
    return;
  const auto& images = self->state.images;
  x->choice = choose_image(x->holders, {});
  x->choice = choose_image(x->holders, images.givers_of(x->choice.image_id));
  if (x->choice.nodes.empty())
    return refuse_offer(
        x, {error_code::conflict,
            "no node of the cell has the image '" + x->request.image + "'"});
  ask_to_share(self, x);
}

/// Nodes that are there and pass builds on.
std::vector<std::string> possible_sources(const cell_coordinator_state& st,
                                          const image_request& request) {
  std::vector<std::string> result;
  for (const auto& row : st.registry.rows()) {
    const auto* entry = st.registry.find_uuid(row.identity.uuid);
    if (row.state == row_state::active && entry->agent && entry->fetches_builds
        && row.identity.name != request.node)
      result.push_back(row.identity.name);
  }
  return result;
}

} // namespace

caf::result<image_offered> offer_image(coordinator_pointer self,
                                       const image_request& request) {
  const auto& st = self->state;
  if (st.registry.find_name(request.node) == nullptr)
    return fail(error_code::unknown_node,
                "this cell has no node '" + request.node + "'", "/node");
  auto x = std::make_shared<image_offering>();
  x->request = request;
  const auto sources = possible_sources(st, request);
  if (sources.empty())
    return fail(error_code::conflict,
                "no other node of the cell could have the image '"
                    + request.image + "'");
  x->asked = sources.size();
  x->promise = self->make_response_promise<image_offered>();
  for (const auto& node : sources)
    self->request(st.registry.find_name(node)->agent,
                  limits::image::query_answer,
                  image_query{request.image, request.architecture})
        .then(
            [self, x, node](const image_known& reply) {
              on_known(self, x, node, reply.image_id);
            },
            [self, x, node](const caf::error&) {
              on_known(self, x, node, {});
            });
  return x->promise;
}

} // namespace roscell
