#pragma once

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/completion/completer.hpp"
#include "tools/roscell/shell/editing/history_file.hpp"

#include <histedit.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::cli {

/// Takes the marks out of what a terminal sends that says what is pasted
/// (bracketed paste), and makes blanks of tabs there, so that pasted text is
/// never completed.
class paste_filter {
public:
  /// What is to be read of these bytes. The beginning of a mark is kept until
  /// the rest has come, Escape too: it begins the keys of an editor, and means
  /// nothing to it before the next one.
  std::string add(std::string_view bytes);

private:
  std::string kept_;
  bool pasting_ = false;
};

/// What the editor asks of the shell while somebody types.
struct editor_calls {
  std::function<std::string()> prompt;
  std::function<completions(std::string_view line)> complete;
  /// A descriptor that is readable when there is something to show.
  std::function<int()> news_fd;
  std::function<std::vector<std::string>()> take_news; ///< Lines.
};

/// Reads lines from a terminal: they can be edited, come back from the history,
/// and are completed by Tab. What is new is shown above the line that is being
/// typed. Takes SIGWINCH and what ends a program as long as it lives, and the
/// language of the terminal, both for the whole process: it must be made before
/// any thread is.
class line_editor {
public:
  enum class outcome { line, interrupted, ended };

  line_editor(editor_calls calls, history_file& kept);
  ~line_editor();

  line_editor(const line_editor&) = delete;
  line_editor& operator=(const line_editor&) = delete;

  /// Reads one line, without its end. At the end, which SIGTERM and SIGHUP are,
  /// too, the terminal is as it was.
  outcome read(std::string& line);

  /// A line that the history gives back from now on.
  void remember(const std::string& line);

  /// Whether there was a Ctrl-C or Ctrl-\ that was meant for a command; they
  /// are forgotten.
  bool forget_interrupts();

  /// Prints what is new; between two lines.
  void show_news();

private:
  struct end_editing {
    void operator()(EditLine* x) const {
      el_end(x);
    }
  };
  struct end_history {
    void operator()(History* x) const {
      history_end(x);
    }
  };

  struct taken_signals {
    bool interrupted = false; ///< Ctrl-C.
    bool quit = false;        ///< Ctrl-\.
    bool ended = false;       ///< SIGTERM or SIGHUP.
  };

  static char* prompt_of(EditLine* editor);
  static int next_character(EditLine* editor, wchar_t* to);

  void set_up_editor();
  bool await_bytes();
  taken_signals take_signals();
  bool read_bytes();
  int take_character(wchar_t& to);
  void show_above();
  void clear_line() const;
  void complete_here();
  void list(const std::vector<std::string>& words);

  editor_calls calls_;
  history_file& kept_;
  unique_fd signals_;
  std::unique_ptr<History, end_history> history_;
  std::unique_ptr<EditLine, end_editing> editor_;
  paste_filter pastes_;
  std::deque<char> bytes_; ///< Typed, but not taken yet.
  std::string prompt_;
  bool interrupted_ = false;
  bool at_end_ = false;
};

} // namespace roscell::cli
