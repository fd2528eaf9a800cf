#include "client/event_follower.hpp"

#include <catch2/catch.hpp>

#include <poll.h>

#include <deque>
#include <future>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using namespace roscell;

namespace {

std::string lines_of_event(uint64_t sequence) {
  event e;
  e.sequence = sequence;
  e.what = "node_joined";
  return "data: " + message_json(e).dump() + "\n\n";
}

/// A node that gives what it is told to, and what a follower makes of it.
class follower_bench {
public:
  /// What is answered to the next questions; a null has no answer. After the
  /// last one the stream stays open until it is cancelled.
  std::deque<std::optional<std::string>> answers;
  std::vector<std::string> heard; ///< Of the follower's thread.
  std::vector<std::string> asked;
  bool again = true;

  /// Follows until so much was heard.
  void hear(size_t count, uint64_t since = from_now_on) {
    wanted_ = count;
    enough_ = {};
    event_follower events{
        [this](const std::string& path, const auto& on_line,
               const http_cancel& cancel) { read(path, on_line, cancel); },
        {[this](const std::vector<event>& kept) {
           std::string text = "open";
           for (const auto& x : kept)
             text += " " + std::to_string(x.sequence);
           note(text);
         },
         [this](const event& e) { note(std::to_string(e.sequence)); },
         [this](const std::exception_ptr& why) {
           note(why ? "lost" : "ended");
           return again;
         }},
        since};
    enough_.get_future().wait();
  }

private:
  /// What comes while the follower is being ended is not asked for.
  void note(const std::string& what) {
    if (heard.size() == wanted_)
      return;
    heard.push_back(what);
    if (heard.size() == wanted_)
      enough_.set_value();
  }

  void read(const std::string& path,
            const event_follower::line_handler& on_line,
            const http_cancel& cancel) {
    asked.push_back(path.substr(path.find('?') + 1));
    if (answers.empty()) {
      pollfd x{cancel.fd(), POLLIN, 0};
      poll(&x, 1, -1);
      return;
    }
    const auto answer = answers.front();
    answers.pop_front();
    if (!answer)
      throw std::runtime_error{"nobody is there"};
    std::istringstream lines{*answer};
    for (std::string line; std::getline(lines, line);)
      on_line(line);
  }

  size_t wanted_ = 0;
  std::promise<void> enough_;
};

using texts = std::vector<std::string>;

} // namespace

TEST_CASE("who follows from now on asks for nothing that was", "[client]") {
  follower_bench x;
  x.answers = {": begin\n" + lines_of_event(7)};
  x.hear(3);
  CHECK(x.heard == texts{"open", "7", "ended"});
  CHECK(x.asked.front() == "since=" + std::to_string(from_now_on));
}

TEST_CASE("what is kept comes at once, and then what follows it", "[client]") {
  follower_bench x;
  x.answers = {lines_of_event(3) + lines_of_event(4),
               ": begin\n" + lines_of_event(5)};
  x.again = false;
  x.hear(3, 0);
  CHECK(x.heard == texts{"open 3 4", "5", "ended"});
  CHECK(x.asked == texts{"follow=0&since=0", "since=4"});
}

TEST_CASE("a node that is back tells what was missed, and nothing twice",
          "[client]") {
  follower_bench x;
  x.answers = {": begin\n" + lines_of_event(7), std::nullopt, lines_of_event(8),
               ": begin\n" + lines_of_event(9)};
  x.hear(6);
  CHECK(x.heard == texts{"open", "7", "ended", "lost", "open 8", "9"});
  CHECK(x.asked[3] == "since=8");
}

TEST_CASE("a stream of events ends when nobody wants it any more", "[client]") {
  follower_bench x;
  x.answers = {": begin\n"};
  x.answers.emplace_back(": begin\n" + lines_of_event(1));
  x.again = false;
  x.hear(2);
  CHECK(x.heard == texts{"open", "ended"});
  CHECK(x.asked.size() == 1);
}
