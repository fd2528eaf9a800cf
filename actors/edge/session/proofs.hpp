#pragma once

#include "actors/edge/io/crypto.hpp"

#include <chrono>
#include <cstdint>
#include <map>
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
std::string prove(const registration_order& order, std::string_view site_token);

/// Whether `proof`, which may be any text, is that; under an empty token
/// nothing is. The time taken tells nothing about the token.
bool proves(const registration_order& order, std::string_view site_token,
            std::string_view proof);

/// What somebody says who asks a node where it stands.
struct status_question {
  std::string nonce; ///< His own.
};

/// The same for a question.
std::string prove(const status_question& question, std::string_view site_token);
bool proves(const status_question& question, std::string_view site_token,
            std::string_view proof);

/// What a node says when it is asked where it stands.
struct status_claim {
  std::string nonce; ///< From whoever asks.
  std::string node;
  std::string uuid;
  int64_t epoch = 0;
  std::string state;
};

/// The same for a claim.
std::string prove(const status_claim& claim, std::string_view site_token);
bool proves(const status_claim& claim, std::string_view site_token,
            std::string_view proof);

/// The nonces that a node hands out. Unauthenticated peers may ask for as many
/// as they like: none is remembered, since each says when it was made and
/// proves that this node made it. Only those that have proven a switch are, so
/// that each is good for one.
class registration_challenges {
public:
  using time_point = std::chrono::steady_clock::time_point;

  registration_challenges();

  /// A fresh nonce: 64 hexadecimal digits.
  std::string issue(time_point now) const;

  /// Whether `nonce` was issued here less than `limits::token::nonce_lifetime`
  /// ago and was not spent yet.
  bool is_fresh(const std::string& nonce, time_point now);

  /// Makes a nonce worthless that has proven something.
  void spend(const std::string& nonce, time_point now);

private:
  std::string seal(std::string_view made) const;
  void forget_old(time_point now);

  std::string key_;
  std::map<std::string, time_point> spent_; ///< And when it would have ended.
};

// INTERNAL to this folder.

/// What a proof is about: a label that says what kind of proof it is, and a
/// list of texts. Each has its length before it, so that no two lists have the
/// same bytes.
class transcript {
public:
  explicit transcript(std::string_view label);

  transcript& add(std::string_view text);
  transcript& add(int64_t number);

  /// HMAC-SHA256 under `key`.
  digest sign(std::string_view key) const;

private:
  std::string bytes_;
};

/// Whether `proof` is `expected` in hexadecimal digits. The time taken tells
/// nothing about `expected`.
bool is_proof(std::string_view proof, const digest& expected);

} // namespace roscell
