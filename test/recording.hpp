#pragma once

#include "test/places.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

/// What nodes of commit 7566a8a have said to each other; written by
/// tools/testing/record_sessions.sh.
namespace roscell::test {

struct recorded_frame {
  bool of_joiner = false; ///< Else of who has accepted the session.
  std::string text;
};

/// One session: the four frames of its handshake, and all that follow.
struct recorded_session {
  std::string joiner; ///< "ip:port"
  std::string acceptor;
  std::vector<recorded_frame> frames;

  nlohmann::json frame(size_t i) const {
    return nlohmann::json::parse(frames.at(i).text);
  }

  /// The joiner coordinates another cell.
  bool is_of_peers() const {
    return frame(0).contains("role");
  }
};

struct recorded_heartbeat {
  std::string from; ///< "ip"
  std::string bytes;
};

struct recording {
  std::string site_token;
  std::vector<recorded_session> sessions; ///< In the order of their hellos.
  std::vector<recorded_heartbeat> heartbeats;
};

inline constexpr size_t handshake_frames = 4;

namespace recording_steps {

inline void add_frame(recording& to, const nlohmann::json& line) {
  const auto from = line.at("from").get<std::string>();
  const auto whom = line.at("to").get<std::string>();
  auto& all = to.sessions;
  const auto same = std::find_if(all.rbegin(), all.rend(), [&](const auto& x) {
    return (x.joiner == from && x.acceptor == whom)
           || (x.joiner == whom && x.acceptor == from);
  });
  auto& session = same != all.rend()
                      ? *same
                      : all.emplace_back(recorded_session{from, whom});
  session.frames.push_back(
      {session.joiner == from, line.at("text").get<std::string>()});
}

inline void add_heartbeat(recording& to, const nlohmann::json& line) {
  const auto from = line.at("from").get<std::string>();
  const auto digits = line.at("beat").get<std::string>();
  recorded_heartbeat result{from.substr(0, from.find(':')), {}};
  for (size_t i = 0; i + 1 < digits.size(); i += 2)
    result.bytes += static_cast<char>(std::stoi(digits.substr(i, 2), {}, 16));
  to.heartbeats.push_back(std::move(result));
}

} // namespace recording_steps

inline recording read_recording() {
  const auto path = source_dir() / "test/data/version_7566a8a/sessions.jsonl";
  std::ifstream file{path};
  recording result;
  for (std::string text; std::getline(file, text);) {
    const auto line = nlohmann::json::parse(text);
    if (line.contains("site_token"))
      result.site_token = line["site_token"];
    else if (line.contains("beat"))
      recording_steps::add_heartbeat(result, line);
    else
      recording_steps::add_frame(result, line);
  }
  if (result.sessions.empty())
    throw std::runtime_error{path.string() + " has no session"};
  return result;
}

} // namespace roscell::test
