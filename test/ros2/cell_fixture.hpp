#pragma once

#include "roscell/ros2/std_msgs.hpp"
#include "roscell/skill/registry.hpp"

#include "actors/edge/dds/discovery_server.hpp"

#include "test/skills/support.hpp"

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

/// Skills' ends of topics, in cells on 127.0.0.1 with real discovery servers.
namespace roscell::test {

/// Participants of one process would hand messages to each other without a
/// socket; instances of a cell are processes of their own.
void use_sockets();

/// Lines said, in order; other threads add to it.
class logbook {
public:
  engine::say_function say();

  /// Waits for so many lines with `part`.
  bool wait_for(const std::string& part, std::ptrdiff_t times = 1);

  std::vector<std::string> lines() const;

private:
  mutable std::mutex mutex_;
  std::condition_variable grown_;
  std::vector<std::string> lines_;
};

using variables = std::map<std::string, std::string>;

/// The lookup of `values`, which it keeps.
engine::variable_lookup lookup_in(variables values);

/// A cell with its discovery server, as a coordinator runs it.
class cell {
public:
  explicit cell(std::uint8_t server_id, std::uint32_t domain_id = 0);

  /// What the node of this cell tells an instance.
  variables environment(const std::string& instance) const;

  std::uint16_t port() const {
    return server_->port();
  }

private:
  std::uint8_t server_id_;
  std::uint32_t domain_id_;
  std::unique_ptr<cell_server> server_;
};

/// The ends of topics in one skill: what `engine::run` would make.
class skill {
public:
  explicit skill(const variables& environment);

  std::unique_ptr<engine::input_handler> input(const std::string& topic,
                                               const std::string& type);

  /// An output that is open.
  std::unique_ptr<engine::output_handler> output(const std::string& topic,
                                                 const std::string& type);

  nlohmann::json parameters = nlohmann::json::object();
  logbook log;

private:
  engine::stream_context context(const std::string& topic,
                                 const std::string& type);

  engine::registry parts_;
};

engine::frame frame_of(const std::string& type, std::string payload);

inline constexpr const char* text = ros2::std_msgs::string::type_name;

engine::frame text_frame(const std::string& data);

/// What a frame of text says; "nothing" where there is no frame.
std::string text_of(const std::optional<engine::frame>& x);

/// Two skills of one cell.
struct two_skills {
  explicit two_skills(std::uint32_t domain_id = 0) : home{0, domain_id} {}

  cell home;
  skill reading{home.environment("reader")};
  skill writing{home.environment("writer")};
};

/// A message goes from one new skill of the cell to another.
void check_message(const cell& home);

} // namespace roscell::test
