#pragma once

#include "actors/instances/skills/skill_catalogue.hpp"
#include "test/fixture.hpp"
#include "test/temp_folder.hpp"

#include <caf/typed_event_based_actor.hpp>
#include <caf/typed_response_promise.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// What the actors of supervision talk to, as far as their tests need it.
namespace roscell::test {

/// The descriptor of a skill with model "plain" and deployment "cpu".
std::string echo_descriptor();

/// A catalogue with that one skill, and its hash.
struct echo_catalogue {
  echo_catalogue();

  temp_folder folder;
  shared_skill_catalogue skills;
  std::string hash;
};

instance_spec echo_spec(const std::string& hash, const std::string& instance,
                        const std::string& task = "t");

/// What a fake runtime shall do, and what it was asked.
struct runtime_script {
  caf::error prepare_error;
  caf::error start_error;
  caf::error stop_error;
  caf::error remove_error;
  caf::error adopt_error;
  bool silent =
      false; ///< Starts, but does not answer until `answer` is called.
  bool stops_never = false;
  bool deaf = false;       ///< Does not answer when told to hear an instance.
  instance_notified words; ///< What waits at the socket of an instance.
  container_adopted adoption;
  int stop_code = 143;
  std::string log = "first line\nlast line\n";
  caf::error log_error;

  std::vector<prepare_image> prepared;
  std::vector<start_container> started;
  std::vector<stop_container> stopped;
  std::vector<remove_container> removed;
  std::vector<adopt_container> adopted;
  std::vector<log_query> queries;
  std::vector<hear_container> heard;
  std::vector<fence_container> fenced;
  std::vector<ask_for_safety> asked_for_safety;
  std::vector<caf::typed_response_promise<container_started>> unanswered;
  std::function<void()> answer; ///< Makes it give the answers it has held back.
  caf::actor instance; ///< Who has asked for an image or an adoption last.

  /// Id of the container that the last start has made.
  std::string container() const {
    return "c" + std::to_string(started.size());
  }
};

runtime_actor fake_runtime(caf::actor_system& system,
                           std::shared_ptr<runtime_script> script);

/// Records by "table/key"; an empty value is a removal.
struct store_script {
  caf::error error;
  std::vector<store_record> records;

  /// States of an instance in the order they were written; "-" for its removal.
  std::vector<std::string> states(const std::string& instance) const;
};

state_store_actor fake_store(caf::actor_system& system,
                             std::shared_ptr<store_script> script);

/// Keeps what it is told of instances.
struct reported_changes {
  std::vector<instance_row> rows;

  std::vector<std::string> states() const;
  const instance_row& last() const {
    return rows.at(rows.size() - 1);
  }
};

/// A supervisor of which only the ears are real.
container_supervisor_actor
fake_supervisor(caf::actor_system& system,
                std::shared_ptr<reported_changes> reported);

instance_listener_actor
fake_listener(caf::actor_system& system,
              std::shared_ptr<reported_changes> reported);

} // namespace roscell::test
