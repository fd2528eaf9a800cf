#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

/// Real folders and processes for the edges of supervision.
namespace roscell::test {

/// The value, or a failed test that says why there is none.
template <class T>
T value_of(edge_result<T> result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    FAIL(why->message);
  return std::move(std::get<T>(result));
}

template <class T>
edge_error error_of(const edge_result<T>& result) {
  REQUIRE(std::holds_alternative<edge_error>(result));
  return std::get<edge_error>(result);
}

/// Sends one datagram as a skill does. Returns whether it was taken.
inline bool send_notification(const std::filesystem::path& path,
                              const std::string& text) {
  const unique_fd fd{::socket(AF_UNIX, SOCK_DGRAM, 0)};
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.native().copy(address.sun_path, sizeof(address.sun_path) - 1);
  return ::sendto(fd.get(), text.data(), text.size(), MSG_DONTWAIT,
                  reinterpret_cast<const sockaddr*>(&address), sizeof(address))
         == static_cast<ssize_t>(text.size());
}

} // namespace roscell::test
