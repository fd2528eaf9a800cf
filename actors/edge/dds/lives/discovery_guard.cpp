#include "actors/edge/dds/lives/discovery_guard.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <chrono>
#include <utility>

#include <arpa/inet.h>

namespace roscell {

namespace {

/// Where nobody listens: who tells of the dead wants no answer.
sockaddr_in nowhere() {
  constexpr std::uint16_t discard_port = 9;
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(discard_port);
  result.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return result;
}

} // namespace

discovery_guard::discovery_guard(std::uint8_t own_id,
                                 std::shared_ptr<number_reserve> numbers,
                                 udp_socket socket)
    : own_(server_prefix(own_id)), probes_(std::move(socket)), lives_(own_id),
      numbers_(own_, std::move(numbers)) {}

void discovery_guard::speak(const std::string& announcement) {
  probes_.speak_for(own_, announcement);
}

bool discovery_guard::take_in(std::uint8_t* message, std::size_t size,
                              const sockaddr_in& from) {
  if (probes_.take(message, size, from))
    return false;
  if (!lives_.take_in(message, size, std::chrono::steady_clock::now()))
    return false;
  numbers_.take_in(message, size);
  const auto news = participants_in(message, size);
  if (news.empty())
    return true;
  if (const auto by = note(sender_of(message), news); by != 0)
    raise_own_news(message, size, by);
  return true;
}

std::vector<std::uint8_t> discovery_guard::sequel_of(std::uint8_t* message,
                                                     std::size_t size) {
  const auto from = sender_of(message);
  if (!lives_.is_another_server(from) || !introduces_itself(message, size))
    return {};
  return first_heartbeats(from);
}

/// Who has told of a participant in its last life is not told of it in this
/// one: Fast DDS would take that for a sign that it need not tell of it anew.
bool discovery_guard::let_out(std::uint8_t* message, std::size_t size) {
  leave_out(message, size, [this](const auto& to, const auto& who) {
    std::lock_guard<std::mutex> lock{table_mutex_};
    return lives_.is_another_server(to)
           && table_.was_reported_by(server_lives::id_of(to), who);
  });
  if (!lives_.let_out(message, size))
    return false;
  // Behind that, since what went to a life that has ended was not said.
  if (is_introduced_too_often(message, size))
    return false;
  numbers_.let_out(message, size);
  return true;
}

bool discovery_guard::is_introduced_too_often(std::uint8_t* message,
                                              std::size_t size) {
  const auto to = introduced_to(message, size);
  if (!to || !lives_.is_another_server(*to))
    return false;
  std::lock_guard<std::mutex> lock{table_mutex_};
  return !pacing_.ask(server_lives::id_of(*to),
                      std::chrono::steady_clock::now());
}

void discovery_guard::set_inlet(inlet x) {
  std::lock_guard<std::mutex> lock{inlet_mutex_};
  inlet_ = std::move(x);
}

void discovery_guard::appeared(const guid_prefix& who) {
  std::lock_guard<std::mutex> lock{table_mutex_};
  table_.appeared(who);
}

void discovery_guard::gone(const guid_prefix& who) {
  std::lock_guard<std::mutex> lock{table_mutex_};
  table_.gone(who);
  if (lives_.is_another_server(who))
    pacing_.forget(server_lives::id_of(who));
}

std::int64_t discovery_guard::note(const guid_prefix& from,
                                   const std::vector<participant_news>& news) {
  std::lock_guard<std::mutex> lock{table_mutex_};
  const bool is_server = lives_.is_another_server(from);
  std::int64_t raised_by = 0;
  for (const auto& x : news) {
    if (x.ended)
      continue;
    if (x.who != from) {
      if (is_server)
        table_.reported_by(server_lives::id_of(from), x.who);
      continue;
    }
    table_.reported_itself(from);
    // Each life of a server is another participant already.
    if (!is_server)
      raised_by = speakers_.hear(from, std::chrono::steady_clock::now());
  }
  return raised_by;
}

void discovery_guard::lose(std::uint8_t id) {
  {
    std::lock_guard<std::mutex> lock{table_mutex_};
    table_.doubt(id);
  }
  bury(end_life(id));
}

void discovery_guard::end_doubt(std::uint8_t id) {
  std::vector<guid_prefix> dead;
  {
    std::lock_guard<std::mutex> lock{table_mutex_};
    dead = table_.doubted(id);
  }
  bury(dead);
}

void discovery_guard::forget(std::uint8_t id) {
  std::vector<guid_prefix> dead;
  {
    std::lock_guard<std::mutex> lock{table_mutex_};
    dead = table_.reported_by(id);
  }
  const auto server = end_life(id);
  dead.insert(dead.end(), server.begin(), server.end());
  bury(dead);
}

/// Whom Fast DDS may know as this server. It never frees the news that somebody
/// has ended whom it does not know.
std::vector<guid_prefix> discovery_guard::end_life(std::uint8_t id) {
  std::vector<guid_prefix> result;
  if (lives_.has_spoken(id))
    result.push_back(lives_.present(id));
  lives_.lose(id);
  std::lock_guard<std::mutex> lock{table_mutex_};
  pacing_.forget(id);
  return result;
}

/// Fast DDS takes the news that a participant has ended from whoever is known
/// to it, so somebody appears for as long as that takes. With sequence number 0
/// of the sample, whoever comes back after all is newer than the news of its
/// end.
void discovery_guard::bury(const std::vector<guid_prefix>& dead) {
  std::lock_guard<std::mutex> lock{inlet_mutex_};
  if (dead.empty() || !inlet_)
    return;
  const auto bearer = make_probe_prefix();
  inlet_(probe_question(bearer, nowhere()));
  std::uint32_t number = 1; // Of the question.
  for (const auto& who : dead)
    inlet_(death_notice(bearer, ++number, who));
  inlet_(death_notice(bearer, ++number, bearer));
  std::lock_guard<std::mutex> table_lock{table_mutex_};
  for (const auto& who : dead)
    table_.gone(who);
}

} // namespace roscell
