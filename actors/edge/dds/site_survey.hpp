#pragma once

#include "actors/edge/dds/public_presence.hpp"

#include <chrono>
#include <functional>
#include <vector>

namespace roscell {

/// What is announced on the site now, each participant once, as far as it
/// answers within `span` and until `enough` is true of one of them; with an
/// empty `enough` it waits out the span. Announces the role `surveyor`
/// meanwhile, whatever `options` say. Blocks; refused like
/// `public_presence::open`.
edge_result<std::vector<announcement>>
survey_site(presence_options options, std::chrono::milliseconds span,
            const std::function<bool(const announcement&)>& enough);

} // namespace roscell
