#include "actors/builds/limits.hpp"
#include "actors/cell/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/limits.hpp"
#include "actors/edge/dds/limits.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/limits.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/instances/limits.hpp"
#include "actors/membership/limits.hpp"
#include "actors/node/limits.hpp"
#include "actors/placement/limits.hpp"
#include "actors/requests/limits.hpp"
#include "actors/session/limits.hpp"

#include <cstdint>

/// How the limits of all packages nest. Who waits for another one waits longer
/// than that one does, so that the answer says what went wrong.
namespace roscell::limits {

static_assert(lease::heartbeat_period + lease::probe_interval
              < lease::span - lease::urgent_span);

static_assert(local::part < local::answer);

static_assert(store::write < local::answer);

static_assert(resource::mark_distance < lease::heartbeat_period);
static_assert(resource::sample_distance * resource::samples
              > resource::least_sample_age);
static_assert(resource::collection < local::answer);
static_assert(resource::scrape_collection < resource::collection);

static_assert(instance::most + instance::most_ended < instance::reported);
static_assert(instance::shim < instance::start);
static_assert(instance::announced_watchdog < instance::watchdog
              && instance::announced_watchdog / 2 < instance::pause_grace);
static_assert(3 * instance::force_interval < instance::stop);
static_assert(instance::force < instance::stop);

static_assert(instance::parameter_answer < instance::parameters
              && instance::parameters < session::parameters - session::margin
              && session::parameters < task::agent_parameters
              && task::agent_parameters < task::parameters
              && task::parameters < instance::parameter_request);

static_assert(build::more < build::more_call
              && build::piece_call < build::fetch);
static_assert(build::fetch < instance::deployment);
static_assert(build::keeping < build::keeping_session
              && build::keeping_session < build::keeping_answer
              && 2 * build::keeping_answer < build::addition);

static_assert(engine::call < image::query
              && image::query < image::query_session - session::margin
              && image::query_session < image::query_answer);
static_assert(engine::save + engine::image_tar < image::saving);
static_assert(image::sharing < image::sharing_session - session::margin
              && image::sharing_session < image::sharing_answer
              && image::offer < image::offer_session
              && image::offer_session < image::offer_answer);
static_assert(engine::image_tar + engine::load < image::loading);
static_assert(engine::bring < instance::build);

static_assert(2 * engine::pack_step < engine::pack);
static_assert(engine::build < instance::build);
static_assert(engine::create + engine::probe < instance::start);
static_assert(engine::start < instance::start);

static_assert(session::handshake < session::open);
static_assert(session::pending_calls <= session::known_calls);
static_assert(session::kept_answer_bytes < session::frame_bytes);
static_assert(2 * instance::most_unacknowledged_bytes < session::frame_bytes);
static_assert(session::margin < session::peer_answer);
static_assert(session::margin < session::metrics);

static_assert(membership::leaving < membership::stopping);
static_assert(retry::longest + membership::search + membership::registration
              < membership::expected_name_held);
static_assert(membership::probed_port < membership::probed
              && membership::silence + membership::probed < membership::search);
static_assert(membership::naming < membership::search);
static_assert(membership::row < membership::registration
              && membership::registration < lease::span);
static_assert(2 * session::peer_answer < membership::place);
static_assert(membership::departure < membership::leaving);
static_assert(membership::name_held == lease::span);

static_assert(unauthenticated_peers::peer_calls
                  + unauthenticated_peers::proof_calls
              <= 8);

static_assert(cell::rows + 1 <= UINT8_MAX + 1, "each row has a server's id");
static_assert(cell::registration_call < cell::invitation);
static_assert(cell::registration_call < unauthenticated_peers::proof);
static_assert(cell::invitation + cell::arrival < cell::invited_place);

static_assert(task::allocation_budget < task::search
              && task::offline_allocation_budget < task::search);
static_assert(2 * task::move_budget < task::search);
static_assert(local::part < task::reservation);
static_assert(task::reservation < task::longest_reservation);
static_assert(store::write < local::answer && local::answer < task::deployment);
static_assert(instance::deployment < task::agent_deployment);
static_assert(task::agent_deployment < task::deployment - session::margin);
static_assert(task::deployment < task::deployment_answer);
static_assert(instance::removal < task::agent_removal);
static_assert(task::agent_removal < task::removal - session::margin);
static_assert(task::removal < task::removal_answer);
static_assert(task::removal_answer + task::unwritten + store::write
              < task::termination);
static_assert(task::removal_answer < task::rollback);
static_assert(retry::longest < task::return_of_nodes);

static_assert(transfer::arrival + task::termination < transfer::place);
static_assert(task::removal_answer + task::deployment_answer < task::restart);
static_assert(task::deployment_answer < transfer::forwarded);
static_assert(task::eviction < transfer::preparing
              && transfer::preparing < transfer::forwarded);

static_assert(task::deployment_answer < request::handler
              && request::handler < request::router);
static_assert(task::restart < request::handler
              && task::eviction < request::handler);
static_assert(local::answer < request::forwarded_query
              && request::handler < request::forwarded);
static_assert(request::member_request < request::router);
static_assert(request::handler < task::claim);
static_assert(transfer::answer < request::handler);

static_assert(log::runtime < log::agent
              && log::agent < log::session - limits::session::margin);
static_assert(log::session < log::coordinator
              && log::coordinator < log::answer);
static_assert(log::wait + log::answer < log::stream);

static_assert(cell::registration_call < token::nonce_lifetime);

static_assert(event::repetitions < event::kept
              && event::refusals < event::kept);

static_assert(history::list <= history::member_list - session::margin);
static_assert(history::member_list < history::cell_list
              && history::cell_list < local::answer);
static_assert(2 * history::batch < event::kept);
static_assert(history::last_batch < membership::stopping);
static_assert(history::disk < local::answer);
static_assert(2 * event::kept < history::numbers);
static_assert(history::least_bytes < history::bytes);

static_assert(discovery::peer_names < local::part);
static_assert(2 * discovery::announcement_period < discovery::lease);

} // namespace roscell::limits
