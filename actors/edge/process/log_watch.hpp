#pragma once

#include "actors/edge/io/fd_watch.hpp"

#include <filesystem>
#include <functional>
#include <memory>

namespace roscell {

/// Calls back on the io thread when a file in a folder is made, written to or
/// renamed. Calls nothing if the folder cannot be watched; then followers of a
/// log get their answers when their time is over.
fd_watch watch_folder(const std::shared_ptr<io_core>& core,
                      const std::filesystem::path& folder,
                      std::function<void()> on_change);

} // namespace roscell
