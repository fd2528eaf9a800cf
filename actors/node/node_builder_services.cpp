#include "actors/node/node_builder.hpp"

#include "actors/builds/build_fetcher.hpp"
#include "actors/builds/build_keeper.hpp"
#include "actors/builds/images/image_exchange.hpp"
#include "actors/builds/images/image_worker.hpp"
#include "actors/builds/source_questions.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/instances/secrets/secret_keeper.hpp"
#include "actors/node/node_runtime.hpp"
#include "actors/node/reach_prober.hpp"
#include "actors/requests/cost/cost_sampler.hpp"
#include "actors/site/audit_log.hpp"
#include "actors/site/node_identity.hpp"
#include "actors/site/site_keeper.hpp"

#include <system_error>
#include <utility>

/// What a node has beside its instances and its cell.
namespace roscell {

/// It works once it knows whom to ask: see `start_watching`.
void node_builder::start_images() {
  if (runtime_.socket.empty())
    return;
  const auto& config = parts_.config;
  const auto cancel = std::make_shared<http_cancel>();
  const engine_door door{runtime_.socket, runtime_.api,
                         runtime_.name == "docker", cancel};
  const auto work_dir = builds_folder(config) / "images";
  // What an earlier run has left half done.
  std::error_code ignored;
  std::filesystem::remove_all(work_dir, ignored);
  image_exchange_config with;
  with.context = parts_.context;
  with.node = config.name;
  with.architecture = own_architecture();
  with.builds = builds_folder(config);
  with.most_bytes = config.builds_bytes;
  with.stop_workers = [cancel] { cancel->cancel(); };
  with.make_worker = [&system = system_, context = parts_.context, door,
                      work_dir](const image_exchange_actor& owner) {
    return spawn_blocking(system, context, image_worker,
                          image_worker_config{door, work_dir}, owner);
  };
  images_ = start(image_exchange, with);
}

/// Before anybody who has an instance started.
void node_builder::start_secrets() {
  const auto& config = parts_.config;
  secret_keeper_config with;
  with.context = parts_.context;
  with.node = config.name;
  with.folder = config.data_dir / "secrets";
  with.places = memory_places();
  with.place_name = place_name_of(config.data_dir);
  with.names = secret_names_;
  for (const auto& row : data_.instances)
    if (auto names = secrets_of(row.spec); is_live(row.state) && !names.empty())
      with.given[row.spec.instance] = std::move(names);
  parts_.services->secrets = start_blocking(secret_keeper, with);
}

/// Before anybody who meets coordinators.
void node_builder::start_site() {
  const auto& config = parts_.config;
  auto& services = *parts_.services;
  site_keeper_config with;
  with.context = parts_.context;
  with.ask = [core = parts_.edges->io->core()](
                 http_call call, std::function<void(http_outcome)> on_end) {
    call_http(core, std::move(call), std::move(on_end));
  };
  with.node = config.name;
  with.uuid = parts_.identity.uuid;
  with.coordinator = config.coordinator;
  with.identity = data_.site.identity();
  with.file = identity_file_of(config);
  with.addresses = {parts_.edges->http_address};
  with.known = parts_.edges->known;
  for (const auto& x : data_.members)
    with.known->add(x.identity.name, x.identity.uuid);
  with.start_anew = additions_.start_anew;
  services.has_identity = with.identity != nullptr;
  services.site = start_blocking(site_keeper, with);
  services.audit =
      start_blocking(audit_log, parts_.context, config.data_dir / "audit");
}

void node_builder::start_builds() {
  const auto& config = parts_.config;
  build_keeper_config keeping;
  keeping.context = parts_.context;
  keeping.folder = builds_folder(config);
  keeping.most_bytes = config.builds_bytes;
  keeping.supervisor = parts_.services->supervisor;
  keeping.architecture = own_architecture();
  parts_.services->keeper = start_blocking(build_keeper, keeping);
  build_fetcher_config fetching;
  fetching.context = parts_.context;
  fetching.node = config.name;
  fetching.keeper = parts_.services->keeper;
  fetching.ask = source_asker(parts_.edges->io->core(), config.address,
                              data_.site.identity());
  fetcher_ = start(build_fetcher, fetching);
}

void node_builder::start_measuring() {
  auto& costs = parts_.services->costs;
  costs = std::make_shared<cost_meter>(
      [table = parts_.context.metrics] { return read_cost(table); });
  start(cost_sampler, costs);
}

void node_builder::start_prober() {
  const auto& config = parts_.config;
  reach_prober_config with;
  with.io = parts_.edges->io.get();
  with.node = config.name;
  with.address = config.address;
  with.http_address = parts_.edges->http_address;
  with.discovery_server = parts_.edges->discovery_server;
  with.membership = parts_.services->membership;
  with.domain_id = config.ros_domain_id;
  with.site = data_.site;
  parts_.services->prober = start(reach_prober, with);
}

void node_builder::start_execs() {
  exec_host_config with;
  with.context = parts_.context;
  with.node = parts_.config.name;
  with.supervisor = parts_.services->supervisor;
  with.open = make_exec_opener(parts_.config, runtime_, *parts_.edges->io);
  parts_.services->execs = start_blocking(exec_host, with);
}

} // namespace roscell
