#pragma once

#include "actors/house/limits.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

/// How a node knows that an order to register elsewhere comes from its site:
/// it hands out a nonce, and takes the order that proves the site token over
/// that nonce and everything the order says.
namespace roscell {

/// What a registration switch says, as far as it must not be altered.
struct registration_order {
  std::string nonce;            ///< From the node, see below.
  std::string node;             ///< The node that shall switch.
  std::string uuid;             ///< Its UUID.
  int64_t epoch = 0;            ///< Its registration epoch, as it announced.
  std::string cell;             ///< The cell to join.
  std::string coordinator;      ///< UUID of whoever gives the order.
  std::string discovery_server; ///< "ip:port" of the cell to join.
  std::string address;          ///< "ip:port" where it takes sessions.
  std::string transfer;         ///< Id of the transfer; may be empty.
};

/// HMAC-SHA256 under the site token over all of `order`: 64 hexadecimal digits.
/// Under an empty token anybody can make it.
std::string prove(const registration_order& order, std::string_view site_token);

/// Whether `proof`, which may be any text, is that. The time taken tells
/// nothing about the token.
bool proves(const registration_order& order, std::string_view site_token,
            std::string_view proof);

/// What a node says when it is asked where it stands.
struct standing_claim {
  std::string nonce; ///< From whoever asks.
  std::string node;
  std::string uuid;
  int64_t epoch = 0;
  std::string state;
};

/// The same for a claim.
std::string prove(const standing_claim& claim, std::string_view site_token);
bool proves(const standing_claim& claim, std::string_view site_token,
            std::string_view proof);

/// The nonces that a node has handed out. Strangers may ask for them, so there
/// are few.
class registration_challenges {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// A fresh nonce, 32 random bytes in hexadecimal digits. When there are
  /// `limits::token::outstanding_nonces` already, the oldest is worth nothing
  /// any more.
  std::string issue(time_point now);

  /// Whether `nonce` was issued less than `limits::token::nonce_lifetime` ago
  /// and not redeemed yet.
  bool redeem(std::string_view nonce, time_point now);

private:
  struct challenge {
    std::string nonce;
    time_point end;
  };

  std::deque<challenge> outstanding_; ///< The oldest first.
};

} // namespace roscell
