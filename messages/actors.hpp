#pragma once

/// The whole protocol inside a node: every message and every typed handle.
#include "messages/type_ids.hpp"
