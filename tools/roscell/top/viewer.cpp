#include "tools/roscell/top/viewer.hpp"

#include "tools/roscell/view/log_lines.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

namespace roscell::cli::top {

namespace {

/// What no event tells is asked for so often.
constexpr std::chrono::seconds metrics_pause{2};

/// Many events together are drawn once.
constexpr std::chrono::milliseconds drawing_pause{100};

constexpr size_t most_log_lines = 5000;

bool is_readable(const pollfd& x) {
  return (x.revents & POLLIN) != 0;
}

} // namespace

viewer::viewer(const node_client& node, controls begin)
    : node_{node}, controls_{std::move(begin)}, screen_{stdout_style().colour},
      events_{lines_of(node), event_hooks(), 0}, asker_{node_, model_, mail_} {}

/// All that happens is put into the mailbox, and done by who draws.
event_follower::hooks viewer::event_hooks() {
  return {[this](const std::vector<event>& kept) {
            mail_.put([this, kept] {
              model_.open(kept, view_style_now().now_unix_ms);
              asker_.ask({true, true, true});
            });
          },
          [this](const event& e) {
            mail_.put([this, e] { asker_.ask(model_.add(e)); });
          },
          [this](const std::exception_ptr& end) {
            mail_.put([this, why = reason_in(end)] {
              model_.lose(why, view_style_now().now_unix_ms);
            });
            return true;
          }};
}

void viewer::run() {
  draw();
  while (!left_ && !controls_.left) {
    wait();
    follow_log();
    if (clock::now() >= next_refresh_)
      ask_for_metrics();
    if (changed_ && clock::now() >= drawn_ + drawing_pause)
      draw();
  }
}

void viewer::wait() {
  using std::chrono::milliseconds;
  const auto due = changed_ ? std::min(next_refresh_, drawn_ + drawing_pause)
                            : next_refresh_;
  const auto left = std::chrono::ceil<milliseconds>(due - clock::now());
  std::array<pollfd, 3> fds{{{STDIN_FILENO, POLLIN, 0},
                             {signals_.fd(), POLLIN, 0},
                             {mail_.fd(), POLLIN, 0}}};
  poll(fds.data(), fds.size(), std::max(0, static_cast<int>(left.count())));
  if (is_readable(fds[1]))
    read_signals();
  if (is_readable(fds[0]))
    read_keys();
  else if (fds[0].revents != 0)
    left_ = true; // The terminal is gone.
  if (is_readable(fds[2]))
    read_news();
}

void viewer::read_signals() {
  while (const auto taken = signals_.take()) {
    if (*taken == SIGTSTP)
      stop();
    else if (*taken == SIGCONT)
      screen_.resume();
    else if (*taken == SIGWINCH)
      screen_.adopt_size();
    else
      left_ = true;
    drawn_ = {};
  }
  changed_ = true;
}

/// While it is stopped nothing is asked, because nobody sees it.
void viewer::stop() {
  screen_.suspend();
  signals_.stop_here();
  screen_.resume();
}

void viewer::read_keys() {
  while (const auto pressed = screen_.take_key()) {
    if (pressed->text == "\f")
      screen_.forget();
    press(controls_, *pressed, {shown_.lists, shown_.page, shown_.text_lines});
    // The next key may mean what this one has brought up.
    draw();
  }
}

void viewer::read_news() {
  mail_.work_off();
  changed_ = true;
}

void viewer::add_log_line(const std::string& line) {
  if (log_.size() >= most_log_lines)
    log_.erase(log_.begin(), log_.begin() + most_log_lines / 10);
  auto text = harmless_line(line);
  std::replace(text.begin(), text.end(), '\t', ' ');
  log_.push_back(std::move(text));
}

void viewer::follow_log() {
  const auto wanted =
      controls_.where == top_page::log ? controls_.subject.name : std::string{};
  if (wanted == (log_reader_ ? log_reader_->instance() : ""))
    return;
  log_reader_.reset();
  // What the former one has still said is of another log.
  read_news();
  log_.clear();
  if (!wanted.empty())
    log_reader_ = std::make_unique<log_follower>(
        node_, wanted, mail_,
        [this](const std::string& line) { add_log_line(line); });
}

void viewer::ask_for_metrics() {
  next_refresh_ = clock::now() + metrics_pause;
  // Ages grow, too.
  changed_ = true;
  if (model_.connection().live)
    asker_.ask({true, true, false});
}

void viewer::draw() {
  const frame_style style{screen_.width(), screen_.height(), screen_.utf8(),
                          view_style_now().now_unix_ms};
  shown_ = make_frame({model_, log_, controls_}, style);
  screen_.draw(shown_.lines);
  drawn_ = clock::now();
  changed_ = false;
}

} // namespace roscell::cli::top
