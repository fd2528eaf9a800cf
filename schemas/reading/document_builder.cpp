#include "schemas/reading/document_builder.hpp"

#include "schemas/text_excerpt.hpp"

#include <utility>

namespace roscell {

document_builder::document_builder(const document_limits& limits)
    : limits_(limits) {
  // nop
}

bool document_builder::scalar(json value, text_span at) {
  return add(std::move(value), at);
}

bool document_builder::open(json empty, text_span at) {
  if (open_.size() == limits_.max_depth)
    return refuse(at, "arrays and objects are nested too deep; at most "
                          + std::to_string(limits_.max_depth)
                          + " levels are taken");
  if (!add(std::move(empty), at))
    return false;
  open_.push_back({last_added_, {}});
  return true;
}

bool document_builder::key(std::string name, text_span at) {
  if (name.size() > limits_.max_name_bytes)
    return refuse(at, "the member's name " + in_quotes(name) + " has "
                          + std::to_string(name.size()) + " bytes; at most "
                          + std::to_string(limits_.max_name_bytes)
                          + " are taken");
  auto& top = open_.back();
  top.name = std::move(name);
  if (top.container->contains(top.name))
    return refuse(at, "the name " + in_quotes(top.name)
                          + " stands twice in one object; expected it once");
  return true;
}

void document_builder::close() {
  open_.pop_back();
}

void document_builder::fail(text_problem problem) {
  problem_ = std::move(problem);
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

bool document_builder::refuse(const text_span& at, std::string words) {
  problem_ = {at.begin, std::move(words)};
  return false;
}

bool document_builder::add(json value, const text_span& at) {
  if (++values_ > limits_.max_values)
    return refuse(at, "the document has too many values; at most "
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
