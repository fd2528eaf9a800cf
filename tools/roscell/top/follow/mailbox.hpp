#pragma once

#include "messages/cell.hpp"
#include "messages/event.hpp"
#include "messages/instance.hpp"
#include "messages/node.hpp"
#include "messages/skill.hpp"

#include <mutex>
#include <string>
#include <variant>
#include <vector>

namespace roscell::cli::top {

/// The events come; these are those that the node has kept.
struct events_opened {
  std::vector<event> kept;
};

/// They do not come any more, or still not.
struct events_lost {
  std::string why;
};

struct cell_answer {
  node_description asked;
  cell_description cell;
};

struct metrics_answer {
  std::vector<instance_row> instances;
};

struct question_failed {
  std::string why;
};

/// A line of the log that is open.
struct log_line {
  std::string text;
};

using news =
    std::variant<events_opened, events_lost, event, cell_answer, metrics_answer,
                 skill_list, question_failed, log_line>;

/// What threads have to tell the one that draws, which waits for a descriptor.
class mailbox {
public:
  mailbox();
  ~mailbox();

  mailbox(const mailbox&) = delete;
  mailbox& operator=(const mailbox&) = delete;

  void put(news x);

  /// All that is there, in order. The descriptor is not readable any more then.
  std::vector<news> take();

  /// Readable while there is something.
  int fd() const {
    return fd_;
  }

private:
  int fd_;
  std::mutex mutex_;
  std::vector<news> news_;
};

} // namespace roscell::cli::top
