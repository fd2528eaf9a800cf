#include "tools/roscell/shell/editing/line_editor.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cwchar>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::string_view paste_begin = "\x1b[200~";
constexpr std::string_view paste_end = "\x1b[201~";

/// Bytes at the end of `text` that may be the beginning of `mark`.
size_t begun_mark(std::string_view text, std::string_view mark) {
  for (size_t n = std::min(text.size(), mark.size() - 1); n > 0; --n)
    if (text.substr(text.size() - n) == mark.substr(0, n))
      return n;
  return 0;
}

} // namespace

std::string paste_filter::add(std::string_view bytes) {
  auto text = std::exchange(kept_, {}) + std::string{bytes};
  std::string result;
  while (true) {
    const auto mark = pasting_ ? paste_end : paste_begin;
    const auto found = text.find(mark);
    auto part = text.substr(0, found);
    if (found == text.npos) {
      const auto n = begun_mark(part, mark);
      kept_ = part.substr(part.size() - n);
      part.resize(part.size() - n);
    }
    if (pasting_)
      std::replace(part.begin(), part.end(), '\t', ' ');
    result += part;
    if (found == text.npos)
      return result;
    text.erase(0, found + mark.size());
    pasting_ = !pasting_;
  }
}

namespace {

constexpr std::string_view enable_bracketed_paste = "\x1b[?2004h";
constexpr std::string_view disable_bracketed_paste = "\x1b[?2004l";

/// More are not listed at once.
constexpr size_t most_listed = 200;

sigset_t editor_signals() {
  sigset_t result{};
  sigemptyset(&result);
  for (const auto x : {SIGINT, SIGWINCH, SIGQUIT, SIGTERM, SIGHUP})
    sigaddset(&result, x);
  return result;
}

unique_fd take_editor_signals() {
  const auto taken = editor_signals();
  pthread_sigmask(SIG_BLOCK, &taken, nullptr);
  // A shell that is stopped by Ctrl-Z follows nothing.
  std::signal(SIGTSTP, SIG_IGN);
  return unique_fd{signalfd(-1, &taken, SFD_CLOEXEC | SFD_NONBLOCK)};
}

/// What is typed is UTF-8, also where no language was chosen.
void choose_utf8() {
  const auto* chosen = std::setlocale(LC_CTYPE, "");
  if (chosen == nullptr || MB_CUR_MAX == 1)
    std::setlocale(LC_CTYPE, "C.UTF-8");
}

} // namespace

line_editor::line_editor(editor_calls calls, history_file& kept)
    : calls_{std::move(calls)}, kept_{kept}, signals_{take_editor_signals()},
      history_{history_init()} {
  choose_utf8();
  editor_.reset(el_init("roscell", stdin, stdout, stderr));
  if (!signals_ || !history_ || !editor_)
    throw command_error{exit_refused, "this terminal cannot be used"};
  set_up_editor();
}

line_editor::~line_editor() {
  // A signal that still waits may end the process here.
  editor_.reset();
  const auto taken = editor_signals();
  pthread_sigmask(SIG_UNBLOCK, &taken, nullptr);
}

void line_editor::set_up_editor() {
  auto* editor = editor_.get();
  HistEvent ignored{};
  history(history_.get(), &ignored, H_SETSIZE,
          static_cast<int>(history_file::most_lines));
  history(history_.get(), &ignored, H_SETUNIQUE, 1);
  for (const auto& line : kept_.lines())
    history(history_.get(), &ignored, H_ENTER, line.c_str());
  el_set(editor, EL_CLIENTDATA, this);
  el_set(editor, EL_SIGNAL, 0);
  el_set(editor, EL_EDITOR, "emacs");
  el_set(editor, EL_PROMPT, &line_editor::prompt_of);
  el_set(editor, EL_HIST, history, history_.get());
  el_set(editor, EL_GETCFN, &line_editor::next_character);
  el_set(editor, EL_BIND, "^R", "em-inc-search-prev", nullptr);
  el_set(editor, EL_BIND, "\\e[1~", "ed-move-to-beg", nullptr);
  el_set(editor, EL_BIND, "\\e[4~", "ed-move-to-end", nullptr);
  el_set(editor, EL_BIND, "\\e[3~", "ed-delete-next-char", nullptr);
}

line_editor::outcome line_editor::read(std::string& line) {
  interrupted_ = false;
  if (at_end_)
    return outcome::ended;
  std::fwrite(enable_bracketed_paste.data(), 1, enable_bracketed_paste.size(),
              stdout);
  // Before the prompt: what is typed as soon as that is seen, Ctrl-D above all,
  // would still be taken by the terminal itself.
  el_set(editor_.get(), EL_PREP_TERM, 1);
  int count = 0;
  const auto* text = el_gets(editor_.get(), &count);
  print(disable_bracketed_paste);
  if (interrupted_)
    return outcome::interrupted;
  if (at_end_ || text == nullptr || count <= 0)
    return outcome::ended;
  line.assign(text, static_cast<size_t>(count));
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r'))
    line.pop_back();
  return outcome::line;
}

void line_editor::remember(const std::string& line) {
  HistEvent ignored{};
  if (kept_.add(line))
    history(history_.get(), &ignored, H_ENTER, line.c_str());
}

