#include "tools/roscell/top/viewer.hpp"

#include "tools/roscell/view/log_lines.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

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
    : node_{node.endpoint()}, controls_{std::move(begin)},
      screen_{stdout_style().colour}, events_{node_, mail_}, asker_{node_,
                                                                    mail_} {}

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
  for (auto& x : mail_.take())
    std::visit([this](auto& what) { take(std::move(what)); }, x);
  changed_ = true;
}

void viewer::take(events_opened x) {
  model_.open(std::move(x.kept), view_style_now().now_unix_ms);
  asker_.ask({true, true, true});
}

void viewer::take(events_lost x) {
  model_.lose(x.why, view_style_now().now_unix_ms);
}

void viewer::take(event x) {
  asker_.ask(model_.add(std::move(x)));
}

void viewer::take(cell_answer x) {
  model_.set_cell(std::move(x.asked), std::move(x.cell));
}

void viewer::take(metrics_answer x) {
  model_.set_metrics(x.instances);
}

void viewer::take(skill_list x) {
  model_.set_skills(std::move(x));
}

void viewer::take(question_failed x) {
  model_.miss(x.why);
}

void viewer::take(log_line x) {
  if (log_.size() >= most_log_lines)
    log_.erase(log_.begin(), log_.begin() + most_log_lines / 10);
  auto text = harmless_line(x.text);
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
    log_reader_ = std::make_unique<log_follower>(node_, wanted, mail_);
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
