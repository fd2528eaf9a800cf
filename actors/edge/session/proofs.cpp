#include "actors/edge/session/proofs.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/session/limits.hpp"

#include <cstring>
#include <iterator>

namespace roscell {

namespace {

constexpr std::string_view label = "roscell registration v1";

digest sign(const registration_order& order, std::string_view site_token) {
  return transcript{label}
      .add(order.nonce)
      .add(order.node)
      .add(order.uuid)
      .add(order.epoch)
      .add(order.cell)
      .add(order.coordinator)
      .add(order.discovery_server)
      .add(order.address)
      .add(order.transfer)
      .sign(site_token);
}

constexpr std::string_view question_label = "roscell registration question v1";

digest sign(const status_question& question, std::string_view site_token) {
  return transcript{question_label}.add(question.nonce).sign(site_token);
}

constexpr std::string_view status_label = "roscell standing v1";

digest sign(const status_claim& claim, std::string_view site_token) {
  return transcript{status_label}
      .add(claim.nonce)
      .add(claim.node)
      .add(claim.uuid)
      .add(claim.epoch)
      .add(claim.state)
      .sign(site_token);
}

/// Everybody can sign under an empty token.
template <class Said>
bool is_signed(const Said& said, std::string_view site_token,
               std::string_view proof) {
  return !site_token.empty() && is_proof(proof, sign(said, site_token));
}

constexpr size_t nonce_digits = 64;

using time_point = registration_challenges::time_point;

/// The time in eight bytes, which only this process reads again.
std::string time_bytes(time_point when) {
  const int64_t count = when.time_since_epoch().count();
  return {reinterpret_cast<const char*>(&count), sizeof count};
}

/// When a nonce of which `made` is the first half was made; the seal must have
/// been checked.
time_point made_at(const std::string& made) {
  int64_t count = 0;
  const auto bytes = from_hex(made.substr(0, 2 * sizeof count));
  std::memcpy(&count, bytes->data(), sizeof count);
  return time_point{time_point::duration{count}};
}

} // namespace

std::string prove(const registration_order& order,
                  std::string_view site_token) {
  return to_hex(sign(order, site_token));
}

bool proves(const registration_order& order, std::string_view site_token,
            std::string_view proof) {
  return is_signed(order, site_token, proof);
}

std::string prove(const status_question& question,
                  std::string_view site_token) {
  return to_hex(sign(question, site_token));
}

bool proves(const status_question& question, std::string_view site_token,
            std::string_view proof) {
  return is_signed(question, site_token, proof);
}

std::string prove(const status_claim& claim, std::string_view site_token) {
  return to_hex(sign(claim, site_token));
}

bool proves(const status_claim& claim, std::string_view site_token,
            std::string_view proof) {
  return is_signed(claim, site_token, proof);
}

registration_challenges::registration_challenges() : key_(random_bytes(32)) {
  // nop
}

std::string registration_challenges::issue(time_point now) const {
  const auto made = to_hex(time_bytes(now) + random_bytes(8));
  return made + seal(made);
}

bool registration_challenges::is_fresh(const std::string& nonce,
                                       time_point now) {
  forget_old(now);
  if (nonce.size() != nonce_digits || spent_.count(nonce) > 0
      || spent_.size() >= limits::token::spent_nonces)
    return false;
  const auto made = nonce.substr(0, nonce_digits / 2);
  return equal_in_constant_time(nonce.substr(nonce_digits / 2), seal(made))
         && now < made_at(made) + limits::token::nonce_lifetime;
}

void registration_challenges::spend(const std::string& nonce, time_point now) {
  spent_.emplace(nonce, now + limits::token::nonce_lifetime);
}

void registration_challenges::forget_old(time_point now) {
  for (auto i = spent_.begin(); i != spent_.end();)
    i = i->second <= now ? spent_.erase(i) : std::next(i);
}

std::string registration_challenges::seal(std::string_view made) const {
  return to_hex(hmac_sha256(key_, made)).substr(0, nonce_digits / 2);
}

transcript::transcript(std::string_view label) {
  add(label);
}

transcript& transcript::add(std::string_view text) {
  for (const int shift : {24, 16, 8, 0})
    bytes_ += static_cast<char>((text.size() >> shift) & 0xff);
  bytes_ += text;
  return *this;
}

transcript& transcript::add(int64_t number) {
  return add(std::string_view{std::to_string(number)});
}

digest transcript::sign(std::string_view key) const {
  return hmac_sha256(key, bytes_);
}

bool is_proof(std::string_view proof, const digest& expected) {
  const auto bytes = from_hex(proof);
  return bytes && equal_in_constant_time(*bytes, as_bytes(expected));
}

} // namespace roscell
