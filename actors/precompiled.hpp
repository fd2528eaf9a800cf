#pragma once

/// What nearly every file of actors needs, compiled once: CAF, JSON, all
/// messages and the core. A file still includes what it uses.
#include "actors/core/actor_context.hpp"
#include "messages/codec/caf_messages.hpp"
#include "messages/failure.hpp"

#include <caf/all.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>
