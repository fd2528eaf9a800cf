#include "messages/cell.hpp"
#include "messages/codec/instantiate.hpp"
#include "messages/formation.hpp"
#include "messages/inside/membership.hpp"
#include "messages/peer.hpp"
#include "messages/rebalance.hpp"
#include "messages/topic.hpp"

namespace roscell {

ROSCELL_CODEC(registry_row)
ROSCELL_CODEC(unassigned_node)
ROSCELL_CODEC(cell_query)
ROSCELL_CODEC(cell_description)
ROSCELL_CODEC(cell_list_query)
ROSCELL_CODEC(cell_row)
ROSCELL_CODEC(cell_list)
ROSCELL_CODEC(topic_end)
ROSCELL_CODEC(topic_row)
ROSCELL_CODEC(topic_query)
ROSCELL_CODEC(topic_list)
ROSCELL_CODEC(cell_formation)
ROSCELL_CODEC(formation_outcome)
ROSCELL_CODEC(cell_formed)
ROSCELL_CODEC(node_drain)
ROSCELL_CODEC(node_drained)
ROSCELL_CODEC(node_undrain)
ROSCELL_CODEC(node_undrained)
ROSCELL_CODEC(cell_rebalance)
ROSCELL_CODEC(rebalance_move)
ROSCELL_CODEC(cell_rebalanced)
ROSCELL_CODEC(node_release)
ROSCELL_CODEC(node_released)
ROSCELL_CODEC(node_transfer)
ROSCELL_CODEC(node_transferred)
ROSCELL_CODEC(transfer_row)
ROSCELL_CODEC(transfer_query)
ROSCELL_CODEC(transfer_description)
ROSCELL_DESCRIBED(membership_query)
ROSCELL_DESCRIBED(membership_state)
ROSCELL_DESCRIBED(join_cell)
ROSCELL_DESCRIBED(seek_cell)
ROSCELL_CODEC(membership_record)
ROSCELL_DESCRIBED(leave_cell)
ROSCELL_CODEC(cell_address)
ROSCELL_CODEC(member_claim)
ROSCELL_CODEC(cell_standing)
ROSCELL_CODEC(cell_changed)
ROSCELL_CODEC(place_request)
ROSCELL_CODEC(place_granted)
ROSCELL_CODEC(place_reservation)
ROSCELL_CODEC(place_reserved)
ROSCELL_CODEC(member_surrender)
ROSCELL_CODEC(members_surrendered)
ROSCELL_CODEC(registration_switch)
ROSCELL_CODEC(switch_accepted)
ROSCELL_CODEC(registration_query)
ROSCELL_CODEC(registration_challenge)
ROSCELL_DESCRIBED(switch_node)
ROSCELL_DESCRIBED(prove_status)
ROSCELL_DESCRIBED(status_proved)
ROSCELL_DESCRIBED(node_answered)

} // namespace roscell