bool line_editor::forget_interrupts() {
  const auto taken = take_signals();
  at_end_ = at_end_ || taken.ended;
  return taken.interrupted || taken.quit;
}

char* line_editor::prompt_of(EditLine* editor) {
  line_editor* self = nullptr;
  el_get(editor, EL_CLIENTDATA, &self);
  self->prompt_ = self->calls_.prompt();
  return self->prompt_.data();
}

int line_editor::next_character(EditLine* editor, wchar_t* to) {
  line_editor* self = nullptr;
  el_get(editor, EL_CLIENTDATA, &self);
  return self->take_character(*to);
}

/// 1 for a character, 0 at the end, -1 after Ctrl-C.
int line_editor::take_character(wchar_t& to) {
  std::mbstate_t state{};
  while (await_bytes()) {
    const char x = bytes_.front();
    bytes_.pop_front();
    if (x == '\t') {
      complete_here();
      continue;
    }
    const auto used = std::mbrtowc(&to, &x, 1, &state);
    if (used <= 1) {
      to = used == 0 ? L'\0' : to;
      return 1;
    }
    // What is no UTF-8 is left out.
    if (used == static_cast<size_t>(-1))
      state = {};
  }
  errno = interrupted_ ? EINTR : 0;
  return interrupted_ ? -1 : 0;
}

/// Waits until something is typed, and shows meanwhile what is new. False after
/// Ctrl-C and at the end, which Ctrl-\ is where no command takes it.
bool line_editor::await_bytes() {
  while (bytes_.empty() && !interrupted_ && !at_end_) {
    std::array<pollfd, 3> fds{{{signals_.get(), POLLIN, 0},
                               {calls_.news_fd(), POLLIN, 0},
                               {STDIN_FILENO, POLLIN, 0}}};
    if (poll(fds.data(), fds.size(), -1) < 0)
      continue;
    if (fds[0].revents != 0) {
      const auto taken = take_signals();
      interrupted_ = taken.interrupted;
      at_end_ = taken.ended || taken.quit;
    }
    if (fds[1].revents != 0)
      show_above();
    if (fds[2].revents != 0)
      at_end_ = !read_bytes() || at_end_;
  }
  return !bytes_.empty() && !interrupted_ && !at_end_;
}

line_editor::taken_signals line_editor::take_signals() {
  taken_signals result;
  for (signalfd_siginfo taken{};
       ::read(signals_.get(), &taken, sizeof taken) > 0;)
    switch (taken.ssi_signo) {
    case SIGWINCH:
      el_resize(editor_.get());
      break;
    case SIGINT:
      result.interrupted = true;
      break;
    case SIGQUIT:
      result.quit = true;
      break;
    default:
      result.ended = true;
    }
  return result;
}

bool line_editor::read_bytes() {
  std::array<char, 4096> buffer{};
  const auto n = ::read(STDIN_FILENO, buffer.data(), buffer.size());
  if (n <= 0)
    return n < 0 && errno == EINTR;
  const auto text = pastes_.add({buffer.data(), static_cast<size_t>(n)});
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  return true;
}

void line_editor::show_news() {
  for (const auto& line : calls_.take_news())
    print(line + "\n");
}

void line_editor::show_above() {
  clear_line();
  show_news();
  el_set(editor_.get(), EL_REFRESH);
}

/// A line that is longer than the terminal is wide stands in several rows; the
/// cursor is in one of them.
void line_editor::clear_line() const {
  const auto* typed = el_line(editor_.get());
  const auto before = static_cast<size_t>(typed->cursor - typed->buffer);
  const auto columns =
      display_width(prompt_) + display_width({typed->buffer, before});
  const auto width = stdout_style().width;
  std::string text = "\r";
  if (width != 0 && columns >= width)
    text += "\x1b[" + std::to_string(columns / width) + "A";
  print(text + "\x1b[J");
}

/// Not as a function of the editor, which never frees the names of those.
void line_editor::complete_here() {
  const auto* typed = el_line(editor_.get());
  const std::string line(typed->buffer, typed->cursor);
  const auto found = calls_.complete(line);
  const auto word = replacement(found);
  const auto begun = line.substr(std::min(found.begin, line.size()));
  if (found.words.empty())
    return el_beep(editor_.get());
  if (found.words.size() == 1 || word.size() > begun.size()) {
    clear_line();
    el_deletestr(editor_.get(), static_cast<int>(letters_in(begun)));
    el_insertstr(editor_.get(), word.c_str());
  } else {
    list(found.words);
  }
  el_set(editor_.get(), EL_REFRESH);
}

void line_editor::list(const std::vector<std::string>& words) {
  constexpr size_t between = 2;
  size_t longest = 0;
  for (const auto& x : words)
    longest = std::max(longest, display_width(x));
  const auto width = std::max<size_t>(stdout_style().width, 1);
  const auto columns = std::max<size_t>(width / (longest + between), 1);
  std::string text = "\n";
  for (size_t i = 0; i < std::min(words.size(), most_listed); ++i) {
    const bool ends_row = (i + 1) % columns == 0 || i + 1 == words.size();
    text += printable(words[i]);
    text += ends_row
                ? "\n"
                : std::string(longest + between - display_width(words[i]), ' ');
  }
  if (words.size() > most_listed)
    text += "and " + std::to_string(words.size() - most_listed) + " more\n";
  print(text);
}

} // namespace roscell::cli
