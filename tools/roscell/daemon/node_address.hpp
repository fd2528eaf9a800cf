#pragma once

#include "actors/edge/host/interfaces.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <chrono>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

namespace roscell::cli {

/// What a node is to do about its address.
enum class address_action {
  stay,
  renew,   ///< Make everything anew, at `successor`.
  give_up, ///< Its one address is gone for good.
};

/// Follows the address of a node that runs. Pure: it is told what addresses
/// there are whenever that changes, and the time.
///
/// - An address that goes and comes back within `tolerated_gap` changes
///   nothing, since no socket has noticed.
/// - One that goes for longer and comes back, another one of the interface
///   instead of it, and the carrier of an interface that had none when the node
///   was made: the node is made anew. What was bound before is unreliable.
/// - Further addresses of the interface, and a carrier that goes, change
///   nothing: the address is still there.
/// - One that was given as an address and is gone for `patience` is given up.
///
/// Nothing is made anew before the address, with a carrier, has been there for
/// `settling` without a break: one that flaps costs one renewal at its end.
/// Only the first carrier of a node that was made without one is not waited
/// for: there is nothing yet that flapping could take from it.
class address_tracker {
public:
  using time_point = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds tolerated_gap{1000};
  /// Longer than one half of a flap each second, with a margin.
  static constexpr std::chrono::milliseconds settling{1500};
  static constexpr std::chrono::seconds patience{10};

  /// `at` is where the node is. With `fixed` it has been given as an address,
  /// and no other one of the interface will do.
  address_tracker(interface_address at, bool fixed);

  /// Hears all addresses of this host.
  void observe(const std::vector<interface_address>& all, time_point now);

  address_action action(time_point now) const;

  /// When `action` may change by itself.
  std::optional<time_point> due() const;

  /// Where the node is to be made anew; empty where nothing is to change.
  const std::string& successor() const {
    return successor_;
  }

private:
  const interface_address*
  find(const std::vector<interface_address>& all) const;
  time_point settled_at() const;

  interface_address at_;
  bool fixed_;
  bool unreliable_; ///< What is bound to the address may be dead.
  std::optional<time_point> gone_since_;
  std::string successor_;
  time_point successor_since_{};
};

/// The kernel's word, over netlink, that an IPv4 address or an interface of
/// this host has come, gone or changed. It says that something has, not what:
/// whoever hears it looks anew, so that nothing is missed where words got lost.
class address_watch {
public:
  /// Throws command_error where there is no such socket.
  address_watch();

  /// Can be read once there is news.
  int fd() const {
    return fd_.get();
  }

  /// Takes the news; the next one makes the descriptor readable again.
  void clear();

private:
  unique_fd fd_;
};

/// What a node is to use: the name of an interface, which may come later, or an
/// address that this host has now. If `wanted` is empty, a terminal is asked;
/// without one, and for what can be neither, command_error lists what there is.
std::string choose_interface(const std::string& wanted);

/// Asks a person to pick one of `all` by its number; asks again after an
/// answer that is none. Throws command_error when the answers end.
interface_address ask_for_interface(const std::vector<interface_address>& all,
                                    std::istream& answers, std::ostream& out);

/// Whether `text` is an address and no name.
bool is_ipv4_address(const std::string& text);

/// All interfaces of this host, those without an address, too.
std::string describe_links(const std::vector<interface_address>& all,
                           const std::vector<host_link>& links);

/// The address that `wanted` has now or, in a sentence without a full stop,
/// what it lacks.
std::variant<interface_address, std::string>
find_interface(const std::string& wanted, bool with_carrier,
               const std::vector<interface_address>& all,
               const std::vector<host_link>& links);

} // namespace roscell::cli
