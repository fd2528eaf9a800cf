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

/// Writes each frame into a file of its own, which appears in the folder only
/// when it is complete. See file_protocol.hpp.
class folder_output : public output_handler {
public:
  explicit folder_output(const stream_context& output);

  void open() override;
  void write(const frame& result) override;
  void close() override;

  bool survives_new_address() const override {
    return true;
  }

private:
  [[noreturn]] void fail(const std::string& temporary, int error) const;

  std::string path_;
};

/// The file name for a frame: its name without slashes and leading dots, cut
/// to what file systems take, or its sequence number if it has no name.
std::string file_name_of(const frame& result);

} // namespace roscell::engine
