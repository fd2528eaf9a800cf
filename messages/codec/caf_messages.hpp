#pragma once

#include "messages/messages.hpp"

#include <caf/mailbox_element.hpp>
#include <caf/make_message.hpp>

/// What CAF makes of each message struct is costly to compile and needed
/// wherever one is sent. It is instantiated once, in caf_messages.cpp
/// (messages) and caf_boxes.cpp (mailbox elements), and only declared for
/// everyone else.
#define ROSCELL_MAKE_MESSAGE(EXTERN, T, PARAMETER)                             \
  EXTERN template caf::message caf::make_message<T>(PARAMETER);

#define ROSCELL_MAKE_BOX(EXTERN, T, PARAMETER)                                 \
  EXTERN template caf::mailbox_element_ptr caf::make_mailbox_element<T>(       \
      caf::strong_actor_ptr, caf::message_id,                                  \
      caf::mailbox_element::forwarding_stack, PARAMETER);

/// Once for each way in which an argument can be given.
#define ROSCELL_EACH_WAY(MACRO, EXTERN, T)                                     \
  MACRO(EXTERN, roscell::T, roscell::T&&)                                      \
  MACRO(EXTERN, roscell::T&, roscell::T&)                                      \
  MACRO(EXTERN, const roscell::T&, const roscell::T&)

#ifndef ROSCELL_INSTANTIATE_MESSAGES
#define ROSCELL_DECLARE(T) ROSCELL_EACH_WAY(ROSCELL_MAKE_MESSAGE, extern, T)
ROSCELL_MESSAGE_STRUCTS(ROSCELL_DECLARE)
#undef ROSCELL_DECLARE
#endif

#ifndef ROSCELL_INSTANTIATE_BOXES
#define ROSCELL_DECLARE(T) ROSCELL_EACH_WAY(ROSCELL_MAKE_BOX, extern, T)
ROSCELL_MESSAGE_STRUCTS(ROSCELL_DECLARE)
#undef ROSCELL_DECLARE
#endif
