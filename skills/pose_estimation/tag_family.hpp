#pragma once

#include <apriltag/apriltag.h>

#include <memory>
#include <string>

namespace roscell::pose {

using tag_family =
    std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

/// Throws start_error, with the names that are known, when `name` is not.
tag_family make_tag_family(const std::string& name);

} // namespace roscell::pose
