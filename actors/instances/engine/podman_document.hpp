#pragma once

#include "messages/codec/json_codec.hpp"

namespace roscell {

/// The body of Podman's own POST /libpod/containers/create for the container
/// that `container_document` describes to Docker: Podman drops the GPU requests
/// of Docker's API without a word. GPUs are CDI devices, "nvidia.com/gpu=0".
json podman_document(const std::string& name, const json& docker);

} // namespace roscell
