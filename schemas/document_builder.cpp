#include "schemas/document_builder.hpp"

#include "schemas/text_excerpt.hpp"

#include <utility>

namespace roscell {

namespace {

/// nlohmann's number for "this number overflows a double".
constexpr int number_overflow = 406;

/// The bare words of the parser's message, such as "unexpected end of input;
/// expected string literal". The token that it quotes in between is left out:
/// it may be as long as the document, and need not be UTF-8.
std::string syntax_words(std::string text, const std::string& token) {
  if (auto dash = text.find(" - "); dash != std::string::npos)
    text.erase(0, dash + 3);
  const auto last_read = "; last read: '" + token + "'";
  if (auto i = text.find(last_read); i != std::string::npos)
    text.erase(i, last_read.size());
  return text;
}

} // namespace

document_builder::document_builder(const document_limits& limits,
                                   const size_t& bytes_read)
    : limits_(limits), bytes_read_(bytes_read) {
  // nop
}

bool document_builder::null() {
  return add(nullptr);
}

bool document_builder::boolean(bool value) {
  return add(value);
}

bool document_builder::number_integer(json::number_integer_t value) {
  return add(value);
}

bool document_builder::number_unsigned(json::number_unsigned_t value) {
  return add(value);
}

bool document_builder::number_float(json::number_float_t value,
                                    const std::string&) {
  return add(value);
}

bool document_builder::string(std::string& value) {
  return add(std::move(value));
}

bool document_builder::binary(json::binary_t&) {
  return refuse("binary values are no JSON");
}

bool document_builder::start_object(size_t) {
  return open(json::object());
}

bool document_builder::start_array(size_t) {
  return open(json::array());
}

bool document_builder::end_object() {
  return close();
}

bool document_builder::end_array() {
  return close();
}

bool document_builder::key(std::string& name) {
  if (name.size() > limits_.max_name_bytes)
    return refuse("the member's name " + in_quotes(name) + " has "
                  + std::to_string(name.size()) + " bytes; at most "
                  + std::to_string(limits_.max_name_bytes) + " are taken");
  auto& top = open_.back();
  top.name = std::move(name);
  if (top.container->contains(top.name))
    return refuse("the name " + in_quotes(top.name)
                  + " stands twice in one object; expected it once");
  return true;
}

bool document_builder::parse_error(size_t position, const std::string& token,
                                   const json::exception& error) {
  if (error.id == number_overflow)
    return refuse("the number is too large for a 64-bit floating-point number");
  refuse(syntax_words(error.what(), token));
  problem_offset_ = position == 0 ? 0 : position - 1;
  return false;
}

std::string document_builder::where() const {
  json::json_pointer result;
  for (const auto& [container, name] : open_) {
    // An array already holds what is open in it, but not what comes next.
    auto next = container == open_.back().container ? 0 : 1;
    if (container->is_object())
      result.push_back(name);
    else
      result.push_back(std::to_string(container->size() - next));
  }
  return result.to_string();
}

bool document_builder::refuse(std::string problem) {
  problem_ = std::move(problem);
  problem_offset_ = bytes_read_ == 0 ? 0 : bytes_read_ - 1;
  return false;
}

bool document_builder::open(json empty) {
  if (open_.size() == limits_.max_depth)
    return refuse("arrays and objects are nested too deep; at most "
                  + std::to_string(limits_.max_depth) + " levels are taken");
  if (!add(std::move(empty)))
    return false;
  open_.push_back({last_added_, {}});
  return true;
}

bool document_builder::close() {
  open_.pop_back();
  return true;
}

bool document_builder::add(json value) {
  if (++values_ > limits_.max_values)
    return refuse("the document has too many values; at most "
                  + std::to_string(limits_.max_values) + " are taken");
  if (open_.empty()) {
    root_ = std::move(value);
    last_added_ = &root_;
    return true;
  }
  auto& [container, name] = open_.back();
  if (container->is_array())
    last_added_ = &container->emplace_back(std::move(value));
  else
    last_added_ = &*container->emplace(name, std::move(value)).first;
  return true;
}

} // namespace roscell
