#pragma once

#include "actors/edge/dds/lives/number_reserve.hpp"
#include "actors/edge/dds/lives/participant_table.hpp"
#include "actors/edge/dds/lives/server_lives.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"
#include "actors/edge/dds/rtps/probe_responder.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// What stands between a discovery server of Fast DDS and the wire, so that
/// whatever ends and begins again is a new one to those who knew it: the lives
/// of other servers, the numbers of the own one, the table of those who are
/// known, and the answers to those who only ask who is there. May be used by
/// several threads.
class discovery_guard {
public:
  /// Gives Fast DDS a message as if it had come.
  using inlet = std::function<void(const std::vector<std::uint8_t>&)>;

  /// Answers leave by the socket.
  discovery_guard(std::uint8_t own_id, std::shared_ptr<number_reserve> numbers,
                  udp_socket socket);

  server_lives& lives() {
    return lives_;
  }

  /// From now on those who ask are answered with this.
  void speak(const std::string& announcement);

  /// Prepares a safe message that has come from there; false: Fast DDS must not
  /// see it.
  bool take_in(std::uint8_t* message, std::size_t size,
               const sockaddr_in& from);

  /// What Fast DDS is to see right after a message that it has seen; empty:
  /// nothing. Who gets to know another server asks each of its writers every
  /// 70 ms for a HEARTBEAT until one comes (`WriterProxy` of Fast DDS 2.9.1),
  /// and where a whole cell joins at one moment that is most of the work.
  std::vector<std::uint8_t> sequel_of(std::uint8_t* message, std::size_t size);

  /// Prepares a message that shall go; false: nobody may see it.
  bool let_out(std::uint8_t* message, std::size_t size);

  /// From now on; empty: the server ends.
  void set_inlet(inlet x);

  /// Fast DDS knows a participant.
  void appeared(const guid_prefix& who);

  /// Fast DDS does not know it any more.
  void gone(const guid_prefix& who);

  /// The present life of another server has ended: Fast DDS forgets it, and
  /// what it has told of comes into doubt.
  void lose(std::uint8_t id);

  /// Fast DDS forgets what server `id` has told of and is in doubt.
  void end_doubt(std::uint8_t id);

  /// Fast DDS forgets server `id` and all that it has told of.
  void forget(std::uint8_t id);

private:
  /// Returns what the numbers of the sender are to be raised by.
  std::int64_t note(const guid_prefix& from,
                    const std::vector<participant_news>& news);
  bool is_introduced_too_often(std::uint8_t* message, std::size_t size);
  std::vector<guid_prefix> end_life(std::uint8_t id);
  void bury(const std::vector<guid_prefix>& dead);

  const guid_prefix own_;
  probe_responder probes_;
  server_lives lives_;
  const number_shift numbers_;
  std::mutex table_mutex_;
  participant_table table_;
  speaker_lives speakers_;
  introduction_pacing pacing_;
  std::mutex inlet_mutex_;
  inlet inlet_;
};

} // namespace roscell
