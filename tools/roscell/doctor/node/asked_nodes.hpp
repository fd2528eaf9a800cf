#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <string>
#include <vector>

/// Questions to nodes, and what comes instead of an answer.
namespace roscell::cli {

/// Longer than a coordinator waits for a node that has to look.
inline constexpr std::chrono::seconds answer_limit{30};

/// Nodes that are asked at a time: a coordinator serves others, too.
inline constexpr size_t most_asked = 8;

/// What a node has answered, or why it has not.
template <class Reply>
struct answer_of {
  std::string node;
  Reply reply;
  finding problem; ///< Its `seen` is empty if there is a reply.
};

/// Why a question to a node has no answer: it was refused, did not arrive, or
/// the answer is one that this program does not understand.
finding finding_of_failure(const std::exception& why, judgement how);

/// A node of an older program, or one that embeds it.
bool cannot_check(const std::exception& why);

template <class Reply>
answer_of<Reply> ask_node(const node_client& to, const std::string& name,
                          json request) {
  answer_of<Reply> result;
  result.node = name;
  request["node"] = name;
  try {
    result.reply = to.ask(request, answer_limit).template get<Reply>();
  } catch (const std::exception& e) {
    result.problem = finding_of_failure(e, cannot_check(e) ? judgement::skipped
                                                           : judgement::broken);
    result.problem.seen.insert(0, name + ": ");
  }
  return result;
}

/// Asks all of them, some at a time, and gives the answers in their order.
template <class Ask>
auto ask_all(const std::vector<std::string>& names, Ask ask) {
  using answer = decltype(ask(names.front()));
  std::vector<answer> result(names.size());
  for (size_t begin = 0; begin < names.size(); begin += most_asked) {
    std::vector<std::future<answer>> asked;
    for (size_t i = begin; i < std::min(begin + most_asked, names.size()); ++i)
      asked.push_back(std::async(std::launch::async, ask, names[i]));
    for (size_t i = 0; i < asked.size(); ++i)
      result[begin + i] = asked[i].get();
  }
  return result;
}

} // namespace roscell::cli
