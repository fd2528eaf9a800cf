#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

/// INTERNAL to this folder.
namespace roscell {

/// The one thread that hears for all DDS participants of this process, and on
/// which they say again what others may have missed. Left to itself Fast DDS
/// takes a thread, with a buffer of its own, for each socket.
///
/// What it calls holds up everything else that it is there for, so it must not
/// wait. All methods may be called from any thread, and by what it calls.
class dds_thread : public std::enable_shared_from_this<dds_thread> {
public:
  using clock = std::chrono::steady_clock;

  /// Gets a datagram, which it may change, and who has sent it.
  using on_datagram = std::function<void(std::uint8_t* bytes, std::size_t size,
                                         const sockaddr_in& from)>;

  /// Something that the thread looks after until this is destroyed, which waits
  /// for a call that has begun.
  class entry {
  public:
    entry(std::shared_ptr<dds_thread> owner, std::uint64_t key);
    ~entry();

    entry(const entry&) = delete;
    entry& operator=(const entry&) = delete;

    /// A timer's: it is called once, at this time, and not at one that was
    /// asked for before.
    void call_at(clock::time_point due);

  private:
    const std::shared_ptr<dds_thread> owner_;
    const std::uint64_t key_;
  };

  /// The one of this process. It ends with the last who holds it or an entry;
  /// that must not be something that it calls.
  static std::shared_ptr<dds_thread> shared();

  dds_thread();
  ~dds_thread();

  dds_thread(const dds_thread&) = delete;
  dds_thread& operator=(const dds_thread&) = delete;

  /// Calls `hear` with each datagram of at most `max_bytes`. Null where the
  /// kernel refuses.
  std::unique_ptr<entry> listen(udp_socket socket, std::size_t max_bytes,
                                on_datagram hear);

  /// Calls `ring` when `call_at` has asked for it.
  std::unique_ptr<entry> make_timer(std::function<void()> ring);

private:
  struct item {
    std::optional<udp_socket> socket; // None: a timer.
    std::size_t max_bytes = 0;
    on_datagram hear;
    std::function<void()> ring;
    std::optional<clock::time_point> due;
  };

  /// Unless this process had too many open files at its beginning.
  bool works() const;

  std::uint64_t add(std::shared_ptr<item> x);
  void remove(std::uint64_t key);
  void call_at(std::uint64_t key, clock::time_point due);

  /// Wakes the thread when the next timer is due. Under the lock.
  void arm();
  void wake_at(clock::time_point when);

  void run();

  /// What has come for one socket, but not so much that others must wait.
  void hear(std::uint64_t key);

  /// False: no more has come, or nobody wants to hear of it.
  bool hear_one(std::uint64_t key);

  void ring_due();

  /// Marks an item as being called; null: it is not there any more.
  std::shared_ptr<item> begin(std::uint64_t key);
  void end(std::shared_ptr<item> x);

  const unique_fd epoll_;
  unique_fd timer_;
  const std::unique_ptr<std::uint8_t[]> buffer_; // The thread's own.
  std::mutex mutex_;                             // Guards what follows.
  std::condition_variable ended_; // A call, for those who wait for that.
  bool closing_ = false;
  std::uint64_t last_key_ = 0;
  std::uint64_t called_ = 0; // The item that is being called; 0: none.
  std::map<std::uint64_t, std::shared_ptr<item>> items_;
  std::thread thread_; // Last: it uses all the others.
};

} // namespace roscell
