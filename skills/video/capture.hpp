#pragma once

#include "skills/video/picture_reader.hpp"

namespace roscell::video {

/// Opens a camera, file or URL by OpenCV.
std::unique_ptr<picture_reader> make_capture(const std::string& endpoint);

} // namespace roscell::video
