#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>

namespace roscell {

/// INTERNAL to this folder: who of those who connect may shake hands now. Few
/// at a time, and fewer of one address, so that one who begins many takes no
/// place of others; who waits is served in turn. Pure.
class handshake_queue {
public:
  using ticket = uint64_t;

  handshake_queue(size_t places, size_t places_of_one)
      : places_(places), places_of_one_(places_of_one) {
    // nop
  }

  /// Calls `begin` at once, or when there is a place.
  ticket enter(std::string address, std::function<void()> begin);

  /// Whoever it is has done with it, or gone; both may be said again.
  void leave(ticket whose);

  size_t begun() const noexcept {
    return begun_.size();
  }

private:
  struct candidate {
    ticket number;
    std::string address;
    std::function<void()> begin;
  };

  bool has_place(const std::string& address) const;
  void serve();

  const size_t places_;
  const size_t places_of_one_;
  ticket last_ = 0;
  std::map<ticket, std::string> begun_; ///< And from where.
  std::map<std::string, size_t> of_;    ///< How many have begun from there.
  std::deque<candidate> waiting_;
};

} // namespace roscell
