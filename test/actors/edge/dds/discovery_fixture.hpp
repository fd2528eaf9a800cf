#pragma once

#include "actors/edge/dds/discovery_server.hpp"
#include "actors/edge/dds/discovery_setup.hpp"
#include "actors/edge/dds/server_inquiry.hpp"

#include <catch2/catch.hpp>

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

/// Real participants of one process on 127.0.0.1.
namespace roscell::test {

/// What happened, in order; other threads add to it.
class diary {
public:
  void add(std::string entry) {
    std::lock_guard<std::mutex> lock{mutex_};
    entries_.push_back(std::move(entry));
    changed_.notify_all();
  }

  /// True once there are `count` entries equal to `entry`.
  bool wait_for(const std::string& entry, std::size_t count = 1) {
    std::unique_lock<std::mutex> lock{mutex_};
    return changed_.wait_for(lock, std::chrono::seconds{20},
                             [&] { return count_nts(entry) >= count; });
  }

  std::vector<std::string> entries() const {
    std::lock_guard<std::mutex> lock{mutex_};
    return entries_;
  }

private:
  std::size_t count_nts(const std::string& entry) const {
    std::size_t result = 0;
    for (auto& x : entries_)
      result += x == entry ? 1 : 0;
    return result;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> entries_;
};

inline on_server_found writing_to(diary& to) {
  return [&to](const server_sighting& seen) {
    to.add(std::to_string(seen.server_id) + ' ' + seen.announcement);
  };
}

inline cell_server_options local_server(std::uint8_t id, std::string says) {
  prepare_dds_environment();
  cell_server_options result;
  result.address = "127.0.0.1";
  result.port = 0;
  result.server_id = id;
  result.announcement = std::move(says);
  return result;
}

inline std::unique_ptr<cell_server> must_open(const cell_server_options& x,
                                              on_sighting on_client = {}) {
  auto result = cell_server::open(x, std::move(on_client));
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<0>(std::move(result));
}

inline std::unique_ptr<server_inquiry>
must_open(const server_inquiry_options& x, on_server_found callback) {
  auto result = server_inquiry::open(x, std::move(callback));
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<0>(std::move(result));
}

inline server_inquiry_options asking(std::uint16_t port) {
  server_inquiry_options result;
  result.server_address = "127.0.0.1";
  result.server_port = port;
  return result;
}

template <class T>
edge_error error_of(const edge_result<T>& x) {
  REQUIRE(std::holds_alternative<edge_error>(x));
  return std::get<edge_error>(x);
}

} // namespace roscell::test
