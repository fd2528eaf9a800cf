#include "actors/requests/answer_memory.hpp"

#include "actors/requests/limits.hpp"

#include <algorithm>

namespace roscell {

answer_memory::status answer_memory::look(const std::string& id,
                                          const std::string& body) const {
  const auto known = requests_.find(id);
  if (known == requests_.end())
    return status::unknown;
  if (known->second.body != body)
    return status::taken;
  return known->second.answer.empty() ? status::begun : status::answered;
}

const std::string& answer_memory::answer(const std::string& id) const {
  return requests_.at(id).answer;
}

void answer_memory::begin(const std::string& id, const std::string& body) {
  requests_[id].body = body;
  order_.push_back(id);
  bytes_ += body.size();
}

void answer_memory::finish(const std::string& id, const std::string& answer) {
  const auto known = requests_.find(id);
  if (known == requests_.end())
    return;
  bytes_ += answer.size() - known->second.answer.size();
  known->second.answer = answer;
  trim();
}

void answer_memory::forget(const std::string& id) {
  const auto known = requests_.find(id);
  if (known == requests_.end())
    return;
  bytes_ -= known->second.body.size() + known->second.answer.size();
  requests_.erase(known);
  order_.erase(std::find(order_.begin(), order_.end(), id));
}

void answer_memory::trim() {
  while (requests_.size() > limits::request::remembered
         || bytes_ > limits::request::remembered_bytes) {
    const auto oldest =
        std::find_if(order_.begin(), order_.end(), [&](const auto& id) {
          return !requests_.at(id).answer.empty();
        });
    if (oldest == order_.end())
      return;
    const auto id = *oldest;
    forget(id);
  }
}

} // namespace roscell
