#pragma once

#include "actors/edge/io/unique_fd.hpp"

#include <filesystem>

/// FIFOs by which a program is told something while it runs. Nothing here
/// blocks.
namespace roscell {

/// Makes one that only its owner can use, in place of what is there. Without it
/// the program cannot be told anything, which is no reason not to start it.
void make_fifo(const std::filesystem::path& file);

/// The end of one that a program reads.
struct fifo_writer {
  unique_fd out;
  /// Held while something is written: a program that is gone meanwhile must not
  /// end this process by a SIGPIPE.
  unique_fd reader;
  bool is_there = false; ///< The file is, but maybe nobody reads it.

  explicit operator bool() const {
    return out && reader;
  }
};

/// Opens it where somebody reads it. What is no FIFO is left alone.
fifo_writer open_fifo_to_write(const std::filesystem::path& file);

} // namespace roscell
