#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <string>

namespace roscell::engine {

/// Appends each frame to a file, as a line. See file_protocol.hpp.
class line_output : public output_handler {
public:
  explicit line_output(const stream_context& output);

  void open() override;
  void write(const frame& result) override;
  void close() override;

  bool survives_new_address() const override {
    return true;
  }

private:
  [[noreturn]] void fail(std::size_t written, int error);

  const std::string path_;
  unique_fd file_;
};

/// Makes a folder and those above it. Throws start_error.
void make_folders(const std::string& path);

} // namespace roscell::engine
