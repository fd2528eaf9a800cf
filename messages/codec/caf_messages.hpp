#pragma once

#include "messages/messages.hpp"

#include <caf/make_message.hpp>

/// What CAF makes of each message struct is costly to compile and needed
/// wherever one is sent. It is instantiated once, in caf_messages.cpp, and only
/// declared for everyone else.
#define ROSCELL_MAKE_MESSAGE(EXTERN, T, PARAMETER)                             \
  EXTERN template caf::message caf::make_message<T>(PARAMETER);

/// Once for each way in which an argument can be given.
#define ROSCELL_EACH_WAY(EXTERN, T)                                            \
  ROSCELL_MAKE_MESSAGE(EXTERN, roscell::T, roscell::T&&)                       \
  ROSCELL_MAKE_MESSAGE(EXTERN, roscell::T&, roscell::T&)                       \
  ROSCELL_MAKE_MESSAGE(EXTERN, const roscell::T&, const roscell::T&)

#ifndef ROSCELL_INSTANTIATE_MESSAGES
#define ROSCELL_DECLARE(T) ROSCELL_EACH_WAY(extern, T)
ROSCELL_MESSAGE_STRUCTS(ROSCELL_DECLARE)
#undef ROSCELL_DECLARE
#endif
