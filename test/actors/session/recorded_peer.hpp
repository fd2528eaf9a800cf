#pragma once

#include "test/actors/fakes/cell_fakes.hpp"
#include "test/recording.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace roscell::test {

/// A session one of whose ends is played as it was recorded, against an actor
/// of this version at the other one.
struct recorded_peer : cell_fixture {
  caf::actor peer;                     ///< Hears what this version says.
  std::vector<session_envelope> heard; ///< Of it, all.
  std::set<std::string> answered;      ///< Types of what has been answered.

  recorded_peer() {
    peer = time.system.spawn([this](caf::event_based_actor*) -> caf::behavior {
      return {
          [this](const frame_received& x) {
            heard.push_back(*read_envelope(x.text));
          },
          [](const heartbeat_received&) {},
          [](const session_closed&) {},
      };
    });
  }

  ~recorded_peer() {
    time.kill(peer);
  }

  /// Calls `use(frame, envelope)` with each frame behind the handshake.
  template <class F>
  static void with_each_frame(const recorded_session& recorded, F use) {
    for (auto i = handshake_frames; i < recorded.frames.size(); ++i) {
      const auto& frame = recorded.frames[i];
      const auto envelope = *read_envelope(frame.text);
      INFO(frame.text);
      REQUIRE_FALSE(envelope.refused);
      use(frame, envelope);
    }
  }

  /// The reply of this version to what was asked with that id.
  json reply_to(uint64_t id) const {
    const auto same =
        std::find_if(heard.begin(), heard.end(), [id](const auto& x) {
          return x.kind == envelope_kind::reply && x.id == id;
        });
    REQUIRE(same != heard.end());
    return same->body;
  }
};

} // namespace roscell::test
